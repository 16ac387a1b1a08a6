#include "modules/muscle/content/migrate.hpp"

#include <gmock/gmock.h>

#include "engine/content/file_text.hpp"
#include "modules/muscle/content/check_content.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"

namespace fascicle::muscle {
namespace {

using test::ScratchFolder;
using testing::HasSubstr;

constexpr std::string_view kOldCharacter = R"({
  "version": 0, "name": "Wädli",
  "lod": { "sections": 10, "subdivisions": 2 }, "specific_tension_ncm2": 50,
  "muscles": [
    { "name": "ä", "fmax": 100, "fibre_length": 0.05, "tendon_length": 0.25, "pennation_degrees": 90,
      "via_points": [ { "bone": "fmax" } ] }
  ]
}
)";

constexpr std::string_view kNewCharacter = R"({
  "version": 1, "name": "Wädli",
  "level": { "section_vertices": 10, "longitudinal_subdivision": 2 }, "specific_tension": 500000,
  "muscles": [
    { "name": "ä", "max_isometric_force": 100, "optimal_fibre_length": 0.05, "tendon_slack_length": 0.25, "pennation": 1.5707963267948966,
      "via": [ { "bone": "fmax" } ] }
  ]
}
)";

Result<JsonDocument> migrate_text(std::string_view text, ContentKind kind) {
  Result<JsonDocument> document = parse_json(std::string(text), "old.json");
  EXPECT_TRUE(document.ok()) << to_text(document.diagnostics());
  return migrate(*document, kind);
}

TEST(Migrate, RefusesVersionsThatItDoesNotKnow) {
  for (const char* text : {"{}", "[]", R"({"version": 2})", R"({"version": -1})", R"({"version": 0.5})",
                           R"({"version": null})"}) {
    EXPECT_FALSE(migrate_text(text, ContentKind::kScene).ok()) << text;
  }
}

TEST(Migrate, LeavesTheCurrentVersionAlone) {
  const auto migrated = migrate_text(kNewCharacter, ContentKind::kCharacter);
  ASSERT_TRUE(migrated.ok());
  EXPECT_EQ(migrated->text(), kNewCharacter);
  EXPECT_TRUE(migrated.diagnostics().warnings.empty());
}

TEST(Migrate, RenamesAndConvertsACharacterAndKeepsItsLayout) {
  const auto migrated = migrate_text(kOldCharacter, ContentKind::kCharacter);
  ASSERT_TRUE(migrated.ok()) << to_text(migrated.diagnostics());
  EXPECT_EQ(migrated->text(), kNewCharacter);
  ASSERT_EQ(migrated.diagnostics().warnings.size(), 1u);
  EXPECT_EQ(to_string(migrated.diagnostics().warnings[0]),
            "old.json:2:14: /version: the file has version 0 and was read as version 1; "
            "`fascicle-check --migrate old.json` rewrites it");
}

TEST(Migrate, KeepsForeignLineEnds) {
  for (const std::string_view end : {"\r\n", "\r"}) {
    const auto replaced = [&](std::string_view text) {
      std::string out;
      for (const char c : text) out += c == '\n' ? std::string(end) : std::string(1, c);
      return out;
    };
    const auto migrated = migrate_text(replaced(kOldCharacter), ContentKind::kCharacter);
    ASSERT_TRUE(migrated.ok());
    EXPECT_EQ(migrated->text(), replaced(kNewCharacter));
  }
}

TEST(Migrate, ConvertsAScene) {
  const auto migrated = migrate_text(
      R"({"version":0,"fps":30,"characters":[{"path":"a.json","heading_degrees":-180}],"camera":{"fov_degrees":60}})",
      ContentKind::kScene);
  ASSERT_TRUE(migrated.ok()) << to_text(migrated.diagnostics());
  EXPECT_EQ(migrated->text(),
            R"({"version":1,"step_hz":30,"characters":[{"file":"a.json","heading":-3.141592653589793}],)"
            R"("camera":{"fov":1.0471975511965976}})");
}

TEST(Migrate, ValuesOfAWrongKindAreLeftToTheReader) {
  const auto migrated = migrate_text(R"({"version":0,"muscles":[7,{"pennation_degrees":"much"}],"lod":[]})",
                                     ContentKind::kCharacter);
  ASSERT_TRUE(migrated.ok());
  EXPECT_EQ(migrated->text(), R"({"version":1,"muscles":[7,{"pennation":"much"}],"level":[]})");
}

TEST(Migrate, OldAndNewNameTogetherAreADuplicate) {
  const auto migrated = migrate_text(R"({"version":0,"lod":{},"level":{}})", ContentKind::kCharacter);
  ASSERT_FALSE(migrated.ok());
  EXPECT_THAT(to_text(migrated.diagnostics()), HasSubstr("'level' stands twice"));
}

TEST(Migrate, RewritesTheFileOnRequest) {
  const ScratchFolder folder;
  const auto file = folder.write("old.character.json", kOldCharacter);
  const Diagnostics first = migrate_content_file(file);
  EXPECT_TRUE(first.ok()) << to_text(first);
  EXPECT_EQ(read_text_file(file).value(), kNewCharacter);
  EXPECT_EQ(first.warnings.size(), 1u);
  EXPECT_TRUE(migrate_content_file(file).warnings.empty());
  EXPECT_FALSE(migrate_content_file(folder.path() / "none.character.json").ok());
}

TEST(Migrate, ErrorsInAnOldFilePointAtTheRightLine) {
  const ScratchFolder folder;
  const Diagnostics found = check_content(folder.write("old.character.json", kOldCharacter));
  EXPECT_THAT(test::errors_of(found, folder.path()),
              HasSubstr("old.character.json:5:120: /muscles/0/pennation: the pennation angle 1.57079"));
  EXPECT_EQ(found.warnings.size(), 1u);
}

TEST(ContentKindOf, GoesByTheNameThenByTheMembers) {
  EXPECT_EQ(content_kind("a/x.scene.json", {}), ContentKind::kScene);
  EXPECT_EQ(content_kind("a/x.character.json", {}), ContentKind::kCharacter);
  const auto scene = parse_json(R"({"characters": []})", "x.json");
  const auto character = parse_json(R"({"skeleton": {}})", "x.json");
  const auto other = parse_json("[]", "x.json");
  EXPECT_EQ(content_kind("x.json", scene->root()), ContentKind::kScene);
  EXPECT_EQ(content_kind("x.json", character->root()), ContentKind::kCharacter);
  EXPECT_EQ(content_kind("x.json", other->root()), std::nullopt);
}

}  // namespace
}  // namespace fascicle::muscle
