// One table of limits: the reader of collision files and the schema must draw the same lines, and both must have the
// settings' own defaults.
#include "modules/muscle/content/collision_limits.hpp"

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/content/json_reader.hpp"
#include "modules/muscle/content/collision_file.hpp"

namespace fascicle::muscle {
namespace {

struct Row {
  const char* field;
  NumberRange range;
  bool whole;
  std::function<double(const CollisionSettings&)> value;  // in the file's unit
};

const std::vector<Row>& rows() {
  using S = CollisionSettings;
  const auto thousand = [](float S::*member) {
    return [member](const S& s) { return 1e3 * static_cast<double>(s.*member); };
  };
  static const std::vector<Row> all{
      {"substeps", kSubstepsRange, true, [](const S& s) { return double(s.substeps); }},
      {"iterations", kIterationsRange, true, [](const S& s) { return double(s.iterations); }},
      {"shape_time_ms", kRelaxationRange, false, thousand(&S::shape_time)},
      {"line_time_ms", kRelaxationRange, false, thousand(&S::line_time)},
      {"via_time_ms", kRelaxationRange, false, thousand(&S::via_time)},
      {"smoothing", kSmoothingRange, false, [](const S& s) { return double(s.smoothing); }},
      {"bone_margin_mm", kMarginRange, false, thousand(&S::bone_margin)},
      {"muscle_margin_mm", kMarginRange, false, thousand(&S::muscle_margin)},
      {"sample_spacing_mm", kSampleSpacingRange, false, thousand(&S::sample_spacing)},
      {"bone_voxel_mm", kBoneVoxelRange, false, thousand(&S::bone_voxel)},
  };
  return all;
}

CollisionFile read_settings(const std::string& fields, Diagnostics& found) {
  const JsonDocument document =
      *parse_json(fmt::format(R"({{ "version": 1, "settings": {{ {} }} }})", fields), "c.collision.json");
  return read_collision_file(document.root(), {found});
}

double number_at(const JsonNode& schema, std::string_view key) {
  double value = std::nan("");
  Diagnostics ignored;
  if (const JsonNode node = schema.member(key); node.exists()) node.read(value, ignored);
  return value;
}

JsonDocument read_schema() {
  auto file = read_json_file(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content/schema/collision.schema.json");
  EXPECT_TRUE(file.ok()) << to_text(file.diagnostics());
  return *file;
}

TEST(CollisionLimits, WhatIsBeyondIsRefused) {
  for (const Row& row : rows()) {
    for (const double value : {row.range.max + 1.0, row.range.min - 1.0}) {
      Diagnostics found;
      read_settings(fmt::format("\"{}\": {}", row.field, value), found);
      ASSERT_EQ(found.errors.size(), 1u) << row.field << ' ' << value;
      EXPECT_NE(found.errors[0].cause.find("out of range"), std::string::npos) << found.errors[0].cause;
    }
    if (!row.whole) continue;
    Diagnostics found;
    read_settings(fmt::format("\"{}\": 2.5", row.field), found);
    EXPECT_EQ(found.errors.size(), 1u) << row.field;
  }
}

TEST(CollisionLimits, WhatIsAtTheLimitIsReadInSiUnits) {
  for (const Row& row : rows()) {
    for (const double value : {row.range.max, row.range.min}) {
      Diagnostics found;
      const CollisionFile file = read_settings(fmt::format("\"{}\": {}", row.field, value), found);
      EXPECT_TRUE(found.ok()) << to_text(found);
      EXPECT_NEAR(row.value(file.settings), value, 1e-6 * std::abs(value)) << row.field;
    }
  }
}

TEST(CollisionLimits, TheSchemaHasThemAndTheDefaults) {
  const JsonDocument schema = read_schema();
  const JsonNode definitions = schema.root().member("definitions");
  const JsonNode settings = definitions.member("settings").member("properties");
  for (const Row& row : rows()) {
    const JsonNode field = settings.member(row.field);
    EXPECT_EQ(number_at(field, "minimum"), row.range.min) << row.field;
    EXPECT_EQ(number_at(field, "maximum"), row.range.max) << row.field;
    EXPECT_NEAR(number_at(field, "default"), row.value(CollisionSettings{}), 1e-5) << row.field;
  }
  const auto expect_range = [](const JsonNode& field, const NumberRange& range) {
    EXPECT_EQ(number_at(field, "minimum"), range.min) << field.path();
    EXPECT_EQ(number_at(field, "maximum"), range.max) << field.path();
  };
  expect_range(definitions.member("at"), kPlaceRange);
  expect_range(definitions.member("angle"), kAngleRange);
  const JsonNode stay_out = definitions.member("stay_out").member("properties");
  for (const char* end : {"from", "to"}) expect_range(stay_out.member(end), kStretchRange);
  EXPECT_EQ(number_at(stay_out.member("bones"), "maxItems"), double(kMostStayOutBones));
  for (const char* list : {"transversals", "stay_out", "ignore"}) {
    EXPECT_EQ(number_at(schema.root().member("properties").member(list), "maxItems"), double(kMostTags)) << list;
  }
}

}  // namespace
}  // namespace fascicle::muscle
