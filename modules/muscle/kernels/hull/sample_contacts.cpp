#include "modules/muscle/kernels/hull/sample_contacts.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

#include "modules/muscle/kernels/surface/way_into_bone.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::uint8_t kMostOfCluster = 8;  // contacts
constexpr float kNear = 0.003f;             // m beyond the contact distance

glm::vec3 apply(const glm::mat4& m, const glm::vec3& p) { return glm::vec3(m * glm::vec4(p, 1.0f)); }

// `from` and `to`: a sample before and after its move, in the bone's frame.
bool touches(const SurfaceBone& bone, const glm::vec3& from, const glm::vec3& to, float distance,
             SampleContact& contact) {
  FieldValue value = bone.field->at(to);
  if (!(value.distance < distance + kNear)) return false;
  contact.need = distance - value.distance;
  if (value.distance < -kShallow * bone.field->voxel() && bone.field->distance(from) >= distance) {
    const glm::vec3 through = way_in(*bone.field, from, to, distance);
    value = bone.field->at(through);
    contact.need = glm::dot(value.gradient, through - to);
  }
  if (value.gradient == glm::vec3(0.0f)) return false;  // in the bone's middle: no way is the shortest
  contact.normal = glm::normalize(glm::mat3(bone.from_bone) * value.gradient);
  return true;
}

}  // namespace

void find_contacts(const HullProblem& problem, HullRow before, HullScratch& scratch, HullState& state) {
  state.contacts.clear();
  if (!problem.step.settings.collide_with_bones) return;
  const HullSamples& samples = problem.hull.samples;
  const std::size_t balls = (state.samples.size() + kBallVertices - 1) / kBallVertices;
  for (std::size_t i = 0; i < balls; ++i) {
    const std::size_t first = i * kBallVertices, count = std::min(kBallVertices, state.samples.size() - first);
    scratch.balls[i] = ball_about(HullRow(state.samples).subspan(first, count));
  }
  const float distance = problem.step.settings.contact_distance;
  for (std::uint32_t b = 0; b < scratch.bones.size(); ++b) {
    const SurfaceBone& bone = scratch.bones[b];
    if (bone.field == nullptr) continue;
    const std::size_t near =
        find_near_bone(bone, std::span(scratch.balls).first(balls), state.samples, distance + kNear, scratch.near);
    for (const std::uint32_t sample : std::span(scratch.near).first(near)) {
      const glm::vec3 from = before.empty() ? apply(problem.step.rest_to_bone[b],
                                                    place(problem.step.asset->rest[samples.vertices[sample]]))
                                            : apply(bone.to_bone, place(before[sample]));
      SampleContact contact{.sample = sample, .bone = b};
      if (touches(bone, from, apply(bone.to_bone, place(state.samples[sample])), distance, contact)) {
        state.contacts.push_back(contact);
      }
    }
  }
  std::ranges::sort(state.contacts, [](const SampleContact& a, const SampleContact& b) {
    if (a.need != b.need) return a.need > b.need;
    return a.bone != b.bone ? a.bone < b.bone : a.sample < b.sample;
  });
  std::ranges::fill(scratch.taken, std::uint8_t{0});
  std::size_t kept = 0;
  for (const SampleContact& contact : state.contacts) {
    std::uint8_t& taken = scratch.taken[samples.cluster[contact.sample]];
    if (taken == kMostOfCluster || kept == kMostContacts) continue;
    ++taken;
    state.contacts[kept++] = contact;
  }
  state.contacts.resize(kept);
}

}  // namespace fascicle::muscle
