// The measuring on the walker: its shortcuts against the exact answers, and the same on any number of workers.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "engine/animation/clip.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/measure/penetration_meter.hpp"
#include "modules/muscle/measure/rest_surfaces.hpp"
#include "modules/muscle/measure/sample_surface.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

struct Walker {
  std::shared_ptr<const CharacterAsset> character;
  std::vector<glm::mat4> bones;  // a stride
  RestSurfaces surfaces;

  Walker() {
    const auto loaded = load_character(std::filesystem::path(FASCICLE_SOURCE_DIR) /
                                           "content/characters/walker/walker.character.json",
                                       {.bone_fields = false});
    if (!loaded) {
      ADD_FAILURE() << to_text(loaded.diagnostics());
      return;
    }
    character = *loaded;
    const Skeleton& skeleton = *character->skeleton;
    std::vector<Trs> pose = skeleton.rest_local;
    const Clip& clip = *character->clips.front();
    sample_clip(clip, clip.start + 0.2f * clip.duration(), pose);
    bones.resize(skeleton.size());
    compose(skeleton, pose, glm::mat4(1.0f), bones);
    surfaces = make_rest_surfaces(character->muscles, bones);
  }
};

TEST(WalkerMeasure, CrossingsAreWindingNumbersOfTheDrawnMuscles) {
  const Walker walker;
  ASSERT_TRUE(walker.character);
  const MuscleAsset& asset = *walker.character->muscles;
  test::Numbers numbers(1);
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    TriangleMesh mesh;
    mesh.indices = surface_triangles(asset, m);
    for (const SurfaceVertex& vertex : surface_of(asset, walker.surfaces.surfaces, m).vertices) {
      mesh.positions.push_back(vertex.position);
    }
    const SolidTree tree(mesh);
    const Box box = tree.box();
    int inside = 0;
    for (int i = 0; i < 300; ++i) {
      const glm::vec3 point = box.lower + numbers.point(0.0f, 1.0f) * (box.upper - box.lower);
      const int windings = tree.windings(point);
      ASSERT_EQ(windings, std::lround(winding_number(mesh, glm::dvec3(point)))) << asset.muscles[m].name;
      inside += windings > 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 0) << asset.muscles[m].name;
  }
}

TEST(WalkerMeasure, TheBonesGridsChangeNothing) {
  const Walker walker;
  ASSERT_TRUE(walker.character);
  const auto solids = make_bone_solids(walker.character->bone_meshes);
  ASSERT_GT(solids->size(), 5u);
  test::Numbers numbers(2);
  int inside = 0;
  for (const BoneSolid& solid : *solids) {
    for (int i = 0; i < 1000; ++i) {
      const glm::vec3 point = solid.box().lower + numbers.point(0.0f, 1.0f) * (solid.box().upper - solid.box().lower);
      const double exact = solid.exact_depth(point);
      ASSERT_EQ(solid.depth_beyond(point, 0.0), exact);
      inside += exact > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(inside, 500);
}

TEST(WalkerMeasure, WorkersDoNotMatter) {
  const Walker walker;
  ASSERT_TRUE(walker.character);
  const auto measure = [&](int workers) {
    parallel::WorkerArena arena(workers);
    Penetration result;
    arena.execute([&] {
      PenetrationMeter meter(walker.character->muscles, make_bone_solids(walker.character->bone_meshes));
      // The second answer must not depend on the first.
      for (int i = 0; i < 2; ++i) {
        result = meter.measure(walker.surfaces.surfaces, walker.surfaces.tendons, walker.bones);
      }
    });
    return result;
  };
  const Penetration one = measure(1), three = measure(3);
  EXPECT_GT(one.points, 100000u);
  EXPECT_EQ(one.points, three.points);
  for (const auto list : {&Penetration::bones, &Penetration::muscles}) {
    ASSERT_GT((one.*list).size(), 10u);
    ASSERT_EQ((one.*list).size(), (three.*list).size());
    for (std::size_t i = 0; i < (one.*list).size(); ++i) {
      const PairDepth &a = (one.*list)[i], &b = (three.*list)[i];
      EXPECT_TRUE(a.muscle == b.muscle && a.bone == b.bone && a.other == b.other && a.depth == b.depth &&
                  a.position == b.position && a.place == b.place);
    }
  }
}

}  // namespace
}  // namespace fascicle::muscle
