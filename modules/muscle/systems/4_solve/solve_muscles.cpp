#include "modules/muscle/systems/4_solve/solve_muscles.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "engine/ecs/each_in_parallel.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/solve_collision.hpp"
#include "modules/muscle/kernels/inflate_section.hpp"
#include "modules/muscle/systems/4_solve/carry_deformation.hpp"
#include "modules/muscle/systems/4_solve/report_contacts.hpp"
#include "modules/muscle/systems/kernel_jobs.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kLineMass = 1.0f;            // of a_k, in the masses of its radii together
constexpr float kLeastBelly = 0.4f, kMostBelly = 2.5f;  // of its length at rest, for the volume
constexpr float kLeastRadius = 0.15f, kMostRadius = 1.6f;  // of a radius at rest, in a solve
constexpr float kRoom = 0.25f;               // and of its section's mean radius on top
constexpr float kStill = 2.0e-5f;             // of a matrix' entry (m, or 1) a step: less is no movement
constexpr float kSettles = 0.5f;             // s of a pose that stays, before the solve goes to rest
constexpr float kSettlingTime = 0.08f;       // s
constexpr float kLargestOffset = 0.5f;       // of the muscle's length at rest: beyond, the solve has diverged
constexpr float kLargestStretch = 8.0f;      // of a radius, by its section's largest at rest

glm::vec3 at(const AlignedVector<float>& x, const AlignedVector<float>& y, const AlignedVector<float>& z,
             std::uint32_t i) {
  return glm::vec3(x[i], y[i], z[i]);
}

// What a section's area is held at: belly keeps its volume as its length changes, tendon its area.
float area_target(const CollisionSection& section, float belly_ratio, float rest_area) {
  return rest_area * (1.0f + section.belly * (belly_ratio - 1.0f));
}

bool is_held(const Musculature& musculature, const ActionLines& lines, std::uint32_t muscle) {
  return musculature.attached[muscle] == 0 || (lines.any_held && lines.held[muscle] != 0);
}

void load(const Musculature& musculature, const MuscleCollision& collision, const BoneMatrices& bones,
          const ActionLines& lines, const CrossSections& sections, CollisionWork& work) {
  const CollisionAsset& asset = *collision.asset;
  std::copy(collision.radii.begin(), collision.radii.end(), work.radii.begin());
  for (std::uint32_t m = 0; m < asset.muscles->size(); ++m) {
    const std::uint32_t last = asset.first_section[m + 1] - 1;
    const float length = sections.arc[asset.sections[last].slot];
    const float belly = length - (asset.rest_line[m] - asset.rest_belly[m]);
    const float ratio = collision.settings.keep_volume
                            ? asset.rest_belly[m] / std::clamp(belly, kLeastBelly * asset.rest_belly[m],
                                                               kMostBelly * asset.rest_belly[m])
                            : 1.0f;
    const bool held = is_held(musculature, lines, m);
    work.absent[m] = musculature.attached[m] == 0;
    for (std::uint32_t s = asset.first_section[m]; s <= last; ++s) {
      const CollisionSection& section = asset.sections[s];
      const std::uint32_t slot = section.slot;
      work.a[s] = work.driven[s] = at(lines.x, lines.y, lines.z, slot);
      if (!section.end && !held) {  // a held muscle kept its line as it was drawn
        work.a[s] += glm::mat3(bones.world[section.bone]) *
                     at(collision.offset_x, collision.offset_y, collision.offset_z, slot);
      }
      work.u[s] = at(sections.ux, sections.uy, sections.uz, slot);
      work.v[s] = at(sections.vx, sections.vy, sections.vz, slot);
      work.t[s] = glm::cross(work.u[s], work.v[s]);
      work.mobility[s] = section.end || held ? 0.0f : 1.0f / (kLineMass * static_cast<float>(section.count));
      const float* rest = &collision.rest_radii[section.first_radius];
      const float rest_area = section_area(std::span(rest, section.count));
      const float target = section.end ? rest_area : area_target(section, ratio, rest_area);
      work.area_target[s] = target;
      const float scale = rest_area > 0.0f ? std::sqrt(target / rest_area) : 1.0f;
      const float room = kRoom * std::sqrt(target / 3.14159265f);
      for (std::uint32_t i = 0; i < section.count; ++i) {
        const float wanted = scale * rest[i];
        work.wanted[section.first_radius + i] = wanted;
        work.least[section.first_radius + i] = std::min(kLeastRadius * wanted, kMostRadius * wanted);
        work.most[section.first_radius + i] = std::max(kLeastRadius * wanted, kMostRadius * wanted) + room;
      }
    }
  }
}

// How much of a step's change counts: all of it while the pose changes, and less and less after it has come to rest.
// What is left of contacts that take turns then dies away.
float settle(const BoneMatrices& bones, float step, MuscleCollision& collision) {
  const std::uint32_t bone_count = collision.asset->bone_count;
  const bool known = collision.pose.size() == bone_count && collision.solved == collision.settings;
  if (!known) collision.pose.resize(bone_count);
  collision.solved = collision.settings;
  const glm::mat3 turn = glm::transpose(glm::mat3(bones.world[0]));
  bool moved = !known;
  for (std::uint32_t i = 0; i < bone_count; ++i) {
    glm::mat4 pose(turn * glm::mat3(bones.world[i]));
    pose[3] = glm::vec4(turn * glm::vec3(bones.world[i][3] - bones.world[0][3]), 1.0f);
    for (int column = 0; column < 4; ++column) {
      const glm::vec3 change = glm::abs(glm::vec3(pose[column] - collision.pose[i][column]));
      moved = moved || !glm::all(glm::lessThanEqual(change, glm::vec3(kStill)));  // NaN moves, and so does its end
    }
    if (moved) collision.pose[i] = pose;
  }
  collision.still = moved ? 0.0f : collision.still + step;
  return collision.still <= kSettles ? 1.0f : std::exp(-(collision.still - kSettles) / kSettlingTime);
}

void blend(const CollisionAsset& asset, const MuscleCollision& collision, const BoneMatrices& bones, float amount,
           CollisionWork& work) {
  if (amount >= 1.0f) return;
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const CollisionSection& section = asset.sections[s];
    if (work.mobility[s] == 0.0f) continue;
    const glm::vec3 before = work.driven[s] + glm::mat3(bones.world[section.bone]) *
                                                  at(collision.offset_x, collision.offset_y, collision.offset_z,
                                                     section.slot);
    work.a[s] = glm::mix(before, work.a[s], amount);
    for (std::uint32_t i = section.first_radius; i < section.first_radius + section.count; ++i) {
      work.radii[i] = collision.radii[i] + amount * (work.radii[i] - collision.radii[i]);
    }
  }
}

bool is_sound(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t muscle) {
  const float furthest = kLargestOffset * asset.rest_line[muscle];
  for (std::uint32_t s = asset.first_section[muscle]; s < asset.first_section[muscle + 1]; ++s) {
    const CollisionSection& section = asset.sections[s];
    if (!(glm::distance(work.a[s], work.driven[s]) <= furthest)) return false;
    float largest = 1.0e-3f;
    for (std::uint32_t i = 0; i < section.count; ++i) {
      largest = std::max(largest, std::abs(work.wanted[section.first_radius + i]));
    }
    for (std::uint32_t i = 0; i < section.count; ++i) {
      if (!(std::abs(work.radii[section.first_radius + i]) <= kLargestStretch * largest)) return false;
    }
  }
  return true;
}

// The skinned rest shape, for this step.
void fall_back(const CollisionAsset& asset, std::uint32_t muscle, CollisionWork& work) {
  for (std::uint32_t s = asset.first_section[muscle]; s < asset.first_section[muscle + 1]; ++s) {
    const CollisionSection& section = asset.sections[s];
    work.a[s] = work.driven[s];
    std::copy_n(&work.wanted[section.first_radius], section.count, &work.radii[section.first_radius]);
  }
}

void store(const CollisionWork& work, const BoneMatrices& bones, MuscleCollision& collision, ActionLines& lines,
           CrossSections& sections) {
  const CollisionAsset& asset = *collision.asset;
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const CollisionSection& section = asset.sections[s];
    const std::uint32_t slot = section.slot;
    lines.x[slot] = work.a[s].x;
    lines.y[slot] = work.a[s].y;
    lines.z[slot] = work.a[s].z;
    const glm::vec3 offset = (work.a[s] - work.driven[s]) * glm::mat3(bones.world[section.bone]);
    if (work.mobility[s] > 0.0f) {
      collision.offset_x[slot] = offset.x;
      collision.offset_y[slot] = offset.y;
      collision.offset_z[slot] = offset.z;
    }
    const float* radii = &work.radii[section.first_radius];
    std::copy_n(radii, section.count, &collision.radii[section.first_radius]);
    std::copy_n(radii, section.count, &sections.radii[section.first_radius]);
    collision.area[s] = section_area(std::span(radii, section.count));
    collision.target_area[s] = work.area_target[s];
  }
}

// The solve works on all muscles at once: its time goes to each by the contacts that it took part in.
void share_cost(const CostRow& row, std::int64_t ns, const MuscleCollision& collision) {
  float contacts = 0.0f;
  for (const float cost : collision.cost) contacts += cost;
  if (contacts == 0.0f) return row.add_whole(ns);
  for (std::uint32_t m = 0; m < collision.cost.size(); ++m) {
    row.add(m, static_cast<std::int64_t>(static_cast<float>(ns) * collision.cost[m] / contacts));
  }
}

// Settings that no longer ask for collision: the shape at rest, once, and whatever touched has ended.
void release(MuscleCollision& collision, MuscleContacts& contacts, CrossSections& sections) {
  contacts.began.clear();
  contacts.ended.clear();
  std::swap(contacts.now, contacts.ended);
  if (collision.asset == nullptr) return;
  std::fill(collision.depth.begin(), collision.depth.end(), 0.0f);
  std::fill(collision.cost.begin(), collision.cost.end(), 0.0f);
  collision.contact_count = 0;
  if (sections.radii.size() == collision.rest_radii.size()) sections.radii = collision.rest_radii;
  collision.asset = nullptr;
}

}  // namespace

void solve_muscles(ecs::View<const Musculature, MuscleCollision, MuscleContacts, ActionLines, CrossSections> musculatures,
                   ecs::View<const BoneMatrices> characters, ecs::Resource<const FrameTime> time,
                   ecs::Resource<const CollisionScratch> scratch, ecs::Resource<const CostLedger> ledger) {
  const SystemCosts costs = ledger->system("solve_muscles");
  const auto solve = [&](ecs::Entity entity, const Musculature& musculature, MuscleCollision& collision,
                         MuscleContacts& contacts, ActionLines& lines, CrossSections& sections) {
    const CostRow row = costs.row(entity);
    const std::int64_t start = row ? monotonic_ns() : 0;
    const BoneMatrices* bones = characters.try_get<const BoneMatrices>(musculature.character);
    if (!collision.settings.enabled) return release(collision, contacts, sections);
    if (collision.settings.mode == CollisionMode::kLegacy || !has_bones(*musculature.asset, bones)) return;
    carry_deformation(musculature, collision);
    if (collision.asset == nullptr || bones->world.size() < collision.asset->bone_count) return;
    const CollisionScratch::Loan loan(*scratch);
    CollisionWork& work = *loan;
    const CollisionAsset& asset = *collision.asset;
    work.overflow = false;
    load(musculature, collision, *bones, lines, sections, work);
    const float amount = settle(*bones, time->step, collision);
    solve_collision(asset, collision.settings, bones->world, time->step, work);
    blend(asset, collision, *bones, amount, work);
    for (std::uint32_t m = 0; m < asset.muscles->size(); ++m) {
      if (is_sound(asset, work, m)) continue;
      fall_back(asset, m, work);
      ++collision.fallbacks;
      collision.still = 0.0f;
    }
    store(work, *bones, collision, lines, sections);
    if (time->step > 0.0f) report_contacts(asset, work, collision, contacts);
    if (row) share_cost(row, monotonic_ns() - start, collision);
  };
  ecs::each_in_parallel(musculatures, 1, solve);
}

}  // namespace fascicle::muscle
