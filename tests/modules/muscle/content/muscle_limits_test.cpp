// One table of limits: reader, builder and schema must draw the same lines.
#include "modules/muscle/asset/muscle_limits.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/content/json_reader.hpp"
#include "modules/muscle/asset/check_descriptions.hpp"
#include "modules/muscle/content/character_file.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::string_view kMuscle = R"({ "name": "m", "origin": { "bone": "b", "position": [0, 0, 0] },
  "insertion": { "bone": "b", "position": [0, 0.5, 0] }, "max_isometric_force": 100, "optimal_fibre_length": 0.1, )";

Diagnostics read_with(const std::string& fields) {
  const JsonDocument document = *parse_json(std::string(kMuscle) + fields + " }", "muscle.json");
  Diagnostics found;
  read_muscle_entry(document.root(), {found});
  return found;
}

MuscleDescription sound() {
  MuscleDescription muscle;
  muscle.name = "m";
  muscle.attachments = {{0, {0, 0, 0}}, {0, {0, 0.5f, 0}}};
  muscle.hill.max_isometric_force = 100.0f;
  muscle.hill.optimal_fibre_length = 0.1f;
  return muscle;
}

bool builder_takes(const MuscleDescription& muscle) {
  return check_description(muscle, std::vector{glm::mat4(1.0f)}).ok();
}

struct Row {
  const char* field;
  NumberRange range;
  std::function<void(MuscleDescription&, float)> set;
};

const std::vector<Row>& rows() {
  using M = MuscleDescription;
  static const std::vector<Row> all{
      {"max_isometric_force", kForceRange, [](M& m, float v) { m.hill.max_isometric_force = v; }},
      {"optimal_fibre_length", kFibreLengthRange, [](M& m, float v) { m.hill.optimal_fibre_length = v; }},
      {"tendon_slack_length", kTendonLengthRange, [](M& m, float v) { m.hill.tendon_slack_length = v; }},
      {"source_length", kSourceLengthRange, [](M& m, float v) { m.source_length = v; }},
      {"specific_tension", kSpecificTensionRange, [](M& m, float v) { m.specific_tension = v; }},
      {"pcsa", kPcsaRange, [](M& m, float v) { m.pcsa = v; }},
      {"volume", kVolumeRange, [](M& m, float v) { m.volume = v; }},
  };
  return all;
}

// A muscle of a PCSA, with one figure put in or replaced.
bool reader_takes(const Row& row, double value) {
  std::string text = std::string(kMuscle) + "\"pcsa\": 0.01, ";
  if (const std::size_t at = text.find(fmt::format("\"{}\":", row.field)); at != std::string::npos) {
    text.erase(at, text.find(',', at) - at + 1);
  }
  const JsonDocument document = *parse_json(text + fmt::format("\"{}\": {} }}", row.field, value), "muscle.json");
  Diagnostics found;
  read_muscle_entry(document.root(), {found});
  return found.ok();
}

bool builder_takes(const Row& row, double value) {
  MuscleDescription muscle = sound();
  muscle.pcsa = 0.01f;
  row.set(muscle, static_cast<float>(value));
  return builder_takes(muscle);
}

TEST(MuscleLimits, ReaderAndBuilderRefuseWhatIsBeyond) {
  for (const Row& row : rows()) {
    for (const double value : {row.range.max * 1.001, -1e-3, row.range.min - 1.0}) {
      EXPECT_FALSE(reader_takes(row, value)) << row.field << ' ' << value;
      EXPECT_FALSE(builder_takes(row, value)) << row.field << ' ' << value;
    }
  }
}

TEST(MuscleLimits, ReaderAndBuilderTakeWhatIsAtTheLimit) {
  for (const Row& row : rows()) {
    for (const double value : {row.range.max, row.range.above_min ? row.range.min + 1e-6 : row.range.min}) {
      EXPECT_TRUE(reader_takes(row, value)) << row.field << ' ' << value;
      EXPECT_TRUE(builder_takes(row, value)) << row.field << ' ' << value;
    }
  }
}

TEST(MuscleLimits, PennationIsBelowARightAngle) {
  for (const auto& [value, sane] : {std::pair{0.0, true}, {1.5, true}, {1.57, true}, {std::numbers::pi / 2, false},
                                    {1.6, false}, {-0.01, false}}) {
    MuscleDescription muscle = sound();
    muscle.hill.pennation = static_cast<float>(value);
    EXPECT_EQ(builder_takes(muscle), sane) << value;
    EXPECT_EQ(read_with(fmt::format("\"pennation\": {}", value)).ok(), sane) << value;
  }
}

TEST(MuscleLimits, RadiiAreMetresOrWeights) {
  for (const auto& [absolute, radius, sane] :
       {std::tuple{true, 10.0, true}, {true, 10.1, false}, {false, 10.1, true}, {false, 1e6, true},
        {false, 1.1e6, false}}) {
    MuscleDescription muscle = sound();
    muscle.profile = {{0.0f, 1.0f}, {1.0f, static_cast<float>(radius)}, absolute};
    EXPECT_EQ(builder_takes(muscle), sane) << radius;
    EXPECT_EQ(read_with(fmt::format(R"("profile": {{ "fractions": [0, 1], "radii": [1, {}], "absolute": {} }})", radius,
                                    absolute)).ok(), sane) << radius;
  }
}

TEST(MuscleLimits, ListsHaveTheSameLengths) {
  for (const std::size_t points : {std::size_t{1}, kFewestProfilePoints, kMostProfilePoints, kMostProfilePoints + 1}) {
    MuscleDescription muscle = sound();
    std::string fractions, radii;
    for (std::size_t i = 0; i < points; ++i) {
      muscle.profile.fractions.push_back(static_cast<float>(i) / 100.0f);
      muscle.profile.radii.push_back(1.0f);
      fractions += fmt::format("{}{}", i == 0 ? "" : ",", static_cast<double>(i) / 100.0);
      radii += i == 0 ? "1" : ",1";
    }
    const bool sane = points >= kFewestProfilePoints && points <= kMostProfilePoints;
    EXPECT_EQ(builder_takes(muscle), sane) << points;
    const std::string profile = fmt::format(R"("profile": {{ "fractions": [{}], "radii": [{}] }})", fractions, radii);
    EXPECT_EQ(read_with(profile).ok(), sane) << points;
  }
  for (const std::size_t vias : {kMostViaPoints, kMostViaPoints + 1}) {
    MuscleDescription muscle = sound();
    std::string list;
    for (std::size_t i = 0; i < vias; ++i) {
      muscle.attachments.insert(muscle.attachments.end() - 1, {0, {0.001f * static_cast<float>(i + 1), 0.0f, 0.0f}});
      list += fmt::format(R"({}{{ "bone": "b", "position": [{}, 0, 0] }})", i == 0 ? "" : ",", 0.001 * (double(i) + 1));
    }
    EXPECT_EQ(builder_takes(muscle), vias == kMostViaPoints);
    EXPECT_EQ(read_with(fmt::format("\"via\": [{}]", list)).ok(), vias == kMostViaPoints);
  }
}

TEST(MuscleLimits, PositionsAreSaneInTheBonesFrameOrAtRest) {
  const auto takes = [](glm::vec3 position, float scale) {
    MuscleDescription muscle = sound();
    muscle.attachments[1].position = position;
    glm::mat4 bone(scale);
    bone[3] = glm::vec4(0, 0, 0, 1);
    return check_description(muscle, std::vector{bone}).ok();
  };
  EXPECT_TRUE(takes({100, -100, 100}, 1.0f));
  EXPECT_FALSE(takes({180, 0, 0}, 1.0f));
  EXPECT_TRUE(takes({9000, 0, 0}, 0.01f));  // 90 m, on a bone whose unit is the centimetre
  EXPECT_TRUE(takes({90, 0, 0}, 100.0f));
  EXPECT_FALSE(takes({1e6f, 0, 0}, 0.01f));
}

double number_at(const JsonNode& schema, std::string_view key) {
  double value = std::nan("");
  Diagnostics ignored;
  if (const JsonNode node = schema.member(key); node.exists()) node.read(value, ignored);
  return value;
}

void expect_range(const JsonNode& schema, const NumberRange& range, const std::string& name) {
  EXPECT_EQ(number_at(schema, range.above_min ? "exclusiveMinimum" : "minimum"), range.min) << name;
  EXPECT_EQ(number_at(schema, "maximum"), range.max) << name;
}

TEST(MuscleLimits, TheSchemaHasThem) {
  const auto file = read_json_file(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content/schema/character.schema.json");
  ASSERT_TRUE(file.ok()) << to_text(file.diagnostics());
  const JsonNode definitions = file->root().member("definitions");
  const JsonNode muscle = definitions.member("muscle").member("properties");
  for (const Row& row : rows()) {
    const JsonNode field = muscle.member(row.field);
    expect_range(field.member("$ref").exists() ? definitions.member(row.field) : field, row.range, row.field);
  }
  expect_range(definitions.member("section_vertices"), kSectionVerticesRange, "section_vertices");
  expect_range(definitions.member("longitudinal_subdivision"), kSubdivisionRange, "longitudinal_subdivision");
  EXPECT_EQ(number_at(muscle.member("pennation"), "minimum"), 0.0);
  EXPECT_EQ(static_cast<float>(number_at(muscle.member("pennation"), "exclusiveMaximum")), kRightAngle);
  EXPECT_EQ(number_at(muscle.member("via"), "maxItems"), static_cast<double>(kMostViaPoints));
  const JsonNode profile = definitions.member("profile").member("properties");
  expect_range(profile.member("fractions").member("items"), kFractionRange, "fractions");
  expect_range(profile.member("radii").member("items"), kRelativeRadiusRange, "radii");
  for (const char* list : {"fractions", "radii"}) {
    EXPECT_EQ(number_at(profile.member(list), "minItems"), static_cast<double>(kFewestProfilePoints));
    EXPECT_EQ(number_at(profile.member(list), "maxItems"), static_cast<double>(kMostProfilePoints));
  }
  const JsonNode tendon = definitions.member("tendon").member("properties");
  for (const char* end : {"origin", "insertion"}) expect_range(tendon.member(end), kFractionRange, end);
  expect_range(definitions.member("position").member("items"), kPositionRange, "position");
}

}  // namespace
}  // namespace fascicle::muscle
