// Live reload of surface muscles: every file that they are made of is watched, what is broken is told, and mending it
// brings the muscle back.

#include <gmock/gmock.h>

#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "modules/muscle/content/content_reloader.hpp"
#include "tests/modules/muscle/content/scratch_surfaces.hpp"

namespace fascicle::muscle {
namespace {

using test::kLimb;
using test::ScratchFolder;
using test::with;
using testing::HasSubstr;

constexpr std::string_view kLines = "# vtk DataFile Version 3.0\nfibres\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n"
                                    "-150 99 9  -150 -99 9\nLINES 1 3\n2 0 1\n";

std::string limb_with_a_file_of_fibres() {
  return with(std::string(kLimb), R"("points": [[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]])",
              R"("file": "lines.vtk")");
}

const SurfaceAsset& muscle_of(const ReloadOutcome& outcome) {
  return *outcome.scene->characters.at(0).character->surface_muscles.at(0);
}

TEST(SurfaceReload, SeesMeshFibresAndSettings) {
  const ScratchFolder folder;
  folder.write("lines.vtk", kLines);
  test::write_limb(folder, limb_with_a_file_of_fibres());
  const auto scene = folder.write(
      "limb.scene.json", R"({ "version": 1, "name": "limb", "characters": [{ "file": "limb.character.json" }] })");
  const auto first = load_scene(scene);
  ASSERT_TRUE(first.ok()) << to_text(first.diagnostics());
  ContentReloader reloader(scene, *first);

  folder.write("ball.obj", test::as_obj(test::moved(test::make_ball(), glm::mat4(1.0f))) + "\n# again\n");
  auto outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);

  TriangleMesh open = test::make_ball();
  open.indices.resize(open.indices.size() - 3);
  folder.write("ball.obj", test::as_obj(open));
  outcome = reloader.wait();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->scene);
  EXPECT_THAT(to_text(outcome->diagnostics), HasSubstr("the mesh is open"));

  folder.write("ball.obj", test::as_obj(test::make_ball()));
  outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  EXPECT_EQ(muscle_of(*outcome).fibres.size(), 1u);

  folder.write("lines.vtk", std::string(kLines) + "POINT_DATA 2\n");
  outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);

  folder.write("limb.character.json", with(limb_with_a_file_of_fibres(), "\"substeps\": 4", "\"substeps\": 9"));
  outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  EXPECT_EQ(muscle_of(*outcome).settings.substeps, 9u);
}

}  // namespace
}  // namespace fascicle::muscle
