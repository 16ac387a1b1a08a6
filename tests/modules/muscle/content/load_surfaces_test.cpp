// Surface muscles as their character file says: the vertices that are attached, fibres, the other side, what drives.

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "tests/modules/muscle/content/scratch_surfaces.hpp"

namespace fascicle::muscle {
namespace {

using test::kLimb;
using test::ScratchFolder;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;

class LoadSurfaces : public testing::Test {
 protected:
  std::shared_ptr<const CharacterAsset> load(std::string_view text) {
    loaded = load_character(test::write_limb(folder, text), {.bone_fields = false});
    EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
    return loaded.ok() ? *loaded : nullptr;
  }
  std::string only_warning() const {
    const auto& warnings = loaded.diagnostics().warnings;
    EXPECT_EQ(warnings.size(), 1u) << to_text(loaded.diagnostics());
    return warnings.empty() ? std::string() : to_string(warnings[0]);
  }

  ScratchFolder folder;
  Result<std::shared_ptr<const CharacterAsset>> loaded = Diagnostic{};
};

// The ball's vertices for which `is` is true, m.
template <class Is>
std::vector<std::uint32_t> vertices_where(Is is) {
  const TriangleMesh ball = test::make_ball();
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t v = 0; v < ball.positions.size(); ++v) {
    if (is(1e-3f * ball.positions[v])) vertices.push_back(v);
  }
  return vertices;
}

TEST_F(LoadSurfaces, FillsEveryField) {
  const auto limb = load(kLimb);
  ASSERT_TRUE(limb);
  EXPECT_TRUE(loaded.diagnostics().warnings.empty()) << to_text(loaded.diagnostics());
  ASSERT_EQ(limb->surface_muscles.size(), 1u);
  const SurfaceMuscleDescription& ball = limb->surface_descriptions.at(0);
  const Skeleton& skeleton = *limb->skeleton;
  EXPECT_EQ(ball.name, "ball_r");
  EXPECT_EQ(ball.driver, "calf_r");
  EXPECT_EQ(ball.frame_bone, skeleton.find("trunk"));  // its origin's
  EXPECT_THAT(ball.bones, ElementsAre(skeleton.find("shin_r")));
  EXPECT_EQ(ball.settings.substeps, 4u);
  EXPECT_FLOAT_EQ(ball.settings.contact_distance, 0.002f);
  EXPECT_EQ(ball.where.path, "/surface_muscles/0");
  EXPECT_NEAR(mesh_volume(ball.mesh), 4.0 / 3.0 * 3.14159 * 1e-3, 1e-4);
  ASSERT_EQ(ball.attachments.size(), 2u);
  EXPECT_TRUE(ball.attachments[0].origin);
  EXPECT_EQ(ball.attachments[0].bone, skeleton.find("trunk"));
  EXPECT_EQ(ball.attachments[0].vertices, vertices_where([](glm::vec3 p) { return p.y > 0.09f; }));
  EXPECT_FALSE(ball.attachments[1].origin);
  EXPECT_EQ(ball.attachments[1].bone, skeleton.find("shin_r"));
  // The block's top is at y = -101 mm and wider than what lies low enough.
  EXPECT_EQ(ball.attachments[1].vertices, vertices_where([](glm::vec3 p) { return p.y <= -0.097f; }));
  EXPECT_GT(ball.attachments[1].vertices.size(), 20u);
  // Written from the insertion, turned to run from the origin.
  ASSERT_EQ(ball.fibres.size(), 1u);
  EXPECT_GT(ball.fibres[0].points.front().y, 0.09f);
  EXPECT_NEAR(ball.fibres[0].points[1].z, 0.09f, 1e-6f);
  const SurfaceAsset& asset = *limb->surface_muscles[0];
  EXPECT_EQ(asset.vertex_count, test::make_ball().positions.size());
  EXPECT_EQ(asset.attachments.size(), 2u);
  EXPECT_EQ(asset.attachments[1].count, ball.attachments[1].vertices.size());
}

TEST_F(LoadSurfaces, ADriverIsHiddenUnlessItsAuthorWantsBoth) {
  const auto limb = load(kLimb);
  ASSERT_TRUE(limb);
  EXPECT_THAT(limb->hidden_muscles, ElementsAre(1, 0));  // calf_r, calf_l
  const auto both = load(with(std::string(kLimb), "\"driver\": \"calf_r\"", R"("driver": "calf_r", "hide_driver": false)"));
  ASSERT_TRUE(both);
  EXPECT_THAT(both->hidden_muscles, ElementsAre(0, 0));
}

TEST_F(LoadSurfaces, TheOtherSideIsAReflection) {
  const auto limb = load(with(with(std::string(kLimb), "\"name\": \"ball_r\"", R"("name": "ball_r", "mirror": true)"),
                              "\"bones\": [\"shin_r\"],", ""));
  ASSERT_TRUE(limb);
  ASSERT_EQ(limb->surface_descriptions.size(), 2u);
  const SurfaceMuscleDescription& right = limb->surface_descriptions[0];
  const SurfaceMuscleDescription& left = limb->surface_descriptions[1];
  EXPECT_EQ(left.name, "ball_l");
  EXPECT_EQ(left.driver, "calf_l");
  EXPECT_EQ(left.frame_bone, limb->skeleton->find("trunk"));
  EXPECT_EQ(left.attachments[1].bone, limb->skeleton->find("shin_l"));
  EXPECT_EQ(left.attachments[1].vertices, right.attachments[1].vertices);
  EXPECT_EQ(left.bones, right.bones);  // all that have a mesh
  EXPECT_NEAR(mesh_volume(left.mesh), mesh_volume(right.mesh), 1e-9);
  for (std::size_t v = 0; v < right.mesh.positions.size(); ++v) {
    ASSERT_EQ(left.mesh.positions[v], right.mesh.positions[v] * glm::vec3(-1, 1, 1));
  }
  EXPECT_EQ(left.fibres[0].points[1], right.fibres[0].points[1] * glm::vec3(-1, 1, 1));
  EXPECT_THAT(limb->hidden_muscles, ElementsAre(1, 1));
  EXPECT_EQ(limb->surface_muscles.size(), 2u);
}

TEST_F(LoadSurfaces, AttachmentsNearAPointBeyondAPlaneOfTheCharacterAndByNumber) {
  std::string text(kLimb);
  text = with(std::move(text), R"("beyond": { "normal": [0, 2, 0], "at": 90 })",
              R"("beyond": { "normal": [0, 1, 1], "at": 0.09, "space": "character" })");
  text = with(std::move(text), R"("within_mm": 4)", R"("near": { "position": [0, 0.1, 0], "radius_mm": 20 })");
  text = with(std::move(text), R"("fibres")", R"("frame": "shin_r", "fibres")");
  auto limb = load(text);
  ASSERT_TRUE(limb);
  const SurfaceMuscleDescription& ball = limb->surface_descriptions[0];
  EXPECT_EQ(ball.frame_bone, limb->skeleton->find("shin_r"));
  EXPECT_EQ(ball.attachments[0].vertices,
            vertices_where([](glm::vec3 p) { return (p.y + p.z) / std::sqrt(2.0f) > 0.09f; }));
  const glm::vec3 foot(-0.15f, -0.1f, 0.0f);  // the point stands in the shin's frame
  EXPECT_EQ(ball.attachments[1].vertices, vertices_where([&](glm::vec3 p) { return glm::distance(p, foot) <= 0.02f; }));

  limb = load(with(std::string(kLimb), R"("within_mm": 4)", R"("vertices": [300, 457, 301, 300])"));
  ASSERT_TRUE(limb);
  EXPECT_THAT(limb->surface_descriptions[0].attachments[1].vertices, ElementsAre(300, 301, 457));
}

// What can be mended is, and is told.
TEST_F(LoadSurfaces, AMeshThatIsInsideOutIsTurned) {
  test::write_limb(folder);
  folder.write("turned.obj", test::as_obj(test::inside_out(test::make_ball())));
  const auto limb = load(with(std::string(kLimb), "ball.obj", "turned.obj"));
  ASSERT_TRUE(limb);
  EXPECT_GT(mesh_volume(limb->surface_descriptions[0].mesh), 0.004);
  EXPECT_THAT(only_warning(), HasSubstr("/surface_muscles/0/mesh: the mesh is inside out: all its triangles are "
                                        "turned round; mend the file"));
}

TEST_F(LoadSurfaces, TurnedAndDoubleTrianglesAreMended) {
  TriangleMesh ball = test::make_ball();
  ball.indices.insert(ball.indices.end(), ball.indices.begin(), ball.indices.begin() + 3);
  std::swap(ball.indices[10], ball.indices[11]);
  test::write_limb(folder);
  folder.write("faulty.obj", test::as_obj(ball));
  const auto limb = load(with(std::string(kLimb), "ball.obj", "faulty.obj"));
  ASSERT_TRUE(limb);
  ASSERT_EQ(loaded.diagnostics().warnings.size(), 2u) << to_text(loaded.diagnostics());
  EXPECT_THAT(loaded.diagnostics().warnings[0].cause, HasSubstr("1 triangle faces the wrong way and is turned round"));
  EXPECT_THAT(loaded.diagnostics().warnings[1].cause, HasSubstr("1 triangle is without area or there twice, and left out"));
  EXPECT_EQ(limb->surface_descriptions[0].mesh.indices.size(), test::make_ball().indices.size());
}

TEST_F(LoadSurfaces, AScaleThatReflectsKeepsTheOutsideOut) {
  std::string text = with(std::string(kLimb), R"("ball.obj", "unit": "mm")",
                          R"("ball.obj", "unit": "mm", "scale": [1, 1, -1])");
  text = with(std::move(text), R"("fibres": [{ )", R"("fibres": [{ "unit": "cm", "scale": [0.1, 0.1, 0.1], )");
  const auto limb = load(text);
  ASSERT_TRUE(limb);
  EXPECT_TRUE(loaded.diagnostics().warnings.empty()) << to_text(loaded.diagnostics());
  EXPECT_GT(mesh_volume(limb->surface_descriptions[0].mesh), 0.004);
  EXPECT_NEAR(limb->surface_descriptions[0].fibres[0].points[1].z, 0.09f, 1e-6f);  // its own place, not the mesh's
}

TEST_F(LoadSurfaces, OfSeveralPiecesTheChosenOneIsTaken) {
  const TriangleMesh small = test::moved(test::make_box({-300, 0, 0}, {-250, 50, 50}), glm::mat4(1.0f));
  test::write_limb(folder);
  folder.write("two.obj", test::as_obj(test::join(small, test::make_ball())));
  const auto limb = load(with(std::string(kLimb), R"("mesh": { "file": "ball.obj")",
                              R"("piece": 1, "mesh": { "file": "two.obj")"));
  ASSERT_TRUE(limb);
  EXPECT_EQ(limb->surface_descriptions[0].mesh.positions.size(), test::make_ball().positions.size());
}

TEST_F(LoadSurfaces, AFreeMuscleSaysSo) {
  const std::size_t from = kLimb.find("\"attachments\""), to = kLimb.find("\"fibres\"");
  std::string text(kLimb);
  text.replace(from, to - from, "");
  ASSERT_TRUE(load(text));
  EXPECT_THAT(only_warning(), HasSubstr("/surface_muscles/0: the muscle 'ball_r' is attached to no bone; give it "
                                        "\"attachments\", or say \"free\": true"));
  const auto limb = load(with(std::move(text), "\"fibres\"", "\"free\": true, \"frame\": \"trunk\", \"fibres\""));
  ASSERT_TRUE(limb);
  EXPECT_TRUE(loaded.diagnostics().warnings.empty()) << to_text(loaded.diagnostics());
}

TEST_F(LoadSurfaces, FibresOfAFileAreJoinedWhereTheyGoOn) {
  folder.write("lines.vtk", "# vtk DataFile Version 3.0\nfibres\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n"
                            "-150 100 0  -150 50 85  -150 0 100  -150 99 9  -150 -99 9\n"
                            "LINES 3 9\n2 0 1\n2 1 2\n2 3 4\n");
  const auto limb = load(with(std::string(kLimb), R"("points": [[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]])",
                              R"("file": "lines.vtk", "head": 3)"));
  ASSERT_TRUE(limb);
  const auto& fibres = limb->surface_descriptions[0].fibres;
  ASSERT_EQ(fibres.size(), 2u);
  EXPECT_EQ(fibres[0].points.size(), 3u);
  EXPECT_EQ(fibres[1].points.size(), 2u);
  EXPECT_EQ(fibres[1].head, 3u);
  EXPECT_NEAR(fibres[0].points[1].z, 0.085f, 1e-6f);
  // Live reload watches it.
  EXPECT_THAT(limb->files, testing::Contains(folder.path() / "lines.vtk"));
  EXPECT_THAT(limb->files, testing::Contains(folder.path() / "ball.obj"));
}

TEST_F(LoadSurfaces, InnerFibresAreMadeAndTheirFaultsStandAtTheirPlace) {
  const auto limb = load(with(std::string(kLimb), R"("fibres")",
                              R"("inner_fibres": { "method": "isocontours", "count": 12, "points": 5 }, "fibres")"));
  ASSERT_TRUE(limb);
  ASSERT_TRUE(limb->fibre_bundles.at(0));
  EXPECT_EQ(limb->fibre_bundles[0]->count, 12u);
  EXPECT_EQ(limb->fibre_bundles[0]->points_per_fibre, 5u);
  ASSERT_TRUE(load(kLimb));
  EXPECT_FALSE((*loaded)->fibre_bundles.at(0));

  // Fibres between those on the surface, where there are none.
  std::string text = with(std::string(kLimb), R"("fibres": [{ "points": [[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]] }],)",
                          R"("inner_fibres": { "method": "surface" },)");
  const auto broken = load_character(test::write_limb(folder, text), {.bone_fields = false});
  ASSERT_FALSE(broken.ok());
  EXPECT_EQ(broken.diagnostics().errors[0].path, "/surface_muscles/0/inner_fibres");
  EXPECT_GT(broken.diagnostics().errors[0].line, 0);
}

TEST_F(LoadSurfaces, ComeWithMusclesFromAnotherFile) {
  test::write_limb(folder);
  std::string text(kLimb);
  const std::size_t from = text.find("\"muscles\""), to = text.find("\n}\n");
  text.replace(from, to - from, "\"muscles_from\": \"other.character.json\"");
  folder.write("other.character.json", kLimb);
  const auto limb = load(text);
  ASSERT_TRUE(limb);
  EXPECT_EQ(limb->surface_muscles.size(), 1u);
}

}  // namespace
}  // namespace fascicle::muscle
