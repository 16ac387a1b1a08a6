#include "modules/muscle/content/fit_store.hpp"

#include <gmock/gmock.h>

#include "tests/modules/muscle/content/scratch_content.hpp"

namespace fascicle::muscle {
namespace {

using test::with;
using testing::HasSubstr;

// Two muscles, one of them fitted at two levels, the other not.
FitStore make_store() {
  FitStore store;
  MuscleFits& soleus = store["soleus \"right\""];
  soleus.inputs = 0x0123456789abcdefull;
  for (const std::uint32_t sections : {3u, 2u}) {
    FittedLevel& level = soleus.levels.emplace_back();
    level.section_vertices = 6;
    level.longitudinal_subdivision = sections - 2;
    for (std::uint32_t k = 0; k < sections; ++k) {
      level.fitted.fit.displacements.emplace_back(0.1f * static_cast<float>(k), -1.0f / 3.0f, 1e-9f);
      for (int i = 0; i < 6; ++i) level.fitted.fit.radii.push_back(0.01f / static_cast<float>(i + 1) - 0.003f);
      level.fitted.sections.push_back({.hits = 5, .misses = 1, .matches = k, .loops = 2, .moved = 0.1f * static_cast<float>(k),
                                       .inside = true, .rescued = k == 1, .outcome = SectionOutcome::kPartial});
    }
  }
  soleus.levels[0].fitted.fit.end_normals[1] = glm::vec3(0.0f, 0.6f, 0.8f);
  soleus.levels[0].fitted.diagnostics.warnings.push_back({{}, 0, 0, {}, "3 open edges", "close \"them\""});
  store["unfitted"].levels.push_back({8, 1, {}});
  return store;
}

std::string sound() { return write_fit_store(make_store()); }

std::string error_of(std::string text) {
  const Result<FitStore> store = parse_fit_store(std::move(text), "walker.fit.json");
  return store ? "no error" : to_string(store.diagnostics().errors.front());
}

TEST(FitStore, RefusesWhatIsBroken) {
  EXPECT_THAT(error_of(""), HasSubstr("walker.fit.json"));
  EXPECT_THAT(error_of("{}"), HasSubstr("'version' is missing"));
  EXPECT_THAT(error_of(with(sound(), "\"version\": 1", "\"version\": 7")),
              HasSubstr("the stored fits have version 7; write the file anew with fascicle-cook fit"));
  EXPECT_THAT(error_of(with(sound(), "0123456789abcdef", "0123456789abcdxx")), HasSubstr("is no hash"));
  EXPECT_THAT(error_of(with(sound(), "0123456789abcdef", "0123")), HasSubstr("16 hexadecimal digits"));
  EXPECT_THAT(error_of(with(sound(), "\"displacements\": [0, -0.33333334, 1e-09, 0.1, -0.33333334, 1e-09, 0.2",
                            "\"displacements\": [0, -0.33333334, 1e-09, 0.1, -0.33333334, 1e-09")),
              HasSubstr("8 displacements and 18 radii don't fit 6 vertices a section"));
  EXPECT_THAT(error_of(with(sound(), "\"section_vertices\": 8", "\"section_vertices\": 4")), HasSubstr("out of range"));
  EXPECT_THAT(error_of(with(sound(), "\"name\": \"unfitted\"", "\"name\": \"unfitted\", \"colour\": 1")),
              HasSubstr("unknown member 'colour'"));
  EXPECT_THAT(error_of(with(sound(), "\"name\": \"unfitted\"", "\"name\": \"soleus \\\"right\\\"\"")),
              HasSubstr("a second muscle"));
  EXPECT_THAT(error_of(with(sound(), "\"longitudinal_subdivision\": 0", "\"longitudinal_subdivision\": 3")),
              HasSubstr("is not as it was written; write the file anew with fascicle-cook fit"));
}

TEST(FitStore, RefusesTextThatEndsEarly) {
  const std::string text = sound();
  for (std::size_t length = 0; length + 2 < text.size(); length += 7) {
    EXPECT_FALSE(parse_fit_store(text.substr(0, length), "cut").ok()) << length;
  }
}

TEST(FitStore, ComesBackBitForBit) {
  const Result<FitStore> store = parse_fit_store(sound(), "walker.fit.json");
  ASSERT_TRUE(store.ok()) << to_text(store.diagnostics());
  const FitStore made = make_store();
  ASSERT_EQ(store->size(), made.size());
  for (const auto& [name, fits] : made) {
    const MuscleFits& read = store->at(name);
    EXPECT_EQ(read.inputs, fits.inputs);
    ASSERT_EQ(read.levels.size(), fits.levels.size());
    for (std::size_t i = 0; i < fits.levels.size(); ++i) {
      const FittedMuscle &a = fits.levels[i].fitted, &b = read.levels[i].fitted;
      EXPECT_EQ(a.fit.displacements, b.fit.displacements);
      EXPECT_EQ(a.fit.radii, b.fit.radii);
      EXPECT_EQ(a.fit.end_normals, b.fit.end_normals);
      ASSERT_EQ(a.sections.size(), b.sections.size());
      for (std::size_t k = 0; k < a.sections.size(); ++k) {
        EXPECT_EQ(a.sections[k].matches, b.sections[k].matches);
        EXPECT_EQ(a.sections[k].moved, b.sections[k].moved);
        EXPECT_EQ(a.sections[k].rescued, b.sections[k].rescued);
        EXPECT_EQ(a.sections[k].outcome, b.sections[k].outcome);
      }
    }
  }
  EXPECT_EQ(store->at("soleus \"right\"").levels[0].fitted.diagnostics.warnings.at(0).remedy, "close \"them\"");
  EXPECT_EQ(write_fit_store(*store), sound());
}

TEST(FitStore, LiesBesideItsCharacter) {
  EXPECT_EQ(fit_store_of("a/walker/walker.character.json"), "a/walker/walker.fit.json");
  EXPECT_EQ(fit_store_of("legs.json"), "legs.fit.json");
  EXPECT_EQ(fit_store_of("legs"), "legs.fit.json");
}

}  // namespace
}  // namespace fascicle::muscle
