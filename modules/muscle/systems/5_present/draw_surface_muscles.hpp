// From surface muscles to the renderer: once per muscle its triangles and fibres, once a step where they are now. As
// draw_muscles.hpp does for musculotendon units, and in the same library.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/resource.hpp"
#include "engine/ecs/view.hpp"
#include "engine/render/draw_types.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/systems/5_present/draw_collision.hpp"
#include "modules/muscle/systems/5_present/draw_muscles.hpp"

namespace fascicle::muscle {

// On a surface muscle's entity: its things in the renderer.
struct DrawnSurfaceMuscle {
  SurfaceHandle surface;
  FibreHandle fibres;                // none where the muscle has no FibreBundle
  std::uint32_t teleport_count = 0;  // of the bones when last uploaded: a jump is not interpolated
};

// Line strips along a bundle's fibres, in the order of FibreBundle::points.
std::vector<std::uint32_t> make_fibre_indices(const FibreBundleAsset& bundle);

// The colour of fibre `index` by how long it is beside its length at rest: pale as it is there, the bluer the shorter and
// the redder the longer, up to three tenths. Neighbours differ in brightness, so that they can be told apart.
std::uint32_t fibre_colour(float length_ratio, std::uint32_t index);

// Copies vertices, tendon-coloured where they are attached, and fibres into the renderer.
void upload_surface_muscles(ecs::View<const SurfaceMuscle, const DrawnSurface, DrawnSurfaceMuscle> muscles,
                            ecs::View<const SurfaceState, const FibreBundle> bundles,
                            ecs::View<const BoneMatrices> characters, ecs::Resource<const DrawTarget> target);

// Appends the attached vertices as points, and where the muscle touches bones.
void mark_attached(const SurfaceAsset& asset, const DrawnSurface& drawn, CollisionMarks& marks);
void mark_surface_contacts(const SurfaceContacts& contacts, CollisionMarks& marks);

}  // namespace fascicle::muscle
