#include "modules/muscle/content/hull_store.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "modules/muscle/content/character_asset.hpp"
#include "modules/muscle/content/surface_hulls.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

using test::with;
using testing::HasSubstr;

HullStore make_store() {
  HullStore store;
  StoredHull& soleus = store["soleus \"right\""];
  soleus.inputs = 0x0123456789abcdefull;
  soleus.hull.mesh = test::make_corner(0.25f, glm::vec3(-1.0f / 3.0f, 1e-9f, 0.7f));
  soleus.hull.volume = 1.0 / 3.0e4;
  soleus.hull.fine_volume = 1.0 / 7.0e4;
  soleus.hull.distance = 0.0123f;
  StoredHull& box = store["box"];
  box.hull.mesh = test::make_box(glm::vec3(-1.0f), glm::vec3(1.0f));
  box.hull.volume = box.hull.fine_volume = 8.0;
  return store;
}

std::string sound() { return write_hull_store(make_store()); }

std::string error_of(std::string text) {
  const Result<HullStore> store = parse_hull_store(std::move(text), "walker.hulls.json");
  return store ? "no error" : to_string(store.diagnostics().errors.front());
}

TEST(HullStore, RefusesWhatIsBroken) {
  EXPECT_THAT(error_of(""), HasSubstr("walker.hulls.json"));
  EXPECT_THAT(error_of("{}"), HasSubstr("'version' is missing"));
  EXPECT_THAT(error_of(with(sound(), "\"version\": 1", "\"version\": 7")),
              HasSubstr("the stored hulls have version 7; write the file anew with fascicle-cook hull --store"));
  EXPECT_THAT(error_of(with(sound(), "0123456789abcdef", "0123456789abcdxx")), HasSubstr("is no hash"));
  EXPECT_THAT(error_of(with(sound(), "0123456789abcdef", "0123")), HasSubstr("16 hexadecimal digits"));
  EXPECT_THAT(error_of(with(sound(), "\"fine_volume\": 8", "\"fine_volume\": 0")), HasSubstr("out of range"));
  EXPECT_THAT(error_of(with(sound(), "\"triangles\": [0, 2, 1, 1", "\"triangles\": [0, 2, 8, 1")),
              HasSubstr("24 numbers of positions and 36 corners up to 8 are no triangles"));
  EXPECT_THAT(error_of(with(sound(), "\"triangles\": [0, 2, 1, 1", "\"triangles\": [0, 2, 1")),
              HasSubstr("35 corners"));
  EXPECT_THAT(error_of(with(sound(), "\"triangles\": [0, 2, 1, 1", "\"triangles\": [0, 2, -1, 1")),
              HasSubstr("triangles/2"));
  EXPECT_THAT(error_of(with(sound(), "\"positions\": [-1, -1, -1", "\"positions\": [-1, -1")),
              HasSubstr("23 numbers of positions"));
  EXPECT_THAT(error_of(with(sound(), "\"positions\": [-1, -1, -1", "\"positions\": [-1, 1e9, -1")),
              HasSubstr("positions/1"));
  EXPECT_THAT(error_of(with(sound(), "\"name\": \"box\"", "\"name\": \"box\", \"colour\": 1")),
              HasSubstr("unknown member 'colour'"));
  EXPECT_THAT(error_of(with(sound(), "\"name\": \"box\"", "\"name\": \"soleus \\\"right\\\"\"")),
              HasSubstr("a second muscle"));
}

TEST(HullStore, KnowsWhatWasChangedByHand) {
  const char* cause = "the hull of 'box' is not as it was written; write the file anew with fascicle-cook hull --store";
  EXPECT_THAT(error_of(with(sound(), "\"positions\": [-1, -1, -1", "\"positions\": [-1, -2, -1")), HasSubstr(cause));
  EXPECT_THAT(error_of(with(sound(), "\"triangles\": [0, 2, 1, 1", "\"triangles\": [0, 1, 2, 1")), HasSubstr(cause));
  EXPECT_THAT(error_of(with(sound(), "\"fine_volume\": 8", "\"fine_volume\": 7")), HasSubstr(cause));
}

TEST(HullStore, RefusesTextThatEndsEarly) {
  const std::string text = sound();
  for (std::size_t length = 0; length + 2 < text.size(); length += 7) {
    EXPECT_FALSE(parse_hull_store(text.substr(0, length), "cut").ok()) << length;
  }
}

TEST(HullStore, RefusesAFileThatIsNotThere) {
  EXPECT_FALSE(read_hull_store("no/such/folder/walker.hulls.json").ok());
}

TEST(HullStore, ComesBackBitForBit) {
  const Result<HullStore> store = parse_hull_store(sound(), "walker.hulls.json");
  ASSERT_TRUE(store.ok()) << to_text(store.diagnostics());
  const HullStore made = make_store();
  ASSERT_EQ(store->size(), made.size());
  for (const auto& [name, stored] : made) {
    const StoredHull& read = store->at(name);
    EXPECT_EQ(read.inputs, stored.inputs);
    EXPECT_EQ(read.hull.mesh.positions, stored.hull.mesh.positions);
    EXPECT_EQ(read.hull.mesh.indices, stored.hull.mesh.indices);
    EXPECT_EQ(read.hull.mesh.name, name);
    EXPECT_EQ(read.hull.volume, stored.hull.volume);
    EXPECT_EQ(read.hull.fine_volume, stored.hull.fine_volume);
    EXPECT_EQ(read.hull.distance, stored.hull.distance);
  }
  EXPECT_EQ(write_hull_store(*store), sound());
}

TEST(HullStore, MayBeEmpty) {
  const Result<HullStore> store = parse_hull_store(write_hull_store({}), "walker.hulls.json");
  ASSERT_TRUE(store.ok()) << to_text(store.diagnostics());
  EXPECT_TRUE(store->empty());
}

TEST(HullStore, InputsAreTheMeshAndTheTarget) {
  const TriangleMesh mesh = test::make_sphere(0.1f, 6, 8);
  const HullTarget target{.vertices = 20, .error = 0.01f};
  const std::uint64_t inputs = hull_inputs(mesh, target);
  EXPECT_EQ(hull_inputs(mesh, target), inputs);
  TriangleMesh named = mesh;
  named.name = "soleus";
  EXPECT_EQ(hull_inputs(named, target), inputs);
  TriangleMesh moved = mesh;
  moved.positions[3].y = std::nextafter(moved.positions[3].y, 1.0f);
  EXPECT_NE(hull_inputs(moved, target), inputs);
  EXPECT_NE(hull_inputs(test::inside_out(mesh), target), inputs);
  EXPECT_NE(hull_inputs(mesh, {.vertices = 21, .error = 0.01f}), inputs);
  EXPECT_NE(hull_inputs(mesh, {.vertices = 20, .error = 0.02f}), inputs);
}

TEST(HullStore, LiesBesideItsCharacter) {
  EXPECT_EQ(hull_store_of("a/walker/walker.character.json"), "a/walker/walker.hulls.json");
  EXPECT_EQ(hull_store_of("legs.json"), "legs.hulls.json");
  EXPECT_EQ(hull_store_of("legs"), "legs.hulls.json");
}

// Who changes the way hulls are made raises kHullVersion and stores the project's own anew.
TEST(HullStore, TheHipsHullsAreWhatWouldBeMadeNow) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/gluteus_maximus.vtk");
  const std::filesystem::path file = std::filesystem::path(FASCICLE_SOURCE_DIR) / "content" / "characters" / "hip-hull" /
                                     "hip-hull.character.json";
  const auto store = read_hull_store(hull_store_of(file));
  ASSERT_TRUE(store.ok()) << to_text(store.diagnostics());
  const auto character = load_character(
      file, {.data_folder = test::data_folder(), .fit = FitMode::kNone, .hulls = HullMode::kNone, .bone_fields = false});
  ASSERT_TRUE(character.ok()) << to_text(character.diagnostics());
  ASSERT_EQ((*character)->surface_descriptions.size(), store->size());
  for (const SurfaceMuscleDescription& muscle : (*character)->surface_descriptions) {
    const StoredHull& stored = store->at(muscle.name);
    EXPECT_EQ(stored.inputs, hull_inputs(muscle.mesh, hull_target(muscle))) << muscle.name;
    const auto hull = build_progressive_hull(muscle.mesh, hull_target(muscle));
    ASSERT_TRUE(hull.ok());
    EXPECT_EQ(stored.hull.mesh.positions, hull->mesh.positions) << muscle.name;
    EXPECT_EQ(stored.hull.mesh.indices, hull->mesh.indices) << muscle.name;
  }
}

}  // namespace
}  // namespace fascicle::muscle
