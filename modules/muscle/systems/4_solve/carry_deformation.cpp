#include "modules/muscle/systems/4_solve/carry_deformation.hpp"

#include <algorithm>
#include <cmath>

#include <glm/mat3x3.hpp>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/components/lay_out_state.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/muscle_levels.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kSmallestRadius = 1.0e-6f;  // m: of a rest radius, to be a measure of change

// Where section `k` of `count` lies among `other_count`: in quarters no level has, so a half is enough.
struct SectionPlace {
  std::uint32_t before = 0;
  float fraction = 0.0f;
};

SectionPlace place_among(std::uint32_t k, std::uint32_t count, std::uint32_t other_count) {
  const float at = static_cast<float>(k) * static_cast<float>(other_count - 1) / static_cast<float>(count - 1);
  const std::uint32_t before = std::min(static_cast<std::uint32_t>(at), other_count - 2);
  return {before, at - static_cast<float>(before)};
}

// How much longer than at rest the old level's radius towards `turn` (0..1 of the way round) is.
float stretch_at(const CollisionSection& section, const MuscleCollision& old, float turn) {
  const float at = turn * static_cast<float>(section.count);
  const std::uint32_t i = std::min(static_cast<std::uint32_t>(at), section.count - 1);
  const std::uint32_t next = i + 1 == section.count ? 0 : i + 1;
  const auto stretch = [&](std::uint32_t j) {
    const float rest = old.rest_radii[section.first_radius + j];
    return std::abs(rest) < kSmallestRadius ? 1.0f : old.radii[section.first_radius + j] / rest;
  };
  return stretch(i) + (at - static_cast<float>(i)) * (stretch(next) - stretch(i));
}

// The deformation of one level of detail in the order of another.
void change_level(const CollisionAsset& to, MuscleCollision& collision) {
  const CollisionAsset& from = *collision.asset;
  AlignedVector<float>* offsets[3] = {&collision.offset_x, &collision.offset_y, &collision.offset_z};
  for (int axis = 0; axis < 3; ++axis) collision.carried[axis].assign(to.muscles->slot_count, 0.0f);
  collision.carried[3] = to.muscles->rest_radii;
  for (std::size_t m = 0; m < to.muscles->size(); ++m) {
    const std::uint32_t count = to.first_section[m + 1] - to.first_section[m];
    const std::uint32_t old_count = from.first_section[m + 1] - from.first_section[m];
    for (std::uint32_t k = 0; k < count; ++k) {
      const CollisionSection& section = to.sections[to.first_section[m] + k];
      const SectionPlace place = place_among(k, count, old_count);
      const CollisionSection& before = from.sections[from.first_section[m] + place.before];
      const CollisionSection& behind = from.sections[from.first_section[m] + place.before + 1];
      for (int axis = 0; axis < 3; ++axis) {
        const AlignedVector<float>& offset = *offsets[axis];
        collision.carried[axis][section.slot] =
            offset[before.slot] + place.fraction * (offset[behind.slot] - offset[before.slot]);
      }
      for (std::uint32_t i = 0; i < section.count; ++i) {
        const float turn = static_cast<float>(i) / static_cast<float>(section.count);
        const float first = stretch_at(before, collision, turn), second = stretch_at(behind, collision, turn);
        collision.carried[3][section.first_radius + i] *= first + place.fraction * (second - first);
      }
    }
  }
  for (int axis = 0; axis < 3; ++axis) std::swap(*offsets[axis], collision.carried[axis]);
  std::swap(collision.radii, collision.carried[3]);
  collision.rest_radii = to.muscles->rest_radii;
  collision.target_area.assign(to.sections.size(), 0.0f);
  collision.area.assign(to.sections.size(), 0.0f);
  collision.morph = 0.0f;
  collision.still = 0.0f;
  collision.asset = &to;
}

void take_over_level(const Musculature& musculature, MuscleCollision& collision) {
  const auto level = std::find_if(collision.levels.begin(), collision.levels.end(),
                                  [&](const auto& asset) { return asset->muscles == musculature.asset; });
  if (level == collision.levels.end()) {
    collision.asset = nullptr;
    return;
  }
  if (collision.asset == level->get()) return;
  if (collision.asset == nullptr) lay_out(**level, collision);
  else change_level(**level, collision);
}

// A level that morphs into the next has its radii at rest on the way to that one's. What is pressed goes along with
// them, even where the solve has gone to rest: a viewer who comes and goes must not wake it.
void morph_rest_radii(const Musculature& musculature, MuscleCollision& collision) {
  if (collision.morph == musculature.morph) return;
  const AlignedVector<float>& from = musculature.asset->rest_radii;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const float to = musculature.morph > 0.0f ? musculature.coarser->radii[i] : from[i];
    const float rest = from[i] + musculature.morph * (to - from[i]);
    collision.radii[i] += rest - collision.rest_radii[i];
    collision.rest_radii[i] = rest;
  }
  collision.morph = musculature.morph;
}

}  // namespace

void carry_deformation(const Musculature& musculature, MuscleCollision& collision) {
  take_over_level(musculature, collision);
  if (collision.asset != nullptr) morph_rest_radii(musculature, collision);
}

void displace_lines(const MuscleCollision& collision, std::span<const glm::mat4> bones, ActionLines& lines) {
  for (const CollisionSection& section : collision.asset->sections) {
    // A held muscle kept its line as it was drawn.
    if (section.end || (lines.any_held && lines.held[section.muscle] != 0)) continue;
    const std::uint32_t slot = section.slot;
    const glm::vec3 kept(collision.offset_x[slot], collision.offset_y[slot], collision.offset_z[slot]);
    const glm::vec3 offset = glm::mat3(bones[section.bone]) * kept;
    lines.x[slot] += offset.x;
    lines.y[slot] += offset.y;
    lines.z[slot] += offset.z;
  }
}

}  // namespace fascicle::muscle
