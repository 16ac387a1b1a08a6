// From muscles to the renderer's strip surfaces: once per asset the constant topology, once a step the surfaces'
// current vertices. The only part of the module that knows the renderer; a host engine with its own renderer reads
// MuscleSurfaces instead and leaves this library (fascicle::muscle_draw) out.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/render/draw_types.hpp"
#include "engine/render/strip_topology.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/muscle_detail.hpp"
#include "modules/muscle/components/muscle_surfaces.hpp"
#include "modules/muscle/components/musculature.hpp"
#include "modules/muscle/components/tendons.hpp"

namespace fascicle {
class Renderer;
}

namespace fascicle::muscle {

struct MuscleAsset;

// Resource: the renderer that the upload systems write to. Its owner calls begin_step before the schedule runs.
struct DrawTarget {
  Renderer* renderer = nullptr;
};

// On a musculature's entity: its things in the renderer, of which one level of detail is drawn at a time.
struct DrawnMuscles {
  struct Level {
    StripHandle strips;
    LineHandle lines;  // action lines with their attachments; may be none
  };
  std::vector<Level> levels;          // finest first; one where the musculature has no MuscleDetail
  std::uint32_t level = 0, next = 0;  // as in MuscleDetail when last uploaded
  std::uint32_t teleport_count = 0;   // of the bones when last uploaded: a jump is not interpolated
};
std::size_t heap_bytes(const DrawnMuscles& drawn);

// The asset's surfaces as the renderer's rows, strips, fans and rings.
StripTopology make_strip_topology(const MuscleAsset& asset);

// Line strips along the action lines: one vertex a section, muscle after muscle.
std::vector<std::uint32_t> make_action_line_indices(const MuscleAsset& asset);
std::uint32_t action_line_vertex_count(const MuscleAsset& asset);

// Copies vertices, rows and action lines into the renderer. Belly and tendon colours are the items' own. Where the
// level of detail changes in the next step, its surface is written too, as what that step is interpolated from.
void upload_muscles(
    ecs::View<const Musculature, const MuscleSurfaces, const ActionLines, const Tendons, DrawnMuscles> musculatures,
    ecs::View<const MuscleDetail> details, ecs::View<const BoneMatrices> characters,
    ecs::Resource<const DrawTarget> target);

}  // namespace fascicle::muscle
