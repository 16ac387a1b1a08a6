#include "modules/muscle/import/import_osim.hpp"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/animation/joint_model_reader.hpp"
#include "engine/content/file_text.hpp"
#include "engine/content/json_reader.hpp"
#include "modules/muscle/import/osim_reader.hpp"
#include "tests/modules/muscle/import/small_model.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

using test::small_model;
using test::with;
using testing::HasSubstr;

std::string import_text(const std::string& osim, Diagnostics* diagnostics = nullptr) {
  const Result<OsimModel> model = parse_osim(osim, "small.osim");
  EXPECT_TRUE(model.ok()) << to_text(model.diagnostics());
  if (!model) return {};
  const Result<std::string> text = import_character(*model, {});
  if (diagnostics != nullptr) *diagnostics = text.diagnostics();
  return text.ok() ? *text : std::string();
}

TEST(ImportOsim, RefusesAMuscleThatHasNoLengthOrNoForce) {
  Diagnostics diagnostics;
  // On the ground, at the plate's point in the default pose.
  import_text(with(small_model(), "<location>0 1.1 0</location>", "<location>0 1.1 0.1</location>"), &diagnostics);
  EXPECT_THAT(to_text(diagnostics), HasSubstr("plain: in the default pose the path has no length"));
  import_text(with(small_model(), "<max_isometric_force>1200<", "<max_isometric_force>0<"), &diagnostics);
  EXPECT_THAT(to_text(diagnostics), HasSubstr("its max_isometric_force is 0"));
}

TEST(ImportOsim, RefusesWhatACharacterFileCannotHold) {
  Diagnostics diagnostics;
  // A spline that lies beyond the range of character files once it is multiplied.
  std::string text = with(small_model(), "<x>-2 0</x><y>1 0</y>", "<x>-2 0</x><y>100 0</y>");
  text = with(text, "<scale>0.01</scale>", "<scale>1e8</scale>");
  EXPECT_EQ(import_text(text, &diagnostics), "");
  EXPECT_THAT(to_text(diagnostics), HasSubstr("beyond 1e9"));
}

TEST(ImportOsim, TakesPointsInTheirDefaultStateWithOneWarningAMuscle) {
  Diagnostics diagnostics;
  const std::string text = import_text(small_model(), &diagnostics);
  std::size_t of_muscles = 0;
  for (const Diagnostic& warning : diagnostics.warnings)
    of_muscles += warning.path == "extensor" || warning.path == "plain";
  EXPECT_EQ(of_muscles, 1u);
  EXPECT_THAT(to_text(diagnostics), HasSubstr("conditional points stay off: P2; moving points stand still: P3; "
                                              "it does not wrap over: condyle"));
  const auto document = parse_json(text, "small.character.json");
  ASSERT_TRUE(document.ok()) << to_text(document.diagnostics());
  const JsonNode muscle = document->root().member("muscles").element(0);
  EXPECT_EQ(muscle.member("via").size(), 1u);
  // At knee_angle -0.1: x on the line from (-2, 0.03) to (0.2, 0.05), y = 0.01 q + 0.02.
  std::vector<double> position;
  ASSERT_TRUE(muscle.member("via").element(0).member("position").read(position, diagnostics));
  EXPECT_NEAR(position[0], 0.03 + 1.9 * 0.02 / 2.2, 1e-15);
  EXPECT_NEAR(position[1], 0.019, 1e-15);
}

TEST(ImportOsim, LeavesOutPointsInTheirNeighboursPlace) {
  Diagnostics diagnostics;
  const std::string twice = "<PathPoint name=\"P1b\"><socket_parent_frame>/bodyset/thigh</socket_parent_frame>"
                            "<location>0.03 -0.1 0</location></PathPoint><ConditionalPathPoint name=\"P2\">";
  const std::string text = import_text(with(small_model(), "<ConditionalPathPoint name=\"P2\">", twice), &diagnostics);
  EXPECT_THAT(to_text(diagnostics), HasSubstr("points in the place of their neighbour are left out: P1b"));
  EXPECT_THAT(text, HasSubstr("\"origin\": { \"bone\": \"thigh\", \"position\": [0.03, -0.1, 0] }"));
}

TEST(ImportOsim, NamesSourceAndLicence) {
  const std::string text = import_text(small_model());
  EXPECT_THAT(text, HasSubstr("\"licence\": \"CC BY 4.0\""));
  EXPECT_THAT(text, HasSubstr("OpenSim model small (small.osim). Made for tests."));
  EXPECT_EQ(find_licence("Creative Commons (CCBY 3.0). You are free"), "CC BY 3.0");
  EXPECT_EQ(find_licence("under CC BY-NC 4.0."), "CC BY-NC 4.0");
  EXPECT_EQ(find_licence("all rights reserved"), "");
}

// Import, write, read: the same poses to the last bit.
void expect_same_poses(const JointModel& model, const std::string& text) {
  const auto document = parse_json(text, "made.character.json");
  ASSERT_TRUE(document.ok()) << to_text(document.diagnostics());
  const auto read = read_joint_model(document->root().member("skeleton").member("joints"));
  ASSERT_TRUE(read.ok()) << to_text(read.diagnostics());
  ASSERT_EQ(read->skeleton->names, model.skeleton->names);
  ASSERT_EQ(read->coordinates.size(), model.coordinates.size());
  std::mt19937 random(7);
  for (int pose = 0; pose < 50; ++pose) {
    std::vector<double> values;
    for (const JointCoordinate& c : model.coordinates) {
      values.push_back(std::uniform_real_distribution<double>(c.minimum - 0.5, c.maximum + 0.5)(random));
    }
    const auto expected = evaluate_bones(model, values);
    const auto actual = evaluate_bones(*read, values);
    for (std::size_t b = 0; b < expected.size(); ++b) {
      ASSERT_EQ(actual[b].translation, expected[b].translation) << model.skeleton->names[b];
      ASSERT_EQ(actual[b].rotation, expected[b].rotation) << model.skeleton->names[b];
    }
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    EXPECT_EQ(read->bodies[b].mass, model.bodies[b].mass);
    EXPECT_EQ(read->bodies[b].mass_center, model.bodies[b].mass_center);
    EXPECT_EQ(read->bodies[b].inertia, model.bodies[b].inertia);
  }
}

TEST(ImportOsim, WrittenJointsReadBackExactly) {
  const Result<OsimModel> model = parse_osim(small_model(), "small.osim");
  ASSERT_TRUE(model.ok());
  const Result<std::string> text = import_character(*model, {});
  ASSERT_TRUE(text.ok()) << to_text(text.diagnostics());
  expect_same_poses(model->joints, *text);
}

struct RealModel {
  const char* name;
  std::size_t warned;  // muscles with conditional or moving points or wraps
};

class RealModels : public testing::TestWithParam<RealModel> {};

TEST_P(RealModels, BecomeCharacters) {
  const std::string file = std::string("opensim/") + GetParam().name + ".osim";
  FASCICLE_SKIP_WITHOUT_DATA(file);
  const Result<OsimModel> model = read_osim(test::data_folder() / file);
  ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
  ImportOptions options;
  options.geometry_folder = test::data_folder() / "opensim" / "Geometry";
  options.geometry_prefix = "data:opensim/Geometry/";
  const Result<std::string> text = import_character(*model, options);
  ASSERT_TRUE(text.ok()) << to_text(text.diagnostics());
  EXPECT_EQ(*text, *import_character(*model, options));
  expect_same_poses(model->joints, *text);
  const auto document = parse_json(*text, "made.character.json");
  EXPECT_EQ(document->root().member("muscles").size(), model->muscles.size());
  EXPECT_EQ(document->root().member("bone_meshes").size(), model->geometry.size());
  std::size_t warned = 0;
  for (const OsimMuscle& muscle : model->muscles) {
    const auto of_muscle = std::count_if(text.diagnostics().warnings.begin(), text.diagnostics().warnings.end(),
                                         [&](const Diagnostic& warning) { return warning.path == muscle.name; });
    EXPECT_LE(of_muscle, 1) << muscle.name;
    warned += static_cast<std::size_t>(of_muscle);
    // Fixed points come through as the very figures of the model.
    for (const OsimPathPoint& point : muscle.points) {
      if (point.kind != OsimPathPoint::Kind::kFixed) continue;
      EXPECT_THAT(*text, HasSubstr(fmt::format("[{}, {}, {}]", point.location.x + 0.0, point.location.y + 0.0,
                                               point.location.z + 0.0)));
    }
  }
  EXPECT_EQ(warned, GetParam().warned);
}

// The file that ships is what the import makes today.
TEST(ImportOsim, TheShippedCharacterIsUpToDate) {
  FASCICLE_SKIP_WITHOUT_DATA("opensim/gait2392.osim");
  const Result<OsimModel> model = read_osim(test::data_folder() / "opensim" / "gait2392.osim");
  ASSERT_TRUE(model.ok());
  ImportOptions options;
  options.name = "gait2392";
  options.geometry_folder = test::data_folder() / "opensim" / "Geometry";
  options.geometry_prefix = "data:opensim/Geometry/";
  const Result<std::string> text = import_character(*model, options);
  const auto shipped = read_text_file(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "characters" /
                                      "gait2392" / "gait2392.character.json");
  ASSERT_TRUE(text.ok() && shipped.ok());
  // But for the line that fascicle-cook constrain has added.
  std::string imported = *shipped;
  const std::string reference = "  \"collision\": \"gait2392.collision.json\",\n";
  const std::size_t at = imported.find(reference);
  ASSERT_NE(at, std::string::npos);
  imported.erase(at, reference.size());
  EXPECT_TRUE(*text == imported) << "make it anew: fascicle-cook import-osim gait2392.osim --out "
                                    "content/characters/gait2392/gait2392.character.json";
}

INSTANTIATE_TEST_SUITE_P(ImportOsim, RealModels,
                         testing::Values(RealModel{"gait2392", 22}, RealModel{"gait10dof18musc", 8},
                                         RealModel{"arm26", 5}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace fascicle::muscle
