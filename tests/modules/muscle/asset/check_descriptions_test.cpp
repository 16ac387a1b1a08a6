// Broken descriptions: each is refused with a fault at the right field. One table row a fault.
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "tests/support/synthetic_muscles.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// A sound muscle with one via point.
MuscleDescription sound() {
  MuscleDescription muscle;
  muscle.name = "sound";
  muscle.attachments = {{0, {0.0f, 0.0f, 0.0f}, true}, {0, {0.0f, -0.1f, 0.02f}, true}, {1, {0.0f, -0.1f, 0.0f}, true}};
  muscle.hill = {1000.0f, 0.1f, 0.2f, 0.1f};
  return muscle;
}

std::vector<glm::mat4> two_bones() {
  return {glm::mat4(1.0f), glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, -0.4f, 0.0f))};
}

struct Broken {
  const char* name;
  std::function<void(MuscleDescription&)> change;
  const char* path;   // what the fault's path ends with
  const char* cause;  // part of the cause
};

void PrintTo(const Broken& broken, std::ostream* to) { *to << broken.name; }

class BrokenDescription : public testing::TestWithParam<Broken> {};

TEST_P(BrokenDescription, IsRefusedAtItsField) {
  MuscleDescription muscle = sound();
  muscle.where = {"walker.json", 12, 3, "/muscles/4", "", ""};
  GetParam().change(muscle);
  const auto result = build_muscle_asset(std::vector{muscle}, two_bones());
  ASSERT_FALSE(result.ok());
  bool found = false;
  for (const Diagnostic& error : result.diagnostics().errors) {
    EXPECT_EQ(error.file, "walker.json");
    EXPECT_EQ(error.line, 12);
    EXPECT_FALSE(error.remedy.empty());
    found = found || (error.path == std::string("/muscles/4") + GetParam().path &&
                      error.cause.find(GetParam().cause) != std::string::npos);
  }
  EXPECT_TRUE(found) << to_text(result.diagnostics());
}

using M = MuscleDescription;
INSTANTIATE_TEST_SUITE_P(
    All, BrokenDescription,
    testing::Values(
        Broken{"NoName", [](M& m) { m.name.clear(); }, "/name", "no name"},
        Broken{"NoAttachments", [](M& m) { m.attachments.clear(); }, "/origin", "0 attachments"},
        Broken{"OneAttachment", [](M& m) { m.attachments.resize(1); }, "/origin", "1 attachments"},
        Broken{"NegativeBone", [](M& m) { m.attachments[0].bone = -1; }, "/origin/bone", "bone -1"},
        Broken{"BoneOutOfRange", [](M& m) { m.attachments[1].bone = 2; }, "/via/0/bone", "bone 2"},
        Broken{"NaNPosition", [](M& m) { m.attachments[2].position.y = kNaN; }, "/insertion/position", "not finite"},
        Broken{"FarPosition", [](M& m) { m.attachments[2].position.y = 1.0e6f; }, "/insertion/position", "1e+06"},
        Broken{"CoincidentVia", [](M& m) { m.attachments[1].position = m.attachments[0].position; }, "/via/0/position",
               "same place as the origin"},
        Broken{"CoincidentAcrossBones", [](M& m) { m.attachments[1].position = {0.0f, -0.5f, 0.0f}; },
               "/insertion/position", "same place"},
        Broken{"OddVertices", [](M& m) { m.section_vertices = 7; }, "/section_vertices", "|C| is 7"},
        Broken{"FewVertices", [](M& m) { m.section_vertices = 4; }, "/section_vertices", "|C| is 4"},
        Broken{"ManyVertices", [](M& m) { m.section_vertices = 258; }, "/section_vertices", "|C| is 258"},
        Broken{"DeepSubdivision", [](M& m) { m.longitudinal_subdivision = 7; }, "/longitudinal_subdivision", "it is 7"},
        Broken{"NegativeForce", [](M& m) { m.hill.max_isometric_force = -1.0f; }, "/max_isometric_force", "-1"},
        Broken{"NaNFibre", [](M& m) { m.hill.optimal_fibre_length = kNaN; }, "/optimal_fibre_length", "nan"},
        Broken{"NegativeSlack", [](M& m) { m.hill.tendon_slack_length = -0.1f; }, "/tendon_slack_length", "-0.1"},
        Broken{"WidePennation", [](M& m) { m.hill.pennation = 1.6f; }, "/pennation", "1.6"},
        Broken{"InfiniteSource", [](M& m) { m.source_length = kInfinity; }, "/source_length", "inf"},
        Broken{"NegativeTension", [](M& m) { m.specific_tension = -1.0f; }, "/specific_tension", "-1"},
        Broken{"NegativeTendon", [](M& m) { m.tendon_at_origin = -0.5f; }, "/tendon/origin", "-0.5"},
        Broken{"TendonsOverlap", [](M& m) { m.tendon_at_origin = 0.6f; }, "/tendon", "sum to 1.1"},
        Broken{"NoBelly", [](M& m) { m.tendon_at_insertion = 1.0f; m.hill.tendon_slack_length = 5.0f; }, "/tendon",
               "no belly"},
        Broken{"ZeroPcsa", [](M& m) { m.pcsa = 0.0f; }, "/pcsa", "it is 0"},
        Broken{"NaNVolume", [](M& m) { m.volume = kNaN; }, "/volume", "nan"},
        Broken{"PcsaWithoutFibre", [](M& m) { m.pcsa = 0.001f; m.hill.optimal_fibre_length = 0.0f; }, "",
               "its fibre length, which is missing"},
        Broken{"NoRadiusSource", [](M& m) { m.hill = {}; }, "", "nothing says how thick"},
        Broken{"ProfileCounts", [](M& m) { m.profile.fractions = {0.0f, 1.0f}; m.profile.radii = {1.0f}; }, "/profile",
               "2 fractions but 1 radii"},
        Broken{"ProfileFalls", [](M& m) { m.profile.fractions = {0.5f, 0.5f}; m.profile.radii = {1.0f, 1.0f}; },
               "/profile/fractions/1", "0.5"},
        Broken{"ProfileOutside", [](M& m) { m.profile.fractions = {1.5f}; m.profile.radii = {1.0f}; },
               "/profile/fractions/0", "1.5"},
        Broken{"ProfileNegative", [](M& m) { m.profile.fractions = {0.5f}; m.profile.radii = {-1.0f}; },
               "/profile/radii/0", "-1"},
        Broken{"ProfileFlat", [](M& m) { m.profile.fractions = {0.5f}; m.profile.radii = {0.0f}; }, "/profile/radii",
               "all are zero"}),
    [](const testing::TestParamInfo<Broken>& row) { return std::string(row.param.name); });

TEST(CheckDescriptions, SoundOneIsBuilt) {
  const auto result = build_muscle_asset(std::vector{sound()}, two_bones());
  EXPECT_TRUE(result.ok()) << to_text(result.diagnostics());
}

TEST(CheckDescriptions, AllFaultsComeInOneGo) {
  MuscleDescription first = sound(), second = sound();
  first.section_vertices = 5;
  first.hill.pennation = -1.0f;
  second.attachments[0].bone = 9;
  const auto result = build_muscle_asset(std::vector{first, second}, two_bones());
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.diagnostics().errors.size(), 4u) << to_text(result.diagnostics());  // and the doubled name
}

TEST(CheckDescriptions, DoubledNamesAreRefused) {
  const auto result = build_muscle_asset(std::vector{sound(), sound()}, two_bones());
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.diagnostics().errors[0].cause.find("occurs twice"), std::string::npos);
}

TEST(CheckDescriptions, BonesMustBeFiniteAndRegular) {
  std::vector<glm::mat4> bones = two_bones();
  bones[1][3].x = kNaN;
  EXPECT_FALSE(build_muscle_asset(std::vector{sound()}, bones).ok());
  bones = two_bones();
  bones[1][0] = glm::vec4(0.0f);
  EXPECT_FALSE(build_muscle_asset(std::vector{sound()}, bones).ok());
}

TEST(CheckDescriptions, FitsMustHaveTheRightSize) {
  const std::vector<MuscleDescription> muscles{sound()};
  std::vector<MuscleFit> fits(2);
  EXPECT_FALSE(build_muscle_asset(muscles, two_bones(), fits).ok());
  fits.resize(1);
  EXPECT_TRUE(build_muscle_asset(muscles, two_bones(), fits).ok());
  fits[0].displacements.resize(4);
  EXPECT_FALSE(build_muscle_asset(muscles, two_bones(), fits).ok());
  fits[0].displacements.resize(5);
  fits[0].radii.assign(39, 0.01f);
  EXPECT_FALSE(build_muscle_asset(muscles, two_bones(), fits).ok());
  fits[0].radii.assign(40, 0.01f);
  EXPECT_TRUE(build_muscle_asset(muscles, two_bones(), fits).ok());
  fits[0].end_normals[1] = glm::vec3(0.0f, 0.6f, 0.8f);
  EXPECT_TRUE(build_muscle_asset(muscles, two_bones(), fits).ok());
  for (const glm::vec3& normal : {glm::vec3(0.0f), glm::vec3(0.0f, 0.9f, 0.9f), glm::vec3(kNaN, 0.0f, 1.0f)}) {
    fits[0].end_normals[1] = normal;
    EXPECT_FALSE(build_muscle_asset(muscles, two_bones(), fits).ok());
  }
  fits[0].end_normals = {};
  fits[0].radii[3] = kNaN;
  EXPECT_FALSE(build_muscle_asset(muscles, two_bones(), fits).ok());
}

TEST(CheckDescriptions, NoMusclesIsAnEmptyAsset) {
  const auto result = build_muscle_asset({}, two_bones());
  ASSERT_TRUE(result.ok());
  EXPECT_EQ((*result)->size(), 0u);
}

}  // namespace
}  // namespace fascicle::muscle
