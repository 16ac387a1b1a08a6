#include "engine/animation/clip.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace fascicle {
namespace {

constexpr float kMinLength = 1e-12f;  // below this a blended quaternion has no direction

// The two keys around a time, and where it lies between them.
struct KeySpan {
  std::uint32_t before = 0;
  std::uint32_t after = 0;
  float fraction = 0.0f;  // 0..1
  float seconds = 0.0f;   // between the keys
};

KeySpan find_keys(std::span<const float> times, float time) {
  const auto last = static_cast<std::uint32_t>(times.size() - 1);
  // The first key later than `time`; a key exactly at `time` therefore holds already, as STEP demands.
  const auto later = static_cast<std::uint32_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (later == 0) return {0, 0, 0.0f, 0.0f};
  if (later > last) return {last, last, 0.0f, 0.0f};
  const float seconds = times[later] - times[later - 1];  // > 0: the later key's time is above the earlier's
  return {later - 1, later, (time - times[later - 1]) / seconds, seconds};
}

glm::quat to_quat(const glm::vec4& v) { return {v.w, v.x, v.y, v.z}; }

// glTF 2.0 appendix C: Hermite spline with tangents given per second.
glm::vec4 interpolate_cubic(std::span<const glm::vec4> values, const KeySpan& keys) {
  const glm::vec4& value = values[3 * std::size_t{keys.before} + 1];
  if (keys.before == keys.after) return value;
  const glm::vec4& out_tangent = values[3 * std::size_t{keys.before} + 2];
  const glm::vec4& in_tangent = values[3 * std::size_t{keys.after}];
  const glm::vec4& next = values[3 * std::size_t{keys.after} + 1];
  const float t = keys.fraction;
  const float t2 = t * t;
  const float t3 = t2 * t;
  return (2.0f * t3 - 3.0f * t2 + 1.0f) * value + keys.seconds * (t3 - 2.0f * t2 + t) * out_tangent +
         (-2.0f * t3 + 3.0f * t2) * next + keys.seconds * (t3 - t2) * in_tangent;
}

glm::quat interpolate_rotation(const ClipChannel& channel, std::span<const glm::vec4> values, const KeySpan& keys) {
  if (channel.interpolation == ClipInterpolation::kCubicSpline) {
    const glm::quat blended = to_quat(interpolate_cubic(values, keys));
    const float length = glm::length(blended);
    // Tangents can carry the spline through zero or beyond the range of float; then the key before holds.
    if (!(length > kMinLength && std::isfinite(length))) return to_quat(values[3 * std::size_t{keys.before} + 1]);
    return blended / length;
  }
  const glm::quat before = to_quat(values[keys.before]);
  if (channel.interpolation == ClipInterpolation::kStep || keys.before == keys.after) return before;
  return glm::normalize(glm::slerp(before, to_quat(values[keys.after]), keys.fraction));  // the short way round
}

glm::vec3 interpolate_vector(const ClipChannel& channel, std::span<const glm::vec4> values, const KeySpan& keys) {
  if (channel.interpolation == ClipInterpolation::kCubicSpline) {
    const glm::vec3 value(interpolate_cubic(values, keys));
    const bool finite = std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z);
    return finite ? value : glm::vec3(values[3 * std::size_t{keys.before} + 1]);
  }
  const glm::vec3 before(values[keys.before]);
  if (channel.interpolation == ClipInterpolation::kStep || keys.before == keys.after) return before;
  return glm::mix(before, glm::vec3(values[keys.after]), keys.fraction);
}

}  // namespace

void sample_clip(const Clip& clip, float time, std::span<Trs> pose) {
  if (!std::isfinite(time)) time = clip.start;
  for (const ClipChannel& channel : clip.channels) {
    if (channel.bone < 0 || static_cast<std::size_t>(channel.bone) >= pose.size() || channel.key_count == 0) continue;
    const std::size_t values_per_key = channel.interpolation == ClipInterpolation::kCubicSpline ? 3 : 1;
    const std::span times = std::span(clip.times).subspan(channel.first_key, channel.key_count);
    const std::span values = std::span(clip.values).subspan(channel.first_value, channel.key_count * values_per_key);
    const KeySpan keys = find_keys(times, time);
    Trs& bone = pose[static_cast<std::size_t>(channel.bone)];
    switch (channel.target) {
      case ClipTarget::kTranslation:
        bone.translation = interpolate_vector(channel, values, keys);
        break;
      case ClipTarget::kRotation:
        bone.rotation = interpolate_rotation(channel, values, keys);
        break;
      case ClipTarget::kScale:
        bone.scale = interpolate_vector(channel, values, keys);
        break;
    }
  }
}

float wrap_clip_time(const Clip& clip, float time, bool loop) {
  const float duration = clip.duration();
  if (!(duration > 0.0f) || !std::isfinite(time)) return 0.0f;
  if (!loop) return std::clamp(time, 0.0f, duration);
  if (time >= 0.0f && time < duration) return time;
  const float wrapped = std::fmod(time, duration);
  // Adding the duration to a tiny negative rest rounds up to the duration itself, which is the start again.
  const float positive = wrapped < 0.0f ? wrapped + duration : wrapped;
  return positive < duration ? positive : 0.0f;
}

}  // namespace fascicle
