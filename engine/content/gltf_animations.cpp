// Animations become clips with flat key arrays.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include <glm/geometric.hpp>

#include "engine/content/gltf_accessors.hpp"
#include "engine/content/gltf_source.hpp"

namespace fascicle::detail {
namespace {

constexpr float kUnitTolerance = 0.05f;  // quantised keys are off by less
constexpr float kMinLength = 1e-6f;

class AnimationReader {
 public:
  AnimationReader(GltfSource& source, const GltfFile& file, std::size_t index)
      : source_(source),
        file_(file),
        from_(source.model.animations[index]),
        path_(fmt::format("/animations/{}", index)) {}

  Clip read(std::string name) {
    clip_.name = std::move(name);
    for (std::size_t c = 0; c < from_.channels.size(); ++c)
      read_channel(from_.channels[c], fmt::format("{}/channels/{}", path_, c));
    bool first = true;
    for (const ClipChannel& channel : clip_.channels) {
      const float start = clip_.times[channel.first_key], end = clip_.times[channel.first_key + channel.key_count - 1];
      clip_.start = first ? start : std::min(clip_.start, start);
      clip_.end = first ? end : std::max(clip_.end, end);
      first = false;
    }
    return std::move(clip_);
  }

 private:
  struct Keys {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  void read_channel(const tinygltf::AnimationChannel& from, const std::string& path) {
    ClipChannel channel;
    if (from.target_path == "translation") {
      channel.target = ClipTarget::kTranslation;
    } else if (from.target_path == "rotation") {
      channel.target = ClipTarget::kRotation;
    } else if (from.target_path == "scale") {
      channel.target = ClipTarget::kScale;
    } else {
      source_.warning(path + "/target/path", fmt::format("'{}' is left out", from.target_path),
                      "translation, rotation and scale are read");
      return;
    }
    channel.bone = file_.node_bones[static_cast<std::size_t>(from.target_node)];
    if (!targets_.emplace(channel.bone, channel.target).second) {
      source_.error(
          path + "/target",
          fmt::format("the {} of node {} is moved by another channel already", from.target_path, from.target_node),
          "remove one of them");
      return;
    }
    if (static_cast<std::size_t>(from.sampler) >= from_.samplers.size()) {
      source_.error(path + "/sampler", fmt::format("{} is not an index into samplers", from.sampler),
                    fmt::format("there are {}, counted from 0", from_.samplers.size()));
      return;
    }
    const tinygltf::AnimationSampler& sampler = from_.samplers[static_cast<std::size_t>(from.sampler)];
    const std::string sampler_path = fmt::format("{}/samplers/{}", path_, from.sampler);
    channel.interpolation = sampler.interpolation == "STEP"          ? ClipInterpolation::kStep
                            : sampler.interpolation == "CUBICSPLINE" ? ClipInterpolation::kCubicSpline
                                                                     : ClipInterpolation::kLinear;
    const std::optional<Keys> keys = read_keys(sampler.input, sampler_path + "/input");
    if (!keys) return;
    channel.first_key = keys->first;
    channel.key_count = keys->count;
    channel.first_value = static_cast<std::uint32_t>(clip_.values.size());
    if (read_values(channel, sampler.output, sampler_path + "/output")) clip_.channels.push_back(channel);
  }

  // Channels that share their times in the file share them here.
  std::optional<Keys> read_keys(int accessor, const std::string& use) {
    if (const auto known = keys_.find(accessor); known != keys_.end()) return known->second;
    std::vector<float> times;
    const auto count = read_float_accessor(source_, accessor, 1, use, times);
    if (!count) return std::nullopt;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] >= 0.0f && (i == 0 || times[i] > times[i - 1])) continue;
      source_.error(
          fmt::format("/accessors/{}", accessor),
          fmt::format("time {} is {} s{}", i, times[i], i == 0 ? "" : fmt::format(", after {} s", times[i - 1])),
          "times of keys are not negative and rise");
      return std::nullopt;
    }
    const Keys keys{static_cast<std::uint32_t>(clip_.times.size()), static_cast<std::uint32_t>(times.size())};
    clip_.times.insert(clip_.times.end(), times.begin(), times.end());
    keys_.emplace(accessor, keys);
    return keys;
  }

  bool read_values(const ClipChannel& channel, int accessor, const std::string& use) {
    const bool rotation = channel.target == ClipTarget::kRotation;
    const bool cubic = channel.interpolation == ClipInterpolation::kCubicSpline;
    const std::size_t width = rotation ? 4 : 3;
    std::vector<float> numbers;
    const auto count = read_float_accessor(source_, accessor, static_cast<int>(width), use, numbers);
    if (!count) return false;
    const std::size_t wanted = std::size_t{channel.key_count} * (cubic ? 3 : 1);
    if (*count != wanted) {
      source_.error(use, fmt::format("{} values for {} keys", *count, channel.key_count),
                    fmt::format("store {}", wanted));
      return false;
    }
    for (std::size_t i = 0; i < wanted; ++i) {
      glm::vec4 value(0.0f);
      for (std::size_t c = 0; c < width; ++c) value[static_cast<int>(c)] = numbers[width * i + c];
      if (rotation && (!cubic || i % 3 == 1)) {
        const float length = glm::length(value);
        if (!(length > kMinLength && std::isfinite(length))) {
          source_.error(fmt::format("/accessors/{}", accessor),
                        fmt::format("element {} is a quaternion of length {}", i, length), "store unit quaternions");
          return false;
        }
        if (std::abs(length - 1.0f) > kUnitTolerance && !warned_) {
          source_.warning(fmt::format("/accessors/{}", accessor),
                          fmt::format("element {} is a quaternion of length {:.4g}, made unit", i, length),
                          "store unit quaternions");
          warned_ = true;
        }
        value /= length;
      }
      clip_.values.push_back(value);
    }
    return true;
  }

  GltfSource& source_;
  const GltfFile& file_;
  const tinygltf::Animation& from_;
  std::string path_;
  Clip clip_;
  std::map<int, Keys> keys_;
  std::set<std::pair<std::int32_t, ClipTarget>> targets_;
  bool warned_ = false;
};

}  // namespace

void convert_animations(GltfSource& source, GltfFile& out) {
  UniqueNames names;
  for (std::size_t a = 0; a < source.model.animations.size(); ++a) {
    std::string name = names.take(source.model.animations[a].name, fmt::format("animation_{}", a));
    Clip clip = AnimationReader(source, out, a).read(std::move(name));
    if (!source.ok()) continue;
    if (clip.channels.empty()) {
      source.warning(fmt::format("/animations/{}", a), "no channel moves a node; the animation is left out",
                     "export it again");
      continue;
    }
    out.clips.push_back(std::move(clip));
  }
}

}  // namespace fascicle::detail
