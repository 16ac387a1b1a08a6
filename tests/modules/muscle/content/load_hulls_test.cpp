// The coarse-hull solver as character files choose it: levels, lines, and hulls from the store or made at load.

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/hull/hull_asset.hpp"
#include "modules/muscle/content/content_reloader.hpp"
#include "modules/muscle/content/hull_store.hpp"
#include "modules/muscle/content/surface_hulls.hpp"
#include "tests/modules/muscle/content/scratch_surfaces.hpp"

namespace fascicle::muscle {
namespace {

using test::kLimb;
using test::ScratchFolder;
using test::with;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kLine = R"("action_line": [
        { "bone": "trunk", "at": [-150, 95, 10] },
        { "bone": "shin_r", "at": [-0.15, -0.095, 0], "space": "character" }])";

std::string limb_with(std::string fields) {
  return with(std::string(kLimb), R"("driver": "calf_r")", fields);
}

std::string hulled_limb(std::string hull = R"({ "vertices": 60 })") {
  return limb_with(R"("solver": "coarse_hull", "hull": )" + hull + ", " + kLine);
}

class LoadHulls : public testing::Test {
 protected:
  std::shared_ptr<const CharacterAsset> load(std::string_view text, HullMode mode = HullMode::kStored) {
    file = test::write_limb(folder, text);
    loaded = load_character(file, {.hulls = mode, .bone_fields = false});
    EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
    return loaded.ok() ? *loaded : nullptr;
  }
  // Hulls for this target, stored as though they were those that the muscles of `limb` ask for.
  void store_as_if(const CharacterAsset& limb, const HullTarget& target) {
    HullStore store;
    for (const SurfaceMuscleDescription& muscle : limb.surface_descriptions) {
      auto hull = build_progressive_hull(muscle.mesh, target);
      ASSERT_TRUE(hull.ok()) << to_text(hull.diagnostics());
      store[muscle.name] = {hull_inputs(muscle.mesh, hull_target(muscle)), std::move(*hull)};
    }
    folder.write("limb.hulls.json", write_hull_store(store));
  }
  const std::vector<Diagnostic>& warnings() const { return loaded.diagnostics().warnings; }

  ScratchFolder folder;
  std::filesystem::path file;
  Result<std::shared_ptr<const CharacterAsset>> loaded = Diagnostic{};
};

TEST_F(LoadHulls, AMuscleIsDynamicWhereNothingElseIsSaid) {
  const auto limb = load(kLimb);
  ASSERT_TRUE(limb);
  const SurfaceMuscleDescription& ball = limb->surface_descriptions[0];
  ASSERT_EQ(ball.levels.size(), 1u);
  EXPECT_EQ(ball.levels[0].solver, SurfaceSolver::kDynamic);
  EXPECT_THAT(ball.action_line, IsEmpty());
  ASSERT_EQ(limb->hulls.size(), 1u);
  EXPECT_FALSE(limb->hulls[0]);
  EXPECT_THAT(limb->files, Not(Contains(folder.path() / "limb.hulls.json")));
  // A hull and a line that no level asks for are kept for later.
  const auto spare = load(limb_with(std::string(R"("solver": "dynamic", "hull": { "vertices": 60 }, )") + kLine));
  ASSERT_TRUE(spare);
  EXPECT_FALSE(spare->hulls[0]);
  EXPECT_EQ(spare->surface_descriptions[0].action_line.size(), 2u);
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(LoadHulls, OneSolverIsShortForOneLevel) {
  const auto limb = load(hulled_limb(
      R"({ "vertices": 60, "error_mm": 50, "iterations": 7, "tolerance": 0.001, "refinements": 4, "bending": 3,
          "direction": 0.5 })"));
  ASSERT_TRUE(limb);
  EXPECT_THAT(warnings(), IsEmpty()) << to_text(loaded.diagnostics());
  const SurfaceMuscleDescription& ball = limb->surface_descriptions[0];
  ASSERT_EQ(ball.levels.size(), 1u);
  EXPECT_EQ(ball.levels[0].solver, SurfaceSolver::kCoarseHull);
  EXPECT_EQ(ball.levels[0].refinements, 4u);
  EXPECT_EQ(ball.levels[0].above_pixels, 0.0f);
  EXPECT_EQ(ball.hull.vertices, 60u);
  EXPECT_FLOAT_EQ(ball.hull.error, 0.05f);
  EXPECT_EQ(ball.hull.iterations, 7u);
  EXPECT_FLOAT_EQ(ball.hull.tolerance, 0.001f);
  EXPECT_EQ(ball.hull.bending, 3.0f);
  EXPECT_EQ(ball.hull.direction, 0.5f);
  ASSERT_TRUE(limb->hulls.at(0));
  EXPECT_LE(limb->hulls[0]->rest.size(), 60u);
  EXPECT_GE(limb->hulls[0]->rest.size(), 4u);
}

TEST_F(LoadHulls, SettingsAtTheirLimitsAreTaken) {
  for (const char* hull : {R"({ "vertices": 4, "tolerance": 1e-7, "bending": 0, "direction": 0, "refinements": 0 })",
                           R"({ "vertices": 1000, "iterations": 100, "tolerance": 0.1, "bending": 1000, "direction": 1000,
                               "refinements": 100 })"}) {
    const auto limb = load(hulled_limb(hull));
    ASSERT_TRUE(limb);
    ASSERT_TRUE(limb->hulls.at(0));
    EXPECT_GE(limb->hulls[0]->rest.size(), 4u);
    EXPECT_LE(limb->hulls[0]->rest.size(), 458u);  // the mesh's own
  }
}

TEST_F(LoadHulls, LevelsAreReadFromTheFinest) {
  const auto limb = load(limb_with(std::string(R"("levels": [
      { "solver": "dynamic", "above_pixels": 200 },
      { "solver": "coarse_hull", "above_pixels": 60 },
      { "solver": "coarse_hull", "refinements": 0 }], "hull": { "vertices": 60, "refinements": 5 }, )") + kLine));
  ASSERT_TRUE(limb);
  const auto& levels = limb->surface_descriptions[0].levels;
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[0].solver, SurfaceSolver::kDynamic);
  EXPECT_EQ(levels[0].above_pixels, 200.0f);
  EXPECT_EQ(levels[1].solver, SurfaceSolver::kCoarseHull);
  EXPECT_EQ(levels[1].above_pixels, 60.0f);
  EXPECT_EQ(levels[1].refinements, 5u);  // the hull's
  EXPECT_EQ(levels[2].above_pixels, 0.0f);
  EXPECT_EQ(levels[2].refinements, 0u);
  ASSERT_TRUE(limb->hulls.at(0));
  EXPECT_EQ(limb->hulls[0]->levels.size(), 3u);
}

TEST_F(LoadHulls, ADriversLineIsEnough) {
  const auto limb = load(with(std::string(kLimb), R"("driver")", R"("solver": "coarse_hull", "driver")"));
  ASSERT_TRUE(limb);
  EXPECT_THAT(limb->surface_descriptions[0].action_line, IsEmpty());
  EXPECT_TRUE(limb->hulls.at(0));
}

TEST_F(LoadHulls, ALineStandsWhereItsMeshDoes) {
  std::string text = with(hulled_limb(), R"("unit": "mm" },
      "attach)", R"("unit": "mm", "translation": [-0.01, 0, 0.02], "rotation": [0, 1, 0, 0] },
      "attach)");
  text = with(std::move(text), "ball.obj", "turned.obj");
  text = with(std::move(text), R"("fibres": [{ "points": [[-150, -100, 0], [-150, 0, 90], [-150, 100, 0]] }],)", "");
  TriangleMesh turned = test::make_ball();  // half a turn about y
  for (glm::vec3& p : turned.positions) p = glm::vec3(-10.0f - p.x, p.y, 20.0f - p.z);
  folder.write("turned.obj", test::as_obj(turned));
  const auto limb = load(with(std::move(text), "[-150, 95, 10]", "[140, 95, 10]"));
  ASSERT_TRUE(limb);
  const auto& line = limb->surface_descriptions[0].action_line;
  ASSERT_EQ(line.size(), 2u);
  EXPECT_EQ(line[0].bone, limb->skeleton->find("trunk"));
  EXPECT_LT(glm::distance(line[0].position, glm::vec3(-0.15f, 0.095f, 0.01f)), 1e-6f);
  EXPECT_EQ(line[1].bone, limb->skeleton->find("shin_r"));
  EXPECT_LT(glm::distance(line[1].position, glm::vec3(-0.15f, -0.095f, 0.0f)), 1e-6f);
}

// The belly of a muscle with long tendons: both ends are far from it.
TEST_F(LoadHulls, ALineMayBeginAndEndFarFromItsMuscleWhereItLeadsThrough) {
  std::string text = with(hulled_limb(), "[-150, 95, 10]", "[-150, 800, 10]");
  ASSERT_TRUE(load(with(text, "[-0.15, -0.095, 0]", "[-0.15, -0.8, 0]")));
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(LoadHulls, TheOtherSideHasTheLineReflectedAndAHullOfItsOwn) {
  const auto limb = load(with(hulled_limb(), "\"name\": \"ball_r\"", R"("name": "ball_r", "mirror": true)"));
  ASSERT_TRUE(limb);
  ASSERT_EQ(limb->surface_descriptions.size(), 2u);
  const auto& right = limb->surface_descriptions[0].action_line;
  const auto& left = limb->surface_descriptions[1].action_line;
  ASSERT_EQ(left.size(), 2u);
  EXPECT_EQ(left[0].bone, right[0].bone);
  EXPECT_EQ(left[1].bone, limb->skeleton->find("shin_l"));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(left[i].position, right[i].position * glm::vec3(-1, 1, 1));
  EXPECT_EQ(limb->surface_descriptions[1].levels[0].solver, SurfaceSolver::kCoarseHull);
  ASSERT_TRUE(limb->hulls.at(1));
  for (const glm::vec3& p : limb->hulls[1]->rest) EXPECT_GT(p.x, 0.0f);
}

TEST_F(LoadHulls, WithoutHullsNothingIsMade) {
  const auto limb = load(hulled_limb(), HullMode::kNone);
  ASSERT_TRUE(limb);
  EXPECT_FALSE(limb->hulls.at(0));
}

TEST_F(LoadHulls, AStoredHullIsTakenWhereItIsUpToDate) {
  const auto made = load(hulled_limb());
  ASSERT_TRUE(made);
  EXPECT_THAT(made->files, Contains(folder.path() / "limb.hulls.json"));  // so that storing one is noticed
  const std::size_t count = made->hulls.at(0)->rest.size();
  store_as_if(*made, {.vertices = 30});

  const auto stored = load(hulled_limb());
  ASSERT_TRUE(stored);
  EXPECT_LE(stored->hulls.at(0)->rest.size(), 30u);
  EXPECT_THAT(stored->files, Contains(folder.path() / "limb.hulls.json"));
  EXPECT_THAT(warnings(), IsEmpty());

  const auto fresh = load(hulled_limb(), HullMode::kFresh);
  ASSERT_TRUE(fresh);
  EXPECT_EQ(fresh->hulls.at(0)->rest.size(), count);

  // Another number of vertices, another mesh: the store is out of date, which is nobody's fault.
  const auto other = load(hulled_limb(R"({ "vertices": 61 })"));
  ASSERT_TRUE(other);
  EXPECT_GT(other->hulls.at(0)->rest.size(), 30u);
  const auto larger = load(with(hulled_limb(), R"("unit": "mm" },
      "attach)", R"("unit": "mm", "scale": [1, 1, 1.01] },
      "attach)"));
  ASSERT_TRUE(larger);
  EXPECT_EQ(larger->hulls.at(0)->rest.size(), count);
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(LoadHulls, AStoreBesideTheFileThatMusclesAreFromCounts) {
  const auto made = load(hulled_limb());
  ASSERT_TRUE(made);
  store_as_if(*made, {.vertices = 30});
  std::string text = hulled_limb();
  const std::size_t from = text.find("\"muscles\""), to = text.find("\n}\n");
  text.replace(from, to - from, "\"muscles_from\": \"limb.character.json\"");
  const auto other = load_character(folder.write("other.character.json", text), {.bone_fields = false});
  ASSERT_TRUE(other.ok()) << to_text(other.diagnostics());
  EXPECT_LE((*other)->hulls.at(0)->rest.size(), 30u);
}

TEST_F(LoadHulls, ARunningGameTakesAStoreUp) {
  const auto made = load(hulled_limb());
  ASSERT_TRUE(made);
  const auto scene = folder.write(
      "limb.scene.json", R"({ "version": 1, "name": "limb", "characters": [{ "file": "limb.character.json" }] })");
  const auto first = load_scene(scene);
  ASSERT_TRUE(first.ok()) << to_text(first.diagnostics());
  ContentReloader reloader(scene, *first);
  store_as_if(*made, {.vertices = 30});
  const auto outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  EXPECT_LE(outcome->scene->characters.at(0).character->hulls.at(0)->rest.size(), 30u);
}

TEST_F(LoadHulls, ABrokenStoreIsToldAndLeftAside) {
  const auto made = load(hulled_limb());
  ASSERT_TRUE(made);
  for (const char* text : {"", "{ \"version\": 1000, \"muscles\": [] }", "{ \"version\": 1 "}) {
    folder.write("limb.hulls.json", text);
    const auto limb = load(hulled_limb());
    ASSERT_TRUE(limb);
    ASSERT_EQ(warnings().size(), 1u) << to_text(loaded.diagnostics());
    EXPECT_THAT(to_string(warnings()[0]), HasSubstr("the stored hulls cannot be used: "));
    EXPECT_THAT(to_string(warnings()[0]), HasSubstr("they are made at load; run fascicle-cook hull --store"));
    EXPECT_EQ(limb->hulls.at(0)->rest, made->hulls.at(0)->rest);
  }
}

TEST_F(LoadHulls, AHullThatNeedsMoreVerticesThanAskedForIsToldAtItsMuscle) {
  const std::string text = hulled_limb(R"({ "vertices": 10, "error_mm": 1 })");
  const auto limb = load(text);
  ASSERT_TRUE(limb);
  const std::size_t count = limb->hulls.at(0)->rest.size();
  EXPECT_GT(count, 10u);
  const auto expect_told = [&] {
    ASSERT_EQ(warnings().size(), 1u) << to_text(loaded.diagnostics());
    EXPECT_EQ(warnings()[0].path, "/surface_muscles/0/hull");
    EXPECT_GT(warnings()[0].line, 0);
    EXPECT_THAT(warnings()[0].cause, HasSubstr("a hull no further than 1 mm away needs " + std::to_string(count) +
                                               " vertices, more than the 10 asked for"));
  };
  expect_told();
  store_as_if(*limb, hull_target(limb->surface_descriptions[0]));
  ASSERT_TRUE(load(text));
  expect_told();
}

// Near by dynamic, further away posed by hulls that are stored. It needs no data, so a change to the way hulls are made
// is noticed everywhere.
TEST(WalkerHulls, AreStoredAsTheyWouldBeMadeNow) {
  const std::filesystem::path file = std::filesystem::path(FASCICLE_SOURCE_DIR) /
                                     "content/characters/walker-surface/walker-surface.character.json";
  const auto loaded = load_character(file, {.fit = FitMode::kNone, .hulls = HullMode::kNone, .bone_fields = false});
  ASSERT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  const auto store = read_hull_store(hull_store_of(file));
  ASSERT_TRUE(store.ok()) << to_text(store.diagnostics());
  std::size_t hulls = 0;
  for (const SurfaceMuscleDescription& muscle : (*loaded)->surface_descriptions) {
    EXPECT_EQ(muscle.levels.front().solver, SurfaceSolver::kDynamic);
    if (!uses_hull(muscle)) continue;
    ++hulls;
    ASSERT_TRUE(store->contains(muscle.name)) << muscle.name;
    const StoredHull& stored = store->at(muscle.name);
    EXPECT_EQ(stored.inputs, hull_inputs(muscle.mesh, hull_target(muscle))) << muscle.name;
    const auto made = build_progressive_hull(muscle.mesh, hull_target(muscle));
    ASSERT_TRUE(made.ok()) << to_text(made.diagnostics());
    EXPECT_EQ(stored.hull.mesh.positions, made->mesh.positions) << muscle.name;
    EXPECT_EQ(stored.hull.mesh.indices, made->mesh.indices) << muscle.name;
  }
  EXPECT_EQ(hulls, 4u);
  EXPECT_EQ(store->size(), hulls);
}

TEST_F(LoadHulls, AHullThatNeedsMoreThanTheSolverTakesIsAnError) {
  const glm::mat4 upright = glm::rotate(glm::mat4(1.0f), -1.5707963f, {1.0f, 0.0f, 0.0f});
  TriangleMesh fine = test::moved(test::make_sphere(100.0f, 45, 60),
                                  glm::translate(glm::mat4(1.0f), {-150.0f, 0.0f, 0.0f}) * upright);
  folder.write("fine.obj", test::as_obj(fine));
  ASSERT_GT(fine.positions.size(), 2000u);
  const std::string text = hulled_limb(R"({ "error_mm": 0.001 })");
  const auto refused =
      load_character(test::write_limb(folder, with(text, "ball.obj", "fine.obj")), {.bone_fields = false});
  ASSERT_FALSE(refused.ok());
  ASSERT_EQ(refused.diagnostics().errors.size(), 1u) << to_text(refused.diagnostics());
  const Diagnostic& error = refused.diagnostics().errors[0];
  EXPECT_EQ(error.path, "/surface_muscles/0/hull");
  EXPECT_GT(error.line, 0);
  EXPECT_THAT(error.cause, HasSubstr("vertices, and the solver takes 1000 at most"));
  EXPECT_THAT(error.remedy, HasSubstr("error_mm"));
}

}  // namespace
}  // namespace fascicle::muscle
