#include "modules/muscle/systems/4_solve/follow_bones.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include "modules/muscle/systems/4_solve/section_frame.hpp"

namespace fascicle::muscle {
namespace {

// Of a matrix' entry (m, or 1): nearer to the identity than this it is the identity. Matrices that went through a
// skeleton and back are not exactly what they were; a muscle at rest is to stay exactly there.
constexpr double kRounding = 2.0e-6;

glm::mat4 without_rounding(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column) {
    const glm::dvec4 difference = glm::abs(m[column] - glm::dmat4(1.0)[column]);
    if (!glm::all(glm::lessThan(difference, glm::dvec4(kRounding)))) return glm::mat4(m);
  }
  return glm::mat4(1.0f);
}

bool is_finite(const glm::mat4& m) {
  float sum = 0.0f;  // times zero: what is no number stays none
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) sum += 0.0f * m[column][row];
  }
  return sum == 0.0f;
}

bool has_bones(const SurfaceMuscle& muscle, const BoneMatrices* bones) {
  if (bones == nullptr || bones->world.size() < muscle.rest_bones.size()) return false;
  const auto used = std::span(bones->world).first(muscle.rest_bones.size());
  return std::all_of(used.begin(), used.end(), is_finite) &&
         glm::determinant(used[static_cast<std::size_t>(muscle.asset->frame_bone)]) != 0.0f;
}

// Where bones are in the simulation's frame, which goes with the frame bone.
void place_bones(const SurfaceMuscle& muscle, const BoneMatrices& bones, SurfaceState& state) {
  const auto frame_bone = static_cast<std::size_t>(muscle.asset->frame_bone);
  const glm::dmat4 frame =
      glm::dmat4(bones.world[frame_bone]) * glm::inverse(glm::dmat4(muscle.rest_bones[frame_bone]));
  const glm::dmat4 to_frame = glm::inverse(frame);
  state.frame = glm::mat4(frame);
  for (std::size_t b = 0; b < muscle.rest_bones.size(); ++b) {
    if (b == frame_bone) continue;
    state.bones[b] = without_rounding(to_frame * glm::dmat4(bones.world[b]) *
                                      glm::inverse(glm::dmat4(muscle.rest_bones[b])));
  }
}

void advance(RigidMotion& motion, const glm::mat4& to, bool jump) {
  motion.from = jump ? to : motion.to;
  motion.to = to;
}

void follow_carriers(const SurfaceMuscle& muscle, const Drivers& drivers, bool jump, SurfaceState& state) {
  const SurfaceAsset& asset = *muscle.asset;
  for (std::size_t i = 0; i < asset.attachments.size(); ++i) {
    advance(state.attachment_motion[i], state.bones[static_cast<std::size_t>(asset.attachments[i].bone)], jump);
  }
  for (std::size_t i = 0; i < asset.bones.size(); ++i) {
    advance(state.bone_motion[i], state.bones[static_cast<std::size_t>(asset.bones[i])], jump);
  }
  const glm::dmat4 to_frame = glm::inverse(glm::dmat4(state.frame));
  const Musculature* musculature = drivers.try_get<const Musculature>(muscle.musculature);
  for (std::size_t c = 0; c < asset.carriers.size(); ++c) {
    const SurfaceCarrier& carrier = asset.carriers[c];
    if (carrier.bone >= 0) {
      advance(state.carrier_motion[c], state.bones[static_cast<std::size_t>(carrier.bone)], jump);
      continue;
    }
    glm::mat4 to = state.carrier_motion[c].to;  // a driver that is gone leaves it where it was
    if (musculature != nullptr && musculature->attached[muscle.driver] != 0) {
      const MuscleAsset& driver = *musculature->asset;
      const glm::mat4 now = section_frame(driver, *drivers.try_get<const ActionLines>(muscle.musculature),
                                          *drivers.try_get<const CrossSections>(muscle.musculature), muscle.driver,
                                          carrier.section);
      to = without_rounding(to_frame * glm::dmat4(now) *
                            glm::inverse(glm::dmat4(rest_section_frame(driver, muscle.driver, carrier.section))));
    }
    advance(state.carrier_motion[c], to, jump);
  }
}

}  // namespace

Followed follow_bones(const SurfaceMuscle& muscle, const BoneMatrices* bones, const Drivers& drivers,
                      SurfaceState& state) {
  if (!has_bones(muscle, bones)) return Followed::kNothing;
  const bool jump = !state.started || state.teleport_count != bones->teleport_count;
  state.teleport_count = bones->teleport_count;
  state.started = true;
  place_bones(muscle, *bones, state);
  follow_carriers(muscle, drivers, jump, state);
  return jump ? Followed::kJump : Followed::kMovement;
}

SurfaceStep make_surface_step(const SurfaceMuscle& muscle, const SurfaceKernels& kernels, float time,
                              SurfaceState& state) {
  SurfaceStep step{.asset = muscle.asset.get(), .kernels = &kernels, .settings = muscle.settings, .step = time,
                   .attachments = state.attachment_motion, .carriers = state.carrier_motion,
                   .bones = state.bone_motion, .fields = state.fields, .rest_to_bone = state.rest_to_bone,
                   .points = state.points, .velocity = state.velocity};
  step.settings.substeps = std::max(step.settings.substeps, 1u);  // a game may have set anything
  return step;
}

bool keep_sound(const SurfaceStep& step, SurfaceState& state) {
  if (is_sound(*step.asset, state.points, state.volume)) return true;
  state.volume = carry_rest_shape(step, state.scratch);
  ++state.fallbacks;
  return false;
}

void report_touches(const SurfaceMuscle& muscle, const SurfaceState& state, std::span<const BoneTouch> touches,
                    SurfaceContacts& contacts) {
  contacts.now.clear();
  for (std::size_t b = 0; b < muscle.asset->bones.size(); ++b) {
    const BoneTouch& touch = touches[b];
    if (touch.vertices == 0) continue;
    const SurfacePoint& p = state.points[touch.deepest];
    contacts.now.push_back({.bone = muscle.asset->bones[b], .vertices = touch.vertices, .depth = touch.depth,
                            .place = glm::vec3(state.frame * glm::vec4(p.x, p.y, p.z, 1.0f))});
  }
}

}  // namespace fascicle::muscle
