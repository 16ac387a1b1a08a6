// Changes to collision files touch what they must and nothing else.
#include "modules/muscle/content/save_collision.hpp"

#include <array>
#include <limits>

#include <gmock/gmock.h>

#include "engine/content/file_text.hpp"
#include "modules/muscle/content/edit_collision.hpp"
#include "tests/modules/muscle/content/scratch_collision.hpp"

namespace fascicle::muscle {
namespace {

using test::kTags;
using test::ScratchFolder;
using test::with;
using testing::HasSubstr;

JsonDocument parse(std::string text) { return *parse_json(std::move(text), "t.collision.json"); }

const AutomaticEntries kEntries{{R"({ "a": 1, "automatic": true })", R"({ "b": 2, "automatic": true })"}, {}};

TEST(EditCollision, AListIsAddedWhereItIsMissing) {
  EXPECT_EQ(append_entries(parse("{ \"version\": 1 }"), "list", kEntries.transversals),
            "{ \"version\": 1,\n  \"list\": [\n    { \"a\": 1, \"automatic\": true },\n"
            "    { \"b\": 2, \"automatic\": true }\n  ] }");
  EXPECT_EQ(append_entries(parse("{\r\n  \"version\": 1\r\n}\r\n"), "list", std::array<std::string, 1>{"1"}),
            "{\r\n  \"version\": 1,\r\n  \"list\": [\r\n    1\r\n  ]\r\n}\r\n");
  const std::string text = "{ \"version\": 1 }";
  EXPECT_EQ(append_entries(parse(text), "list", {}), text);
  EXPECT_EQ(replace_automatic(parse(text), "list", {}), text);
}

// An author's own layout: odd spacing, entries of several lines, several in one line.
constexpr std::string_view kOdd = R"({ "version":1,
 "list" :[ {"x": [1,
      2] }  , {"automatic":true, "y":2},{ "automatic" : false }
   ], "after": [ ]   })";

TEST(EditCollision, AuthorsEntriesStayByteForByte) {
  const std::string once = replace_automatic(parse(std::string(kOdd)), "list", kEntries.transversals);
  EXPECT_THAT(once, HasSubstr("\"list\" :[ {\"x\": [1,\n      2] },{ \"automatic\" : false },"));
  EXPECT_THAT(once, HasSubstr("], \"after\": [ ]   }"));
  EXPECT_THAT(once, HasSubstr("{ \"a\": 1, \"automatic\": true },"));
  EXPECT_THAT(once, testing::Not(HasSubstr("\"y\":2")));
  EXPECT_EQ(replace_automatic(parse(once), "list", kEntries.transversals), once);
  // Without the automatic ones again, and once more.
  const std::string none = replace_automatic(parse(once), "list", {});
  EXPECT_THAT(none, HasSubstr("[ {\"x\": [1,\n      2] },{ \"automatic\" : false }\n"));
  EXPECT_EQ(replace_automatic(parse(none), "list", {}), none);
}

TEST(EditCollision, TheReferenceStandsBeforeTheMuscles) {
  const std::string text = test::legs_with_collision();
  EXPECT_EQ(name_collision_file(parse(std::string(test::kLegs)), "legs.collision.json"), text);
  EXPECT_EQ(name_collision_file(parse(R"({ "name": "a", "muscles": [] })"), "a.json"),
            R"({ "name": "a", "collision": "a.json", "muscles": [] })");
  EXPECT_EQ(name_collision_file(parse("{ \"name\": \"muscles\" }"), "a.json"),
            "{ \"name\": \"muscles\",\n  \"collision\": \"a.json\" }");
}

class SaveCollision : public testing::Test {
 protected:
  std::shared_ptr<const CharacterAsset> load(const std::filesystem::path& file) {
    auto loaded = load_character(file, {.bone_fields = false});
    EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
    return loaded.ok() ? *loaded : nullptr;
  }
  std::string text(std::string_view name) { return read_text_file(folder_.path() / name).value(); }
  ScratchFolder folder_;
};

TransversalTag some_tag() {
  TransversalTag tag;
  tag.first = {0, 0.61803f, 1.0f};
  tag.second = {2, 0.3f, 2.0f};
  tag.yields = Yields::kSecond;
  tag.sweeps = true;
  return tag;
}

TEST_F(SaveCollision, RefusesWhatIsNoTag) {
  const auto file = test::write_legs(folder_);
  const auto legs = load(file);
  ASSERT_TRUE(legs);
  const auto refuses = [&](const TransversalTag& tag, const char* why) {
    const auto saved = save_transversal(file, *legs, tag);
    ASSERT_FALSE(saved.ok());
    EXPECT_THAT(to_text(saved.diagnostics()), HasSubstr(why));
  };
  TransversalTag tag = some_tag();
  tag.second.muscle = 0;
  refuses(tag, "both ends are on 'vastus_r'");
  for (const float fraction : {0.0f, 1.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    tag = some_tag();
    tag.first.fraction = fraction;
    refuses(tag, "no place between the ends");
  }
  tag = some_tag();
  tag.second.angle = std::numeric_limits<float>::infinity();
  refuses(tag, "no place between the ends");
  tag = some_tag();
  tag.second.muscle = 77;
  refuses(tag, "no place between the ends");
  tag = some_tag();
  tag.bone = 1000;
  refuses(tag, "no place between the ends");
  tag.first = {2, 0.4f, 4.5f};  // the other way round
  tag.second = {0, 0.5f, 1.5f};
  tag.bone = -1;
  refuses(tag, "these places are tagged already, at ");
  EXPECT_EQ(text("legs.collision.json"), kTags);
}

TEST_F(SaveCollision, RefusesToTouchABrokenFile) {
  const auto file = test::write_legs(folder_);
  const auto legs = load(file);
  for (const char* broken : {"{ \"version\": 1, \"transversals\": 3 }", "{ \"version\": 1,", "[]"}) {
    folder_.write("legs.collision.json", broken);
    EXPECT_FALSE(save_transversal(file, *legs, some_tag()).ok()) << broken;
    EXPECT_FALSE(save_automatic(file, kEntries).ok()) << broken;
    EXPECT_EQ(text("legs.collision.json"), broken);
  }
}

TEST_F(SaveCollision, AppendsATagAndNothingElse) {
  const auto file = test::write_legs(folder_);
  const auto legs = load(file);
  const auto saved = save_transversal(file, *legs, some_tag());
  ASSERT_TRUE(saved.ok()) << to_text(saved.diagnostics());
  EXPECT_TRUE(saved->changed);
  EXPECT_FALSE(saved->named_anew);
  EXPECT_EQ(text("legs.collision.json"),
            with(std::string(kTags), "\"second\": { \"bone\": \"pelvis\" } }\n",
                 "\"second\": { \"bone\": \"pelvis\" } },\n    { \"first\": { \"muscle\": \"vastus_r\", \"at\": 0.618, "
                 "\"angle\": 1 }, \"second\": { \"muscle\": \"soleus_r\", \"at\": 0.3, \"angle\": 2 }, \"yields\": "
                 "\"second\", \"sweeps\": true }\n"));
  const auto again = load(file);
  ASSERT_TRUE(again);
  const TransversalTag& tag = again->collision.transversals.back();
  EXPECT_EQ(tag.first.muscle, 0u);
  EXPECT_NEAR(tag.first.fraction, 0.618f, 1e-6f);
  EXPECT_EQ(tag.yields, Yields::kSecond);
  EXPECT_TRUE(tag.sweeps);
  EXPECT_FALSE(tag.automatic);
}

TEST_F(SaveCollision, MakesTheFileAndItsReference) {
  folder_.write("shapes.gltf", test::kShapes);
  const auto file = folder_.write("legs.character.json", test::kLegs);
  const auto legs = load(file);
  TransversalTag tag = some_tag();
  tag.bone = legs->skeleton->find("pelvis");
  const auto saved = save_transversal(file, *legs, tag, false);
  ASSERT_TRUE(saved.ok()) << to_text(saved.diagnostics());
  EXPECT_TRUE(saved->named_anew);
  EXPECT_EQ(text("legs.character.json"), test::legs_with_collision());
  const auto again = load(file);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->collision.transversals.size(), 1u);
  EXPECT_EQ(again->collision.transversals[0].bone, tag.bone);
  EXPECT_EQ(again->collision.transversals[0].yields, Yields::kFirst);
}

TEST_F(SaveCollision, AutomaticEntriesAreReplacedOnce) {
  const auto file = test::write_legs(folder_);
  const auto legs = load(file);
  const CollisionNames names{legs->descriptions, *legs->skeleton};
  TransversalTag tag = some_tag();
  tag.automatic = true;
  BoneTag bones{1, 0.25f, 1.0f, {legs->skeleton->find("pelvis")}, true, {}};
  const AutomaticEntries entries{{write_entry(tag, names, false)}, {write_entry(bones, names, std::nullopt)}};
  const auto dry = save_automatic(file, entries, false);
  ASSERT_TRUE(dry.ok() && dry->changed);
  EXPECT_EQ(text("legs.collision.json"), kTags);
  const auto saved = save_automatic(file, entries);
  ASSERT_TRUE(saved.ok()) << to_text(saved.diagnostics());
  EXPECT_TRUE(saved->changed);
  const std::string written = text("legs.collision.json");
  const auto again = save_automatic(file, entries);
  ASSERT_TRUE(again.ok());
  EXPECT_FALSE(again->changed);
  EXPECT_EQ(text("legs.collision.json"), written);
  const auto loaded = load(file);
  ASSERT_TRUE(loaded);
  EXPECT_TRUE(loaded->collision.transversals.back().automatic);
  EXPECT_TRUE(loaded->collision.bone_tags[loaded->collision.bone_tags.size() - 2].automatic);
  ASSERT_TRUE(save_automatic(file, {}).ok());
  EXPECT_EQ(text("legs.collision.json"), kTags);  // the author's part, as it was
}

}  // namespace
}  // namespace fascicle::muscle
