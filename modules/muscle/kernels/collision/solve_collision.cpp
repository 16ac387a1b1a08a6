#include "modules/muscle/kernels/collision/solve_collision.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/kernels/collision/bone_contacts.hpp"
#include "modules/muscle/kernels/collision/keep_sides.hpp"
#include "modules/muscle/kernels/collision/muscle_contacts.hpp"
#include "modules/muscle/kernels/collision/place_samples.hpp"
#include "modules/muscle/kernels/inflate_section.hpp"

namespace fascicle::muscle {
namespace {

// Of the samples' spacing, which is what tells an elephant from a mouse:
constexpr float kReach = 0.2f;            // contacts are found this far ahead of a step
constexpr float kMostPush = 0.125f;       // of a contact in a substep: it knows no more than its neighbourhood
constexpr float kRadiusPull = 0.2f, kLinePull = 4.0f;  // of the times to the shape at rest
constexpr float kHolds = 0.0002f;         // m: nearer than this a contact keeps its radii from growing
constexpr float kHoldingLever = 0.1f;     // of a contact on a radius
constexpr float kLargestInflation = 1.25f;  // in one round

// How much of the way to its goal something with a time constant goes in a substep: implicit Euler, so never too far.
float approach(float step, float time) { return step / (step + std::max(time, 1.0e-5f)); }

// Within what it may be: neither turned inside out nor drawn out into a spike. What a contact cannot get from it, the
// centre has to give.
void move_radius(std::uint32_t i, float by, CollisionWork& work) {
  work.radii[i] = std::clamp(work.radii[i] + by, work.least[i], work.most[i]);
}

void move_sample(const Contact& contact, float push, CollisionWork& work) {
  for (std::uint32_t k = 0; k < 2; ++k) {
    if (contact.weight[k] == 0.0f) continue;
    const std::uint32_t section = contact.section + k;
    const float mobility = work.mobility[section];
    if (mobility == 0.0f) continue;
    work.a[section] += (mobility * contact.weight[k] * push) * contact.normal;
    for (std::uint32_t j = 2 * k; j < 2 * k + 2; ++j) move_radius(contact.radius[j], contact.lever[j] * push, work);
  }
  if (contact.bone >= 0) return;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::uint32_t section = contact.other_section + k;
    const float mobility = work.mobility[section];
    if (mobility == 0.0f) continue;
    work.a[section] -= (mobility * contact.other_weight[k] * push) * contact.normal;
    for (std::uint32_t j = 2 * k; j < 2 * k + 2; ++j) {
      move_radius(contact.other_radius[j], contact.other_lever[j] * push, work);
    }
  }
}

void hold_radii(const Contact& contact, CollisionWork& work) {
  for (std::uint32_t j = 0; j < 4; ++j) {
    if (std::abs(contact.lever[j]) > kHoldingLever) work.pressed[contact.radius[j]] = 1;
  }
  if (contact.bone >= 0) return;
  for (std::uint32_t j = 0; j < 4; ++j) {
    if (std::abs(contact.other_lever[j]) > kHoldingLever) work.pressed[contact.other_radius[j]] = 1;
  }
}

}  // namespace

float contact_value(const Contact& contact, const CollisionWork& work) {
  const std::uint32_t s = contact.section, next = contact.weight[1] > 0.0f ? s + 1 : s;
  float value = contact.weight[0] * glm::dot(contact.normal, work.a[s]) +
                contact.weight[1] * glm::dot(contact.normal, work.a[next]) - contact.base;
  for (std::uint32_t j = 0; j < 4; ++j) value += contact.lever[j] * work.radii[contact.radius[j]];
  if (contact.bone >= 0) return value;
  const std::uint32_t o = contact.other_section;
  value -= contact.other_weight[0] * glm::dot(contact.normal, work.a[o]) +
           contact.other_weight[1] * glm::dot(contact.normal, work.a[o + 1]);
  for (std::uint32_t j = 0; j < 4; ++j) value += contact.other_lever[j] * work.radii[contact.other_radius[j]];
  return value;
}

void relax_shape(const CollisionAsset& asset, const CollisionSettings& settings, float step, CollisionWork& work) {
  const float line = approach(step, settings.line_time), via = approach(step, settings.via_time);
  const float shape = approach(step, settings.shape_time);
  // Neighbours' pull, by its own time: at a half about a fifth of the time that a radius takes to come back.
  const float stiffness = settings.smoothing / std::max(1.0f - settings.smoothing, 0.01f);
  const float smooth = stiffness > 0.0f ? approach(step, kRadiusPull * settings.shape_time / stiffness) : 0.0f;
  const float straighten = stiffness > 0.0f ? approach(step, kLinePull * settings.line_time / stiffness) : 0.0f;
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const CollisionSection& section = asset.sections[s];
    float* radii = &work.radii[section.first_radius];
    const float* wanted = &work.wanted[section.first_radius];
    if (section.end) {
      work.a[s] = work.driven[s];
      continue;
    }
    // Neighbours pull a displacement towards their mean; what lies along the line goes first (even spacing).
    glm::vec3 offset = work.a[s] - work.driven[s];
    const glm::vec3 mean = 0.5f * ((work.a[s - 1] - work.driven[s - 1]) + (work.a[s + 1] - work.driven[s + 1]));
    offset += straighten * (mean - offset);
    offset *= 1.0f - (section.via ? via : line);
    offset -= approach(step, settings.via_time) * glm::dot(offset, work.t[s]) * work.t[s];
    work.a[s] = work.driven[s] + offset;
    // Of the radii too: an outline is smooth where nothing presses it.
    const std::uint32_t count = section.count;
    const float first = radii[0] - wanted[0];
    float before = radii[count - 1] - wanted[count - 1], here = first;
    for (std::uint32_t i = 0; i < count; ++i) {
      const float next = i + 1 < count ? radii[i + 1] - wanted[i + 1] : first;
      const float smoothed = here + smooth * (0.5f * (before + next) - here);
      before = here;
      here = next;
      radii[i] = wanted[i] + (1.0f - shape) * smoothed;
    }
  }
}

void find_contacts(const CollisionAsset& asset, const CollisionSettings& settings, std::span<const glm::mat4> bones,
                   CollisionWork& work, bool at_rest) {
  work.contacts.clear();
  place_samples(asset, work);
  const float reach = kReach * settings.sample_spacing;
  find_bone_contacts(asset, bones, settings.bone_margin, reach, work);
  fill_grid(asset, work);
  find_muscle_contacts(asset, settings.muscle_margin, reach, at_rest, work);
}

void project_contacts(CollisionWork& work) {
  for (Contact& contact : work.contacts) {
    contact.value = contact_value(contact, work);
    const float wanted = contact.push - (contact.value - contact.bias) * contact.inverse_mass;
    const float push = std::max(wanted, 0.0f);
    if (push != contact.push) move_sample(contact, push - contact.push, work);
    contact.push = push;
  }
}

void hold_areas(const CollisionAsset& asset, CollisionWork& work) {
  std::fill(work.pressed.begin(), work.pressed.end(), std::uint8_t{0});
  for (const Contact& contact : work.contacts) {
    if (contact.push > 0.0f || contact.value < kHolds) hold_radii(contact, work);
  }
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const CollisionSection& section = asset.sections[s];
    if (section.end) continue;
    const std::span<float> radii(&work.radii[section.first_radius], section.count);
    const std::span<const std::uint8_t> pressed(&work.pressed[section.first_radius], section.count);
    const InflateOutcome outcome = inflate_section(radii, pressed, work.area_target[s], kLargestInflation);
    // Where few are free they would have to stand out like spikes: no further than radii may be.
    bool beyond = false;
    for (std::uint32_t i = 0; i < section.count; ++i) {
      const float most = work.most[section.first_radius + i];
      beyond = beyond || radii[i] > most;
      radii[i] = std::min(radii[i], most);
    }
    if (outcome.kind == Inflation::kReached && !beyond) continue;
    // Nothing is free, or too little: all radii take their share, and the contacts move a_k.
    const float area = section_area(radii);
    if (!(area > 0.0f)) continue;
    const float scale = std::clamp(std::sqrt(work.area_target[s] / area), 0.8f, kLargestInflation);
    for (float& r : radii) r *= scale;
  }
}

void begin_substep(const CollisionAsset& asset, const CollisionSettings& settings, std::span<const glm::mat4> bones,
                   bool refresh, CollisionWork& work) {
  if (refresh) refresh_bone_contacts(asset, bones, settings.bone_margin, work);
  for (Contact& contact : work.contacts) {
    contact.value = contact_value(contact, work);
    contact.bias = std::min(contact.value + kMostPush * settings.sample_spacing, 0.0f);
    contact.push = 0.0f;
  }
}

void solve_collision(const CollisionAsset& asset, const CollisionSettings& settings, std::span<const glm::mat4> bones,
                     float step, CollisionWork& work) {
  work.contacts.clear();
  if (!(step > 0.0f)) return;
  place_directions(asset, work);
  recall_strayed(asset, bones, work);
  hold_transversals(asset, bones, work);
  find_contacts(asset, settings, bones, work);
  const float substep = step / static_cast<float>(settings.substeps);
  for (std::uint32_t i = 0; i < settings.substeps; ++i) {
    relax_shape(asset, settings, substep, work);
    begin_substep(asset, settings, bones, i > 0, work);
    for (std::uint32_t k = 0; k < settings.iterations; ++k) {
      hold_areas(asset, work);
      project_contacts(work);
    }
    hold_areas(asset, work);
  }
}

}  // namespace fascicle::muscle
