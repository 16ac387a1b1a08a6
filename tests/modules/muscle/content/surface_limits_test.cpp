// One table of limits: the reader of surface muscles and the schema must draw the same lines, and both must have the
// settings' own defaults.
#include "modules/muscle/content/surface_limits.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/content/json_reader.hpp"
#include "modules/muscle/content/character_file.hpp"

namespace fascicle::muscle {
namespace {

struct Row {
  const char* field;
  NumberRange range;
  bool whole;
  std::function<double(const SurfaceSettings&)> value;  // in the file's unit
};

const std::vector<Row>& rows() {
  using S = SurfaceSettings;
  const auto at = [](float S::*member, double factor = 1.0) {
    return [=](const S& s) { return factor * static_cast<double>(s.*member); };
  };
  static const std::vector<Row> all{
      {"substeps", kSurfaceSubstepsRange, true, [](const S& s) { return double(s.substeps); }},
      {"density", kDensityRange, false, at(&S::density)},
      {"stretch_compliance", kStretchComplianceRange, false, at(&S::stretch_compliance)},
      {"along_fibres", kAlongFibresRange, false, at(&S::along_fibres)},
      {"bend_compliance", kBendComplianceRange, false, at(&S::bend_compliance)},
      {"volume_compliance", kVolumeComplianceRange, false, at(&S::volume_compliance)},
      {"anchor_compliance", kAnchorComplianceRange, false, at(&S::anchor_compliance)},
      {"damping", kDampingRange, false, at(&S::damping)},
      {"viscosity", kDampingRange, false, at(&S::viscosity)},
      {"contact_distance_mm", kContactDistanceRange, false, at(&S::contact_distance, 1e3)},
      {"friction", kFrictionRange, false, at(&S::friction)},
  };
  return all;
}

SurfaceMuscleEntry read_settings(const std::string& fields, Diagnostics& found) {
  const JsonDocument document = *parse_json(
      fmt::format(R"({{ "name": "m", "mesh": "m", "settings": {{ {} }} }})", fields), "m.character.json");
  return read_surface_muscle_entry(document.root(), {found});
}

double number_at(const JsonNode& schema, std::string_view key) {
  double value = std::nan("");
  Diagnostics ignored;
  if (const JsonNode node = schema.member(key); node.exists()) node.read(value, ignored);
  return value;
}

struct HullRow {
  const char* field;
  NumberRange range;
  bool whole;
  std::function<double(const HullSettings&)> value;  // in the file's unit
};

const std::vector<HullRow>& hull_rows() {
  using H = HullSettings;
  static const std::vector<HullRow> all{
      {"vertices", kHullVerticesRange, true, [](const H& h) { return double(h.vertices); }},
      {"error_mm", kHullErrorRange, false, [](const H& h) { return 1e3 * double(h.error); }},
      {"iterations", kHullIterationsRange, true, [](const H& h) { return double(h.iterations); }},
      {"tolerance", kHullToleranceRange, false, [](const H& h) { return double(h.tolerance); }},
      {"refinements", kRefinementsRange, true, [](const H& h) { return double(h.refinements); }},
      {"bending", kHullWeightRange, false, [](const H& h) { return double(h.bending); }},
      {"direction", kHullWeightRange, false, [](const H& h) { return double(h.direction); }},
  };
  return all;
}

SurfaceMuscleEntry read_hull(const std::string& fields, Diagnostics& found) {
  const JsonDocument document =
      *parse_json(fmt::format(R"({{ "name": "m", "mesh": "m", "hull": {{ {} }} }})", fields), "m.character.json");
  return read_surface_muscle_entry(document.root(), {found});
}

TEST(SurfaceLimits, OfAHullAreKept) {
  for (const HullRow& row : hull_rows()) {
    for (const double value : {row.range.max + 1.0, row.range.min - 1.0}) {
      Diagnostics found;
      EXPECT_FALSE(read_hull(fmt::format("\"{}\": {}", row.field, value), found).sound);
      ASSERT_EQ(found.errors.size(), 1u) << row.field << ' ' << value;
      EXPECT_NE(found.errors[0].cause.find("out of range"), std::string::npos) << found.errors[0].cause;
      EXPECT_EQ(found.errors[0].path, fmt::format("/hull/{}", row.field));
    }
    for (const double value : {row.range.max, row.range.min}) {
      Diagnostics found;
      const SurfaceMuscleEntry entry = read_hull(fmt::format("\"{}\": {}", row.field, value), found);
      if (row.range.above_min && value == row.range.min) {
        EXPECT_FALSE(entry.sound) << row.field;
        continue;
      }
      EXPECT_TRUE(found.ok()) << to_text(found);
      EXPECT_NEAR(row.value(entry.hull), value, 1e-6 * std::abs(value)) << row.field;
    }
    Diagnostics found;
    EXPECT_EQ(read_hull(fmt::format("\"{}\": {}", row.field, 0.0625), found).sound, !row.whole) << row.field;
  }
}

TEST(SurfaceLimits, WhatIsBeyondIsRefused) {
  for (const Row& row : rows()) {
    for (const double value : {row.range.max + 1.0, row.range.min - 1.0}) {
      Diagnostics found;
      EXPECT_FALSE(read_settings(fmt::format("\"{}\": {}", row.field, value), found).sound);
      ASSERT_EQ(found.errors.size(), 1u) << row.field << ' ' << value;
      EXPECT_NE(found.errors[0].cause.find("out of range"), std::string::npos) << found.errors[0].cause;
    }
    if (!row.whole) continue;
    Diagnostics found;
    read_settings(fmt::format("\"{}\": 2.5", row.field), found);
    EXPECT_EQ(found.errors.size(), 1u) << row.field;
  }
}

TEST(SurfaceLimits, WhatIsAtTheLimitIsReadInSiUnits) {
  for (const Row& row : rows()) {
    for (const double value : {row.range.max, row.range.min}) {
      Diagnostics found;
      const SurfaceMuscleEntry entry = read_settings(fmt::format("\"{}\": {}", row.field, value), found);
      EXPECT_TRUE(found.ok()) << to_text(found);
      EXPECT_NEAR(row.value(entry.settings), value, 1e-6 * std::abs(value)) << row.field;
    }
  }
}

TEST(SurfaceLimits, TheSchemaHasThemAndTheDefaults) {
  const auto read = read_json_file(std::filesystem::path(FASCICLE_SOURCE_DIR) / "content/schema/character.schema.json");
  ASSERT_TRUE(read.ok()) << to_text(read.diagnostics());
  const JsonNode definitions = read->root().member("definitions");
  const JsonNode settings = definitions.member("surface_settings").member("properties");
  std::size_t numbers = 0;
  for (const JsonNode field : settings) numbers += field.member("minimum").exists();
  EXPECT_EQ(numbers, rows().size());
  for (const Row& row : rows()) {
    const JsonNode field = settings.member(row.field);
    EXPECT_EQ(number_at(field, "minimum"), row.range.min) << row.field;
    EXPECT_EQ(number_at(field, "maximum"), row.range.max) << row.field;
    const double value = row.value(SurfaceSettings{});
    EXPECT_NEAR(number_at(field, "default"), value, 1e-6 * std::max(1.0, std::abs(value))) << row.field;
  }
  const JsonNode hull = definitions.member("hull").member("properties");
  EXPECT_EQ(hull.size(), hull_rows().size());
  for (const HullRow& row : hull_rows()) {
    const JsonNode field = hull.member(row.field);
    EXPECT_EQ(number_at(field, row.range.above_min ? "exclusiveMinimum" : "minimum"), row.range.min) << row.field;
    EXPECT_EQ(number_at(field, "maximum"), row.range.max) << row.field;
    EXPECT_NEAR(number_at(field, "default"), row.value(HullSettings{}), 1e-7) << row.field;
  }
  const auto expect_range = [&](const char* kind, const char* name, const NumberRange& range) {
    const JsonNode field = definitions.member(kind).member("properties").member(name);
    EXPECT_EQ(number_at(field, range.above_min ? "exclusiveMinimum" : "minimum"), range.min) << kind << ' ' << name;
    EXPECT_EQ(number_at(field, "maximum"), range.max) << kind << ' ' << name;
  };
  expect_range("surface_attachment", "within_mm", kAttachmentDistanceRange);
  expect_range("near", "radius_mm", kAttachmentDistanceRange);
  expect_range("plane", "at", kPlaneRange);
  expect_range("fibres", "head", kHeadRange);
  expect_range("surface_muscle", "piece", kPieceRange);
  expect_range("surface_level", "above_pixels", kAbovePixelsRange);
  expect_range("surface_level", "refinements", kRefinementsRange);
  expect_range("inner_fibres", "count", kFibreCountRange);
  expect_range("inner_fibres", "points", kPointsPerFibreRange);
  expect_range("inner_fibres", "pennation", kFibrePennationRange);
  const auto count_at = [&](const char* field) {
    return number_at(definitions.member("surface_muscle").member("properties").member(field), "maxItems");
  };
  EXPECT_EQ(count_at("levels"), kMostSurfaceLevels);
  EXPECT_EQ(count_at("action_line"), kMostLinePoints);
  const JsonNode at = definitions.member("line_point").member("properties").member("at").member("items");
  EXPECT_EQ(number_at(at, "maximum"), kLinePointRange.max);
  const JsonNode inner = definitions.member("inner_fibres").member("properties");
  EXPECT_EQ(number_at(inner.member("count"), "default"), FibreBundleSettings{}.count);
  EXPECT_EQ(number_at(inner.member("points"), "default"), FibreBundleSettings{}.points);
  EXPECT_NEAR(number_at(inner.member("pennation"), "default"), double(FibreBundleSettings{}.pennation), 1e-6);
}

}  // namespace
}  // namespace fascicle::muscle
