// The walker's skin: the smooth wrap of bones, muscles and simple solids for what the 48 muscles leave out (fat, the
// other muscles of thigh and calf, belly and buttocks), bound to the bones with smooth weights.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/content/triangle_mesh.hpp"
#include "tools/walker/bone_shapes.hpp"

namespace fascicle::walker {

struct Skin {
  TriangleMesh mesh;                                // character's rest space, with normals
  std::vector<std::array<std::uint8_t, 4>> joints;  // index into bones()
  std::vector<std::array<float, 4>> weights;        // sum 1
};

// `parts` in the character's rest space. The muscles' unfitted spindles about their action lines lie inside as well.
Skin make_skin(const std::vector<TriangleMesh>& parts, const std::vector<BoneShape>& bones,
               const std::vector<MuscleSpec>& muscles);

}  // namespace fascicle::walker
