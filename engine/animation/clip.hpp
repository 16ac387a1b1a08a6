// An animation clip, immutable and shared: key frames of bone translations, rotations and scales in flat arrays.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "engine/animation/skeleton.hpp"

namespace fascicle {

enum class ClipTarget : std::uint8_t { kTranslation, kRotation, kScale };
enum class ClipInterpolation : std::uint8_t { kStep, kLinear, kCubicSpline };

// Keys first_key .. first_key + key_count of Clip::times, at least one, rising. Values first_value ... of Clip::values,
// one a key, or for cubic splines three: in-tangent, value, out-tangent (glTF 2.0, appendix C).
struct ClipChannel {
  std::int32_t bone = -1;
  ClipTarget target = ClipTarget::kTranslation;
  ClipInterpolation interpolation = ClipInterpolation::kLinear;
  std::uint32_t first_key = 0;
  std::uint32_t key_count = 0;
  std::uint32_t first_value = 0;
};

struct Clip {
  std::string name;
  float start = 0.0f;  // s, the first key of all channels
  float end = 0.0f;    // s, the last
  std::vector<ClipChannel> channels;
  std::vector<float> times;       // s
  std::vector<glm::vec4> values;  // xyz for translation (m) and scale; xyzw, unit, for rotation

  float duration() const { return end - start; }
};

// Writes the clip's pose at `time` (s, on the clip's own axis from start to end; outside the nearest key holds) to the
// bones that it moves and leaves the others alone. Rotations come out unit. Channels of bones outside `pose` are left
// out.
void sample_clip(const Clip& clip, float time, std::span<Trs> pose);

// `time` (s since the clip's start) brought into [0, duration]: wrapped around where `loop`, else clamped.
float wrap_clip_time(const Clip& clip, float time, bool loop);

}  // namespace fascicle
