// `fascicle-cook constrain` as a program: what it finds between two rods with known answers, and what it leaves alone.

#include <filesystem>
#include <regex>
#include <string>

#include <gmock/gmock.h>

#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/tag_place.hpp"
#include "tests/tools/fascicle_cook/cook_command.hpp"

namespace fascicle::cook {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class ConstrainCommand : public CookCommand {
 protected:
  // Rods of 10 mm radius along the z axis from -0.2 to 0.2 m: `a` at x = 0, `b` beside it at x = 0.022, so 2 mm away,
  // `far` at x = 0.1, `sunk` half in the box that lies under `a`, 3 mm away.
  void write_rods(const std::string& extra = "") const {
    write_obj("box.obj", test::make_box({-0.05f, -0.05f, -0.11f}, {0.005f, -0.013f, 0.11f}));
    const auto rod = [](const char* name, const char* place) {
      return std::string(R"({ "name": ")") + name + R"(", "origin": { "bone": "upper", "position": [)" + place +
             R"(, -0.2] }, "insertion": { "bone": "upper", "position": [)" + place +
             R"(, 0.2] }, "profile": { "fractions": [0, 1], "radii": [0.01, 0.01], "absolute": true } })";
    };
    write("rods.character.json", R"({ "version": 1, "name": "rods",
  "skeleton": { "joints": { "bodies": [{ "name": "upper" }], "coordinates": [],
                            "joints": [{ "name": "root", "parent": "ground", "child": "upper" }] } },
  "bone_meshes": [{ "bone": "upper", "file": "box.obj", "space": "character" }],
  "attachment_space": "character", "level": { "section_vertices": 16, "longitudinal_subdivision": 4 },
)" + extra + R"(  "muscles": [)" + rod("a", "0, 0") + ",\n    " + rod("b", "0.022, 0") +
                                     ",\n    " + rod("far", "0.1, 0") + ",\n    " + rod("sunk", "-0.04, -0.013") +
                                     "]\n}\n");
  }
  std::string character() const { return "'" + file("rods.character.json") + "'"; }
};

TEST_F(ConstrainCommand, WrongUsageIsTwoAndBrokenInputOne) {
  EXPECT_EQ(run("constrain"), 2);
  EXPECT_EQ(run("constrain walker --near -1"), 2);
  EXPECT_EQ(run("constrain wlaker"), 1);
  EXPECT_THAT(err(), HasSubstr("did you mean 'walker'?"));
  EXPECT_EQ(run("constrain walker --dry-run --clip wallk"), 1);
  EXPECT_THAT(err(), HasSubstr("there is no clip 'wallk'; did you mean 'walk'?"));
  write_rods("  \"collision\": \"rods.collision.json\",\n");
  EXPECT_EQ(run("constrain " + character()), 1);
  EXPECT_THAT(err(), HasSubstr("the file 'rods.collision.json' does not exist"));
  write("rods.collision.json", "{ \"version\": 1, \"transversals\": [{}] }");
  EXPECT_EQ(run("constrain " + character()), 1);
  EXPECT_EQ(read("rods.collision.json"), "{ \"version\": 1, \"transversals\": [{}] }");
}

TEST_F(ConstrainCommand, FindsFacingVerticesAndBones) {
  write_rods();
  const std::string before = read("rods.character.json");
  ASSERT_EQ(run("constrain " + character() + " --dry-run"), 0) << err();
  EXPECT_FALSE(exists("rods.collision.json"));
  EXPECT_EQ(read("rods.character.json"), before);
  ASSERT_EQ(run("constrain " + character() + " --every 100"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("1 pairs of muscles come within 5 mm, 15 pairs of sections face each other, 0 lie"));
  const auto loaded = muscle::load_character(file("rods.character.json"), {.bone_fields = false});
  ASSERT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  const muscle::CharacterAsset& rods = **loaded;
  int between = 0, with_bone = 0;  // of 400 mm and of 220 mm
  float last[] = {-1.0f, -1.0f};
  for (const muscle::TransversalTag& tag : rods.collision.transversals) {
    EXPECT_TRUE(tag.automatic);
    EXPECT_EQ(tag.first.muscle, 0u);
    float& previous = last[tag.bone < 0 ? 0 : 1];
    EXPECT_GE(0.4f * (tag.first.fraction - previous), 0.0999f);
    previous = tag.first.fraction;
    if (tag.bone < 0) {
      ++between;
      EXPECT_EQ(tag.second.muscle, 1u);
      EXPECT_NEAR(tag.first.fraction, tag.second.fraction, 1e-3f);
      EXPECT_NEAR(std::abs(tag.first.angle - tag.second.angle), 3.1416f, 2e-4f);  // opposite: one at +x, one at -x
    } else {
      ++with_bone;
      EXPECT_LT(muscle::tagged_place(*rods.muscles, tag.first).y, -0.0095f);  // towards the box
      EXPECT_NEAR(tag.first.fraction, 0.5f, 0.29f);  // no further than 5 mm beyond the box
    }
  }
  EXPECT_GE(between, 3);
  EXPECT_GE(with_bone, 2);
  ASSERT_EQ(rods.collision.bone_tags.size(), 2u);  // `b` is 8 mm beside the box
  EXPECT_EQ(rods.collision.bone_tags[0].muscle, 0u);
  EXPECT_EQ(rods.collision.bone_tags[1].muscle, 3u);  // `sunk` has no place beside it
  // The reference was added, and nothing else.
  std::string text = read("rods.character.json");
  const std::string reference = "\"collision\": \"rods.collision.json\",\n  ";
  ASSERT_NE(text.find(reference), std::string::npos);
  text.erase(text.find(reference), reference.size());
  EXPECT_EQ(text, before);
}

TEST_F(ConstrainCommand, KeepsWhatTheAuthorWrote) {
  write_rods("  \"collision\": \"rods.collision.json\",\n");
  const std::string settings = "  \"settings\":   { \"substeps\" :5 },\n";
  const std::string own = R"({ "first": { "muscle": "b", "at": 0.5, "angle":0 }, "second": {"muscle":"a", "at":0.5,
      "angle": 3.0 }, "yields": "first" })";
  const std::string own_bone = R"({ "first": { "muscle": "a", "at":0.375, "angle": 3 }, "second": {"bone":"upper"} })";
  write("rods.collision.json", "{ \"version\": 1,\n" + settings + "  \"transversals\": [ " + own +
                                   ",\n    { \"first\": { \"muscle\": \"a\", \"at\": 0.1, \"angle\": 0 }, "
                                   "\"second\": { \"bone\": \"upper\" }, \"automatic\": true },\n" + own_bone +
                                   " ] }\n");
  ASSERT_EQ(run("constrain " + character() + " --every 100 --threads 1"), 0) << err();
  const std::string once = read("rods.collision.json");
  EXPECT_THAT(once, HasSubstr(settings));
  EXPECT_THAT(once, HasSubstr(own));
  EXPECT_THAT(once, Not(HasSubstr("\"at\": 0.1, \"angle\": 0 }, \"second\": { \"bone\"")));
  EXPECT_THAT(once, HasSubstr("\"automatic\": true"));
  EXPECT_THAT(once, HasSubstr(own_bone));
  // The author has tagged these places.
  const auto has = [&](const char* pattern) { return std::regex_search(once, std::regex(pattern)); };
  EXPECT_FALSE(has(R"("at": 0.5, "angle": [0-9.]+ \}, "second": \{ "muscle")"));
  EXPECT_FALSE(has(R"("at": 0.[345][0-9]*, "angle": [0-9.]+ \}, "second": \{ "bone")"));
  EXPECT_TRUE(has(R"("at": 0.[67][0-9]*, "angle": [0-9.]+ \}, "second": \{ "bone": "upper" \}, "automatic": true)"));
  const auto time = fs::last_write_time(file("rods.collision.json"));
  ASSERT_EQ(run("constrain " + character() + " --every 100 --threads 3"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("is up to date"));
  EXPECT_EQ(read("rods.collision.json"), once);
  EXPECT_EQ(fs::last_write_time(file("rods.collision.json")), time);
}

TEST_F(ConstrainCommand, PassesOverIgnoredPairs) {
  write_rods("  \"collision\": \"rods.collision.json\",\n");
  write("rods.collision.json",
        R"({ "version": 1, "ignore": [{ "muscle": "b", "other": "a" }, { "muscle": "a", "bone": "upper" },
            { "muscle": "sunk", "bone": "upper" }] })");
  const std::string before = read("rods.collision.json");
  ASSERT_EQ(run("constrain " + character()), 0) << err();
  EXPECT_EQ(read("rods.collision.json"), before);
}

// What is committed is what the tool writes today.
TEST_F(ConstrainCommand, TheWalkersTagsAreUpToDate) {
  ASSERT_EQ(run("constrain walker --dry-run"), 0) << err();
  EXPECT_THAT(out(), HasSubstr("is up to date")) << "run fascicle-cook constrain walker";
}

}  // namespace
}  // namespace fascicle::cook
