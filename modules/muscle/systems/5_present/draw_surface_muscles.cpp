#include "modules/muscle/systems/5_present/draw_surface_muscles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include <glm/common.hpp>

#include "engine/ecs/each_in_parallel.hpp"
#include "engine/render/renderer.hpp"
#include "modules/muscle/asset/fibres/fibre_bundle.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kShownStretch = 0.3f;  // of a fibre: the colour's end
constexpr float kDarkest = 0.55f;      // of a fibre: brightness beside the brightest
constexpr float kGolden = 0.61803399f;
const glm::vec4 kFibreAtRest(0.98f, 0.90f, 0.74f, 1.0f);
const glm::vec4 kFibreShort(0.30f, 0.62f, 1.0f, 1.0f);
const glm::vec4 kFibreLong(1.0f, 0.34f, 0.16f, 1.0f);

// The renderer's memory is written once, in order, and never read.
void write_vertices(const SurfaceAsset& asset, const DrawnSurface& drawn, std::span<DrawVertex> vertices) {
  if (vertices.size() != drawn.vertices.size()) return;
  auto attached = asset.attached.begin();
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const bool is_attached = attached != asset.attached.end() && attached->vertex == v;
    if (is_attached) ++attached;
    const SurfaceVertex& vertex = drawn.vertices[v];
    vertices[v] = {vertex.position, vertex.normal | (is_attached ? kTendonVertex : 0u)};
  }
}

void write_fibres(const SurfaceState& state, const FibreBundle& bundle, std::span<LineVertex> vertices) {
  const FibreBundleAsset& asset = *bundle.asset;
  const std::size_t points = asset.points_per_fibre;
  if (vertices.size() != points * asset.count || bundle.points.size() < vertices.size()) return;
  for (std::size_t i = 0; i < asset.count; ++i) {
    const float rest = asset.rest_length[i];
    const std::uint32_t colour =
        fibre_colour(rest > 0.0f ? bundle.length[i] / rest : 1.0f, static_cast<std::uint32_t>(i));
    for (std::size_t k = i * points; k < (i + 1) * points; ++k) {
      const SurfacePoint& p = bundle.points[k];
      vertices[k] = {glm::vec3(state.frame * glm::vec4(p.x, p.y, p.z, 1.0f)), colour};
    }
  }
}

}  // namespace

std::vector<std::uint32_t> make_fibre_indices(const FibreBundleAsset& bundle) {
  std::vector<std::uint32_t> indices;
  indices.reserve(std::size_t{bundle.count} * (bundle.points_per_fibre + 1));
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < bundle.count; ++i) {
    for (std::uint32_t k = 0; k < bundle.points_per_fibre; ++k) indices.push_back(next++);
    indices.push_back(kPrimitiveRestart);
  }
  return indices;
}

std::uint32_t fibre_colour(float length_ratio, std::uint32_t index) {
  const float stretch = std::clamp((length_ratio - 1.0f) / kShownStretch, -1.0f, 1.0f);
  const glm::vec4 colour = glm::mix(kFibreAtRest, stretch < 0.0f ? kFibreShort : kFibreLong, std::abs(stretch));
  const float place = kGolden * static_cast<float>(index);
  const float brightness = glm::mix(kDarkest, 1.0f, place - std::floor(place));
  return pack_colour(glm::vec4(brightness * glm::vec3(colour), 1.0f));
}

void upload_surface_muscles(ecs::View<const SurfaceMuscle, const DrawnSurface, DrawnSurfaceMuscle> muscles,
                            ecs::View<const SurfaceState, const FibreBundle> bundles,
                            ecs::View<const BoneMatrices> characters, ecs::Resource<const DrawTarget> target) {
  Renderer& renderer = *target->renderer;
  const auto upload = [&](ecs::Entity entity, const SurfaceMuscle& muscle, const DrawnSurface& surface,
                          DrawnSurfaceMuscle& drawn) {
    write_vertices(*muscle.asset, surface, renderer.surface_vertices(drawn.surface));
    const FibreBundle* bundle = drawn.fibres ? bundles.try_get<const FibreBundle>(entity) : nullptr;
    const SurfaceState* state = bundles.try_get<const SurfaceState>(entity);
    if (bundle != nullptr && state != nullptr) write_fibres(*state, *bundle, renderer.fibre_vertices(drawn.fibres));

    const BoneMatrices* bones = characters.try_get<const BoneMatrices>(muscle.character);
    if (bones != nullptr && bones->teleport_count != drawn.teleport_count) {
      drawn.teleport_count = bones->teleport_count;
      renderer.mark_teleported(drawn.surface);
      if (drawn.fibres) renderer.mark_teleported(drawn.fibres);
    }
  };
  ecs::each_in_parallel(muscles, 1, upload);
}

void mark_attached(const SurfaceAsset& asset, const DrawnSurface& drawn, CollisionMarks& marks) {
  for (const AttachedVertex& attached : asset.attached) {
    if (attached.vertex >= drawn.vertices.size()) continue;
    const bool origin = asset.attachments[attached.attachment].origin;
    const std::uint32_t colour = origin ? kCollisionColours.author_tag : kCollisionColours.displacement;
    marks.points.push_back({drawn.vertices[attached.vertex].position, colour, 3.0f});
  }
}

void mark_surface_contacts(const SurfaceContacts& contacts, CollisionMarks& marks) {
  for (const SurfaceContact& contact : contacts.now) {
    if (contact.vertices > 0) marks.points.push_back({contact.place, kCollisionColours.bone_contact, 9.0f});
  }
}

}  // namespace fascicle::muscle
