// The legs of scratch_content.hpp with a collision file, in a folder that goes away.
#pragma once

#include <string>
#include <string_view>

#include "modules/muscle/content/character_asset.hpp"
#include "tests/modules/muscle/content/scratch_content.hpp"

namespace fascicle::test {

// The vastus lies on both sides, the soleus on the right alone; of the bones only the pelvis has a mesh.
inline constexpr std::string_view kTags = R"({
  "$schema": "../../schema/collision.schema.json",
  "version": 1,
  "settings": { "substeps": 3, "shape_time_ms": 80 },
  "transversals": [
    { "first": { "muscle": "vastus_r", "at": 0.5, "angle": 1.5 }, "second": { "muscle": "soleus_r", "at": 0.4, "angle": 4.5 } },
    { "first": { "muscle": "vastus_r", "at": 0.25, "angle": 3 }, "second": { "bone": "pelvis" } }
  ],
  "stay_out": [
    { "muscle": "vastus_r", "from": 0.2, "to": 0.8, "bones": ["pelvis"] }
  ],
  "ignore": [
    { "muscle": "soleus_r", "bone": "pelvis" }
  ]
}
)";

inline std::string legs_with_collision() {
  return with(std::string(kLegs), "  \"muscles\": [", "  \"collision\": \"legs.collision.json\",\n  \"muscles\": [");
}

// Returns the character file.
inline std::filesystem::path write_legs(const ScratchFolder& folder, std::string_view tags = kTags) {
  folder.write("shapes.gltf", kShapes);
  folder.write("legs.collision.json", tags);
  return folder.write("legs.character.json", legs_with_collision());
}

}  // namespace fascicle::test
