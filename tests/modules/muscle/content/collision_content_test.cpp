// Collision files as they are loaded: resolved, mirrored, and on the same places of the surface whatever the level of
// detail and the fit.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gmock/gmock.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/file_text.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/collision/tag_angle.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/content/content_reloader.hpp"
#include "modules/muscle/content/tag_place.hpp"
#include "tests/modules/muscle/content/scratch_collision.hpp"
#include "tests/support/copy_folder.hpp"

namespace fascicle::muscle {
namespace {

using test::kTags;
using test::ScratchFolder;
using test::with;

std::shared_ptr<const CharacterAsset> load(const std::filesystem::path& file, LoadOptions options = {}) {
  options.bone_fields = false;
  auto loaded = load_character(file, options);
  EXPECT_TRUE(loaded.ok()) << to_text(loaded.diagnostics());
  return loaded.ok() ? *loaded : nullptr;
}

TEST(CollisionContent, WithoutAFileIsEnabledAndEmpty) {
  const ScratchFolder folder;
  folder.write("shapes.gltf", test::kShapes);
  const auto legs = load(folder.write("legs.character.json", test::kLegs));
  ASSERT_TRUE(legs);
  EXPECT_TRUE(legs->collision.settings.enabled);
  EXPECT_TRUE(legs->collision.transversals.empty() && legs->collision.bone_tags.empty());
}

TEST(CollisionContent, IsReadAndMirroredWhereThereIsAnotherSide) {
  const ScratchFolder folder;
  const auto legs = load(test::write_legs(folder));
  ASSERT_TRUE(legs);
  const CollisionDescription& found = legs->collision;
  EXPECT_EQ(found.settings.substeps, 3u);
  EXPECT_FLOAT_EQ(found.settings.shape_time, 0.08f);
  EXPECT_EQ(found.settings.iterations, CollisionSettings{}.iterations);
  // The soleus has no other side: its tag stands alone. The vastus' follows it on the left.
  ASSERT_EQ(found.transversals.size(), 3u);
  EXPECT_EQ(found.transversals[0].second.muscle, 2u);
  EXPECT_EQ(found.transversals[1].first.muscle, 0u);
  EXPECT_EQ(found.transversals[1].yields, Yields::kFirst);
  EXPECT_EQ(found.transversals[2].first.muscle, 1u);
  EXPECT_EQ(found.transversals[2].bone, legs->skeleton->find("pelvis"));
  EXPECT_EQ(found.transversals[2].where.line, 7);
  ASSERT_EQ(found.bone_tags.size(), 2u);
  EXPECT_EQ(found.bone_tags[1].muscle, 1u);
  ASSERT_EQ(found.ignored.size(), 1u);
  EXPECT_EQ(legs->mirror.axis, 0);
  EXPECT_THAT(legs->mirror.muscles, testing::ElementsAre(1, 0, -1));
  EXPECT_EQ(legs->mirror.bones[static_cast<std::size_t>(legs->skeleton->find("femur_r"))],
            legs->skeleton->find("femur_l"));
  EXPECT_TRUE(std::set(legs->files.begin(), legs->files.end()).contains(folder.path() / "legs.collision.json"));
}

// The left leg's bones have the right one's axes, not their mirror images: angles must follow from the frames.
TEST(CollisionContent, AMirroredTagIsTheReflectedPlace) {
  const ScratchFolder folder;
  const auto legs = load(test::write_legs(folder), {.fit = FitMode::kNone});
  ASSERT_TRUE(legs);
  const TransversalTag& tag = legs->collision.transversals[1];
  const TransversalTag& image = legs->collision.transversals[2];
  const glm::vec3 place = tagged_place(*legs->muscles, tag.first);
  const glm::vec3 mirrored = tagged_place(*legs->muscles, image.first);
  EXPECT_LT(glm::distance(glm::vec3(-place.x, place.y, place.z), mirrored), 1e-5f);
}

TEST(CollisionContent, MuscleFromAnotherFileCanBeTagged) {
  const ScratchFolder folder;
  test::write_legs(folder);
  std::string text = with(test::legs_with_collision(), "\"name\": \"legs\"", "\"name\": \"more\"");
  const std::size_t muscles = text.find("  \"muscles\": [");
  text = text.substr(0, muscles) + "  \"muscles_from\": \"base.character.json\"\n}\n";
  folder.write("base.character.json", test::kLegs);
  const auto more = load(folder.write("more.character.json", text));
  ASSERT_TRUE(more);
  EXPECT_EQ(more->collision.transversals.size(), 3u);
}

TEST(CollisionContent, IsWatched) {
  const ScratchFolder folder;
  test::write_pair(folder);
  test::write_legs(folder);
  const auto file = folder.path() / "pair.scene.json";
  const auto scene = load_scene(file, {.bone_fields = false});
  ASSERT_TRUE(scene.ok());
  ContentReloader reloader(file, *scene, {.bone_fields = false});
  reloader.wait();
  folder.write("legs.collision.json", with(std::string(kTags), "\"substeps\": 3", "\"substeps\": 7"));
  auto outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
  EXPECT_EQ(outcome->scene->characters[0].character->collision.settings.substeps, 7u);
  folder.write("legs.collision.json", with(std::string(kTags), "\"substeps\": 3", "\"substeps\": 99"));
  outcome = reloader.wait();
  ASSERT_TRUE(outcome);
  EXPECT_FALSE(outcome->scene);
  folder.write("legs.collision.json", kTags);
  outcome = reloader.wait();
  ASSERT_TRUE(outcome && outcome->scene);
}

MuscleDescription bent_muscle() {
  MuscleDescription muscle;
  muscle.name = "m";
  muscle.attachments = {{0, {0, 0, 0}}, {0, {0.02f, -0.1f, 0.03f}}, {0, {-0.02f, -0.2f, 0.05f}}, {0, {0, -0.4f, 0}}};
  muscle.profile = {{0.0f, 1.0f}, {0.02f, 0.02f}, true};
  muscle.longitudinal_subdivision = 3;
  return muscle;
}

std::shared_ptr<const MuscleAsset> build(const MuscleFit& fit = {}) {
  const std::vector<MuscleDescription> muscles{bent_muscle()};
  const std::vector<glm::mat4> bones{glm::mat4(1.0f)};
  const std::vector<MuscleFit> fits{fit};
  const auto asset = build_muscle_asset(muscles, bones, fits);
  EXPECT_TRUE(asset.ok()) << to_text(asset.diagnostics());
  return *asset;
}

TEST(TagAngle, IsThetaWhereNoFitHasMovedTheLine) {
  const auto asset = build();
  for (std::uint32_t k = 0; k < asset->muscles[0].section_count; ++k) {
    EXPECT_NEAR(tag_angle_offset(*asset, 0, k), 0.0f, 1e-3f) << k;
    for (std::uint32_t i = 0; i < 8 && k > 0; ++i) {
      const SectionTag tag = tag_of(*asset, 0, k, i);
      EXPECT_NEAR(std::remainder(tag.angle - 0.7853982f * static_cast<float>(i), 6.2831853f), 0.0f, 1e-3f);
    }
  }
  EXPECT_FLOAT_EQ(wrap_angle(-1.0f), 5.2831853f);
  EXPECT_FLOAT_EQ(wrap_angle(7.0f), 0.7168147f);
}

// Two centres moved aside turn u_k behind them; a tag further down stays where it was.
TEST(TagAngle, AKinkDoesNotTurnWhatIsBehindIt) {
  MuscleFit fit;
  fit.displacements.assign(25, glm::vec3(0.0f));
  fit.displacements[9] = {0.05f, 0.0f, 0.0f};
  fit.displacements[10] = {0.0f, 0.02f, 0.05f};
  const auto plain = build(), kinked = build(fit);
  const std::uint32_t k = 20;
  const auto u = [&](const MuscleAsset& asset) {
    const std::uint32_t slot = asset.slot(0, k);
    return glm::vec3(asset.rest_ux[slot], asset.rest_uy[slot], asset.rest_uz[slot]);
  };
  EXPECT_GT(glm::distance(u(*plain), u(*kinked)), 0.3f);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const SectionTag tag{0, tag_of(*kinked, 0, k, 0).fraction, tag_of(*plain, 0, k, i).angle};
    EXPECT_LT(glm::distance(tagged_place(*kinked, tag), rest_vertex(*plain, 0, k, i)), 1e-3f);
  }
}

// The example that authors copy, on the walker.
TEST(CollisionContent, TheReadmesExampleIsSound) {
  const std::filesystem::path content = std::filesystem::path(FASCICLE_SOURCE_DIR) / "content";
  const std::string readme = read_text_file(content / "README.md").value();
  const std::size_t start = readme.rfind("```json\n", readme.find("\"transversals\""));
  ASSERT_NE(start, std::string::npos);
  const std::string example = readme.substr(start + 8, readme.find("```", start + 8) - start - 8);
  const ScratchFolder folder;
  test::copy_character_folder(content / "characters/walker", folder.path());
  folder.write("walker.collision.json", example);
  const auto character = load(folder.path() / "walker.character.json");
  ASSERT_TRUE(character);
  EXPECT_EQ(character->collision.transversals.size(), 4u);
  EXPECT_EQ(character->collision.ignored.size(), 2u);
}

class WalkerCollision : public testing::Test {
 protected:
  static std::shared_ptr<const CharacterAsset> walker(LoadOptions options = {}) {
    const std::filesystem::path content = std::filesystem::path(FASCICLE_SOURCE_DIR) / "content";
    return load(content / "characters/walker/walker.character.json", options);
  }
};

// The angle of a mirrored tag, and the vertices there, on the fitted surfaces. The two sides' fits differ by rounding.
TEST_F(WalkerCollision, MirroredVerticesAreMirrorImages) {
  const auto character = walker();
  ASSERT_TRUE(character);
  const MuscleAsset& asset = *character->muscles;
  std::size_t tested = 0;
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const std::int32_t other = character->mirror.muscles[m];
    ASSERT_GE(other, 0);
    for (std::uint32_t k = 1; k + 1 < asset.muscles[m].section_count; ++k) {
      for (std::uint32_t i = 0; i < asset.muscles[m].section_vertices; i += 3) {
        const SectionTag tag = tag_of(asset, m, k, i);
        const SectionTag image = mirror_tag(asset, tag, static_cast<std::uint32_t>(other), 0);
        const glm::vec3 vertex = rest_vertex(asset, m, k, i);
        ASSERT_LT(glm::distance(tagged_place(asset, tag), vertex), 2e-5f);
        const glm::vec3 reflected(-vertex.x, vertex.y, vertex.z);
        ASSERT_LT(glm::distance(tagged_place(asset, image), reflected), 1e-3f) << asset.muscles[m].name << ' ' << k;
        ++tested;
      }
    }
  }
  EXPECT_GT(tested, 2000u);
}

TEST_F(WalkerCollision, TagsOfBothSidesComeInPairs) {
  const auto character = walker();
  ASSERT_TRUE(character);
  const auto& tags = character->collision.transversals;
  ASSERT_GT(tags.size(), 40u);
  std::size_t pairs = 0;
  for (std::size_t i = 1; i < tags.size(); ++i) {
    if (tags[i].where.line != tags[i - 1].where.line) continue;
    const glm::vec3 place = tagged_place(*character->muscles, tags[i - 1].first);
    const glm::vec3 image = tagged_place(*character->muscles, tags[i].first);
    EXPECT_LT(glm::distance(glm::vec3(-place.x, place.y, place.z), image), 1e-3f);
    ++pairs;
  }
  EXPECT_GT(pairs, 20u);
}

// At other levels of detail and fitted anew a tag's place moves by less than the spacing of sections and vertices
// there, in the iliacus too, whose fitted line has a kink over the rim of the pelvis behind which u_k points elsewhere.
TEST_F(WalkerCollision, TagsKeepTheirPlaces) {
  const auto stored = walker();
  ASSERT_TRUE(stored);
  const auto expect_kept = [&](const LoadOptions& options, const char* what, bool same_level) {
    const auto other = walker(options);
    ASSERT_TRUE(other);
    ASSERT_EQ(other->collision.transversals.size(), stored->collision.transversals.size());
    for (std::size_t i = 0; i < stored->collision.transversals.size(); ++i) {
      const SectionTag& tag = stored->collision.transversals[i].first;
      const SectionTag& there = other->collision.transversals[i].first;
      ASSERT_EQ(tag.muscle, there.muscle);
      const MuscleLayout& layout = other->muscles->muscles[tag.muscle];
      const glm::vec3 place = tagged_place(*stored->muscles, tag);
      const SectionTag across{tag.muscle, tag.fraction, tag.angle + std::numbers::pi_v<float>};
      const float width = glm::distance(place, tagged_place(*stored->muscles, across));
      float section = 0.0f;  // the largest spacing
      for (std::uint32_t k = 1; k < layout.section_count; ++k) {
        section = std::max(section, other->muscles->rest_arc[other->muscles->slot(tag.muscle, k)] -
                                        other->muscles->rest_arc[other->muscles->slot(tag.muscle, k - 1)]);
      }
      const float vertex = std::numbers::pi_v<float> * width / static_cast<float>(layout.section_vertices);
      const float moved = glm::distance(place, tagged_place(*other->muscles, there));
      EXPECT_LT(moved, same_level ? 1e-4f : section + vertex) << what << ' ' << layout.name << ' ' << tag.fraction;
    }
  };
  expect_kept({.fit = FitMode::kFresh}, "fitted anew", true);
  expect_kept({.section_vertices = 8, .longitudinal_subdivision = 1, .fit = FitMode::kFresh}, "|C| 8, LSS 1", false);
  expect_kept({.section_vertices = 12, .longitudinal_subdivision = 2, .fit = FitMode::kFresh}, "|C| 12, LSS 2", false);
}

}  // namespace
}  // namespace fascicle::muscle
