// A lower body made of numbers, for tests and benchmarks that must not depend on content: 7 bones and 48 muscles with
// 48 via points (0 to 5 a muscle, as the method's set has them), so that table 3's counts come out. Poses are a walk.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>

#include "modules/muscle/asset/muscle_description.hpp"

namespace fascicle::test {

enum SyntheticBone : std::int32_t { kPelvis, kFemurLeft, kTibiaLeft, kFootLeft, kFemurRight, kTibiaRight, kFootRight };
inline constexpr std::size_t kSyntheticBones = 7;

// Bone to world, with hip, knee and ankle flexed by the angles (rad) and the pelvis at `place`.
inline std::vector<glm::mat4> pose_bones(float hip_left, float knee_left, float ankle_left, float hip_right,
                                         float knee_right, float ankle_right, glm::vec3 place = {0.0f, 0.95f, 0.0f}) {
  const glm::vec3 side(1.0f, 0.0f, 0.0f);
  const auto joint = [&](const glm::mat4& parent, glm::vec3 offset, float angle) {
    return glm::rotate(glm::translate(parent, offset), angle, side);
  };
  std::vector<glm::mat4> bones(kSyntheticBones, glm::mat4(1.0f));
  bones[kPelvis] = glm::translate(glm::mat4(1.0f), place);
  for (const bool left : {true, false}) {
    const std::size_t first = left ? kFemurLeft : kFemurRight;
    bones[first] = joint(bones[kPelvis], {left ? 0.09f : -0.09f, -0.06f, 0.0f}, left ? -hip_left : -hip_right);
    bones[first + 1] = joint(bones[first], {0.0f, -0.41f, 0.0f}, left ? knee_left : knee_right);
    bones[first + 2] = joint(bones[first + 1], {0.0f, -0.42f, -0.01f}, left ? ankle_left : ankle_right);
  }
  return bones;
}

inline std::vector<glm::mat4> rest_bones() { return pose_bones(0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f); }

// A walk: one cycle a second, walking in +z.
inline std::vector<glm::mat4> walk_bones(float seconds, glm::vec3 start = {0.0f, 0.95f, 0.0f}) {
  const float phase = 6.2831853f * seconds;
  const auto knee = [](float p) { return 0.15f + 0.5f * (1.0f + std::sin(p)); };
  return pose_bones(0.5f * std::sin(phase), knee(phase - 1.0f), 0.2f * std::sin(phase + 1.0f),
                    -0.5f * std::sin(phase), knee(phase + 2.14f), -0.2f * std::sin(phase + 1.0f),
                    start + glm::vec3(0.0f, 0.02f * std::sin(2.0f * phase), 1.2f * seconds));
}

// The 48 muscles, left then right side.
inline std::vector<muscle::MuscleDescription> synthetic_muscles(std::uint32_t section_vertices = 8,
                                                                std::uint32_t subdivision = 1) {
  constexpr std::array<int, 24> kVias = {0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 3, 5};
  const std::vector<glm::mat4> bones = rest_bones();
  std::uint32_t random = 12345;
  const auto next = [&] {  // in [-1, 1)
    random = random * 1664525u + 1013904223u;
    return static_cast<float>(random >> 8) / 8388608.0f - 1.0f;
  };
  std::vector<muscle::MuscleDescription> muscles;
  for (const bool left : {true, false}) {
    random = 12345;
    for (std::size_t m = 0; m < kVias.size(); ++m) {
      muscle::MuscleDescription description;
      description.name = left ? "left_" : "right_";
      description.name += std::to_string(m);
      // From bone to bone down the leg; every third muscle crosses two joints.
      const std::int32_t leg = left ? kFemurLeft : kFemurRight;
      const std::array<std::int32_t, 4> chain = {kPelvis, leg, leg + 1, leg + 2};
      const std::size_t from = m % 3, to = std::min<std::size_t>(from + (m % 3 == 0 ? 2 : 1), 3);
      const float mirror = left ? 1.0f : -1.0f;
      const glm::vec3 start(mirror * (0.09f + 0.05f * next()), 0.95f - 0.43f * static_cast<float>(from) - 0.1f + 0.06f * next(),
                            0.05f * next());
      const glm::vec3 end(mirror * (0.09f + 0.04f * next()), 0.95f - 0.43f * static_cast<float>(to) - 0.12f + 0.06f * next(),
                          0.05f * next());
      const int count = kVias[m] + 2;
      for (int i = 0; i < count; ++i) {
        const float s = static_cast<float>(i) / static_cast<float>(count - 1);
        const std::int32_t bone = chain[from + static_cast<std::size_t>(std::lround(s * static_cast<float>(to - from)))];
        glm::vec3 place = glm::mix(start, end, s);
        if (i > 0 && i + 1 < count) place += glm::vec3(0.015f * next(), 0.01f * next(), 0.03f + 0.01f * next());
        const glm::vec3 local = glm::vec3(glm::inverse(bones[static_cast<std::size_t>(bone)]) * glm::vec4(place, 1.0f));
        description.attachments.push_back({bone, local, true});
      }
      description.hill = {.max_isometric_force = 800.0f + 600.0f * next(),
                          .optimal_fibre_length = 0.1f + 0.04f * next(),
                          .tendon_slack_length = 0.15f + 0.1f * next(),
                          .pennation = 0.15f + 0.15f * next()};
      description.section_vertices = section_vertices;
      description.longitudinal_subdivision = subdivision;
      muscles.push_back(std::move(description));
    }
  }
  return muscles;
}

}  // namespace fascicle::test
