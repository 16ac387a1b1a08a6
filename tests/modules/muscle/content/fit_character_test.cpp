// Fits at load: which muscles get them, from where, and what is said.
#include "modules/muscle/content/fit_character.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <gmock/gmock.h>

#include "engine/content/file_text.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::muscle {
namespace {

using test::as_obj;
using test::ScratchFolder;
using test::with;
using testing::HasSubstr;

namespace fs = std::filesystem;

// Two bones in a row, and a muscle of two points inside a spindle of 40 cm by 8 cm, which is given in millimetres.
constexpr std::string_view kArm = R"({
  "version": 1, "name": "arm",
  "skeleton": { "joints": { "bodies": [{ "name": "upper" }, { "name": "lower" }], "coordinates": [], "joints": [
    { "name": "root", "parent": "ground", "child": "upper" },
    { "name": "elbow", "parent": "upper", "child": "lower", "parent_frame": { "translation": [0, 0, 0.1] } }] } },
  "bone_meshes": [{ "bone": "upper", "file": "bone.obj" }],
  "mirror": { "axis": "x", "bones": [["_r", "_l"]], "names": [["_r", "_l"]] },
  "level": { "section_vertices": 12, "longitudinal_subdivision": 3 },
  "muscles": [{ "name": "biceps_r",
    "origin": { "bone": "upper", "position": [0.02, 0, -0.19] },
    "insertion": { "bone": "lower", "position": [0.02, 0, 0.09] },
    "volume": 0.0004, "mesh": { "file": "spindle.obj", "unit": "mm" } }]
})";

// Joints have x forward and z to the right, the character's rest space z forward and x to the left.
TriangleMesh spindle() {
  TriangleMesh mesh = test::make_sphere(40.0f, 24, 36);
  for (glm::vec3& p : mesh.positions) p = {-5.0f * p.z, p.y, p.x + 20.0f};
  return mesh;
}

class FitCharacter : public testing::Test {
 protected:
  FitCharacter() {
    folder.write("spindle.obj", as_obj(spindle()));
    folder.write("bone.obj", as_obj(test::make_box({0, -0.2f, -0.21f}, {0.04f, 0.2f, -0.16f})));
  }

  std::shared_ptr<const CharacterAsset> load(const std::string& text, LoadOptions options = {}) {
    Result<std::shared_ptr<const CharacterAsset>> loaded = load_character(folder.write("arm.character.json", text), options);
    warnings = to_text(loaded.diagnostics());
    if (!loaded) throw std::runtime_error(warnings);
    return *loaded;
  }

  fs::path store() const { return folder.path() / "arm.fit.json"; }

  // As fascicle-cook fit does.
  void keep(const CharacterAsset& asset) {
    FitStore fits;
    for (std::size_t i = 0; i < asset.fits.size(); ++i) fits.emplace(asset.descriptions[i].name, asset.fits[i]);
    ASSERT_TRUE(write_text_atomically(store(), write_fit_store(fits)).ok());
  }

  static float widest(const CharacterAsset& asset) {
    float most = 0.0f;
    for (std::uint32_t k = 0; k < asset.muscles->muscles[0].section_count; ++k) {
      most = std::max(most, asset.muscles->rest_radii[asset.muscles->radius(0, k)]);
    }
    return most;
  }

  ScratchFolder folder;
  std::string warnings;
};

TEST_F(FitCharacter, AMeshInAnotherUnitIsSaidAndNotFitted) {
  const auto arm = load(with(std::string(kArm), R"(, "unit": "mm")", ""));
  EXPECT_THAT(warnings, HasSubstr("arm.character.json:12:31: /muscles/0/mesh: biceps_r: its mesh"));
  EXPECT_THAT(warnings, HasSubstr("it seems to be in millimetres"));
  EXPECT_TRUE(arm->fits[0].levels[0].fitted.fit.radii.empty());
  EXPECT_LT(widest(*arm), 0.1f);  // the unfitted shape
}

TEST_F(FitCharacter, AMissedMeshIsSaidAndNotFitted) {
  const auto arm = load(with(std::string(kArm), R"("unit": "mm")", R"("unit": "mm", "translation": [5, 0, 0])"));
  EXPECT_THAT(warnings, HasSubstr("biceps_r"));
  EXPECT_TRUE(arm->fits[0].levels[0].fitted.fit.radii.empty());
}

TEST_F(FitCharacter, IsInTheMeshsUnitAndPlace) {
  const auto arm = load(std::string(kArm));
  EXPECT_EQ(warnings, "");
  EXPECT_NEAR(widest(*arm), 0.04f, 1e-3f);
  EXPECT_EQ(arm->muscles->muscles[0].section_count, 9u);
  const auto moved = load(with(with(std::string(kArm), R"("unit": "mm")", R"("unit": "mm", "scale": [1, 2, 2], "translation": [0, 0, -0.02])"), "\"name\": \"arm\"", "\"name\": \"far\""));
  EXPECT_NEAR(widest(*moved), 0.08f, 2e-3f);
}

TEST_F(FitCharacter, CanBeTurnedOff) {
  const float unfitted = widest(*load(std::string(kArm), {.fit = FitMode::kNone}));
  EXPECT_EQ(widest(*load(with(std::string(kArm), R"("volume")", R"("fit": false, "volume")"))), unfitted);
  EXPECT_EQ(widest(*load(with(std::string(kArm), R"("level")", R"("fit": { "enabled": false }, "level")"))), unfitted);
  EXPECT_NE(widest(*load(std::string(kArm))), unfitted);
}

TEST_F(FitCharacter, HasCoarserLevels) {
  const auto arm = load(std::string(kArm));
  ASSERT_EQ(arm->levels->assets.size(), 3u);
  EXPECT_EQ(arm->levels->assets[0], arm->muscles);
  EXPECT_EQ(arm->levels->assets[1]->muscles[0].section_vertices, 6u);
  EXPECT_EQ(arm->levels->assets[1]->muscles[0].section_count, 5u);
  EXPECT_EQ(arm->levels->assets[2]->muscles[0].section_vertices, 6u);
  EXPECT_EQ(arm->levels->assets[2]->muscles[0].section_count, 3u);
  const auto alone = load(with(std::string(kArm), R"("level": {)", R"("level": { "coarser_levels": 0,)"));
  EXPECT_EQ(alone->levels->assets.size(), 1u);
}

TEST_F(FitCharacter, AStoredFitIsUsedWhileItsInputsAreTheSame) {
  const auto arm = load(std::string(kArm));
  keep(*arm);
  // A mark in the store shows that it is read.
  const std::string kept = *read_text_file(store());
  FitStore marked = *parse_fit_store(kept, "arm");
  for (float& radius : marked.begin()->second.levels[0].fitted.fit.radii) radius = 0.0625f;
  folder.write("arm.fit.json", write_fit_store(marked));
  EXPECT_EQ(widest(*load(std::string(kArm))), 0.0625f);
  EXPECT_NEAR(widest(*load(std::string(kArm), {.fit = FitMode::kFresh})), 0.04f, 1e-3f);

  // Whatever the fit depends on makes it out of date.
  const std::pair<const char*, const char*> changes[] = {
      {R"("position": [0.02, 0, -0.19])", R"("position": [0.02, 0.001, -0.19])"},
      {R"("translation": [0, 0, 0.1])", R"("translation": [0, 0, 0.101])"},
      {R"("section_vertices": 12)", R"("section_vertices": 10)"},
      {R"("longitudinal_subdivision": 3)", R"("longitudinal_subdivision": 2)"},
      {R"("unit": "mm")", R"("unit": "mm", "translation": [0.001, 0, 0])"},
      {R"("level")", R"("fit": { "supersampling": 2 }, "level")"},
      {R"("level": {)", R"("level": { "coarser_levels": 1,)"},
      {R"([0.02, 0, -0.19] })", R"([0.02, 0, -0.19], "area": { "within_mm": 10 } })"},
  };
  for (const auto& [from, to] : changes) EXPECT_LT(widest(*load(with(std::string(kArm), from, to))), 0.05f) << to;
  folder.write("spindle.obj", as_obj(spindle()) + "f 1 2 3\n");
  EXPECT_LT(widest(*load(std::string(kArm))), 0.05f);
}

TEST_F(FitCharacter, AStoredFitGivesTheSameMuscleBitForBit) {
  const auto fresh = load(std::string(kArm));
  keep(*fresh);
  const auto stored = load(std::string(kArm));
  EXPECT_EQ(stored->muscles->rest_radii, fresh->muscles->rest_radii);
  EXPECT_EQ(stored->muscles->rest_x, fresh->muscles->rest_x);
  EXPECT_EQ(stored->levels->assets[2]->rest_radii, fresh->levels->assets[2]->rest_radii);
}

TEST_F(FitCharacter, ABrokenStoreIsSaidAndHarmless) {
  const float width = widest(*load(std::string(kArm)));
  for (const std::string text : {"", "{", R"({ "version": 1, "muscles": [{}] })"}) {
    folder.write("arm.fit.json", text);
    EXPECT_EQ(widest(*load(std::string(kArm))), width);
    EXPECT_THAT(warnings, HasSubstr("the stored fits cannot be used"));
    EXPECT_THAT(warnings, HasSubstr("run fascicle-cook fit"));
  }
}

// Whatever was changed in a store by hand: it is not used, and no fault of the author's file.
TEST_F(FitCharacter, AStoreThatWasEditedIsSaidAndNotUsed) {
  const auto arm = load(std::string(kArm));
  const float width = widest(*arm);
  keep(*arm);
  const std::string kept = *read_text_file(store());
  for (const auto& [from, to] : {std::pair{"\"section_vertices\": 12", "\"section_vertices\": 14"},
                                 std::pair{"\"longitudinal_subdivision\": 3", "\"longitudinal_subdivision\": 4"},
                                 std::pair{"\"displacements\": [0,", "\"displacements\": [50,"}}) {
    std::string edited = kept;
    edited.replace(edited.find(from), std::string_view(from).size(), to);
    folder.write("arm.fit.json", edited);
    EXPECT_EQ(widest(*load(std::string(kArm))), width) << to;
    EXPECT_THAT(warnings, HasSubstr("arm.fit.json")) << to;
  }
}

TEST_F(FitCharacter, APipeInPlaceOfAStoreIsNotReadForEver) {
  ASSERT_EQ(mkfifo(store().c_str(), 0600), 0);
  load(std::string(kArm));
  EXPECT_THAT(warnings, HasSubstr("this is no ordinary file"));
}

TEST_F(FitCharacter, ABrokenMeshFileLeavesTheMuscleUnfitted) {
  const float unfitted = widest(*load(std::string(kArm), {.fit = FitMode::kNone}));
  for (const std::string text : {"", "v 0 0 0\n", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}) {
    folder.write("spindle.obj", text);
    EXPECT_EQ(widest(*load(std::string(kArm))), unfitted) << text;
    EXPECT_THAT(warnings, HasSubstr("arm.character.json:12:"));
    EXPECT_THAT(warnings, HasSubstr("the mesh file cannot be used: "));
    EXPECT_THAT(warnings, HasSubstr("the muscles keep their unfitted shapes"));
  }
}

TEST_F(FitCharacter, ABoundChoosesTheLevel) {
  const auto with_bound = [&](const char* bound) {
    return load(with(std::string(kArm), R"("section_vertices": 12, "longitudinal_subdivision": 3)", bound));
  };
  const auto coarse = with_bound(R"("max_distance_mm": 12)");
  EXPECT_EQ(warnings, "");
  const auto fine = with_bound(R"("max_distance_mm": 9.5)");
  EXPECT_GT(fine->muscles->vertex_count, coarse->muscles->vertex_count);
  EXPECT_EQ(fine->descriptions[0].section_vertices, fine->muscles->muscles[0].section_vertices);
  with_bound(R"("max_distance_mm": 0.001)");
  EXPECT_THAT(warnings, HasSubstr("no level of detail keeps within 0.001 mm of the mesh"));
}

TEST_F(FitCharacter, WarningsOfAStoredFitAreSaidAgain) {
  std::string open = as_obj(spindle());
  open.erase(open.rfind("f "));
  folder.write("spindle.obj", open);
  const auto arm = load(std::string(kArm));
  const std::string fresh = warnings;
  EXPECT_THAT(fresh, HasSubstr("open edges"));
  keep(*arm);
  load(std::string(kArm));
  EXPECT_EQ(warnings, fresh);
}

TEST_F(FitCharacter, AnAreaNearABoneOrAPointIsFound) {
  const auto area = [&](const std::string& of) {
    load(with(std::string(kArm), R"([0.02, 0, -0.19] })", R"([0.02, 0, -0.19], "area": { )" + of + " } }"));
    return warnings;
  };
  EXPECT_EQ(area(R"("within_mm": 5)"), "");
  EXPECT_EQ(area(R"("radius_mm": 30)"), "");
  EXPECT_THAT(area(R"("radius_mm": 0.01)"), HasSubstr("no triangle of the mesh lies in the area (0.01 mm)"));
  EXPECT_THAT(area(R"("within_mm": 5, "bone": "lower")"),
              HasSubstr("the bone 'lower' has no mesh to measure the area's distance from"));
}

TEST_F(FitCharacter, MusclesWithOneMeshAreItsHeads) {
  std::string two(kArm);
  two = with(two, R"("name": "biceps_r",)", R"("name": "short_r", "section_vertices": 16,)");
  const std::size_t start = two.find("{ \"name\": \"short_r\""), end = two.rfind("}]") + 1;
  std::string second = with(two.substr(start, end - start), "short_r", "long_r");
  for (const char* place : {"[0.02, 0, -0.19]", "[0.02, 0, 0.09]"}) {
    two = with(two, place, with(place, "0.02, 0,", "0.02, -0.02,"));
    second = with(second, place, with(place, "0.02, 0,", "0.02, 0.02,"));
  }
  const auto arm = load(two.insert(two.rfind("}]") + 1, ", " + second));
  EXPECT_EQ(warnings, "");
  ASSERT_EQ(arm->fits.size(), 2u);
  EXPECT_EQ(arm->muscle_meshes.at("short_r"), arm->muscle_meshes.at("long_r"));
  // Each has about half of the spindle.
  const double whole = 4.0 / 3.0 * 3.14159 * 0.04 * 0.04 * 0.2;
  for (int i = 0; i < 2; ++i) {
    EXPECT_GT(double{arm->muscles->muscles[static_cast<std::size_t>(i)].rest_volume}, 0.25 * whole);
    EXPECT_LT(double{arm->muscles->muscles[static_cast<std::size_t>(i)].rest_volume}, 0.6 * whole);
  }
}

}  // namespace
}  // namespace fascicle::muscle
