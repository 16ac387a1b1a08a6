#include "modules/muscle/asset/surface/carry_weights.hpp"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/surface/harmonic_field.hpp"

namespace fascicle::muscle {
namespace {

// The four largest of a vertex' shares, which sum to 1. Squared before: a harmonic field is steepest beside a small
// attachment, where edges would stretch most; its square is flat there.
CarryWeights largest_shares(std::span<const float> fields, std::size_t vertex, std::size_t vertices) {
  CarryWeights result;
  for (std::size_t c = 0; c * vertices < fields.size(); ++c) {
    const float value = glm::clamp(fields[c * vertices + vertex], 0.0f, 1.0f);
    const float share = value * value;
    std::size_t place = 4;
    while (place > 0 && result.weight[place - 1] < share) --place;
    if (place == 4) continue;
    for (std::size_t i = 3; i > place; --i) {
      result.weight[i] = result.weight[i - 1];
      result.carrier[i] = result.carrier[i - 1];
    }
    result.weight[place] = share;
    result.carrier[place] = static_cast<std::uint16_t>(c);
  }
  const float sum = result.weight[0] + result.weight[1] + result.weight[2] + result.weight[3];
  for (float& weight : result.weight) weight = sum > 0.0f ? weight / sum : 0.0f;
  return result;
}

}  // namespace

Result<Carriage> carry_by_bones(std::span<const glm::vec3> positions, std::span<const std::uint32_t> triangles,
                                std::span<const std::int32_t> attachment_of,
                                std::span<const SurfaceAttachmentAsset> attachments, std::int32_t frame_bone) {
  Carriage carriage;
  std::vector<std::size_t> carrier_of;  // by attachment
  for (const SurfaceAttachmentAsset& attachment : attachments) {
    const auto known = std::find_if(carriage.carriers.begin(), carriage.carriers.end(),
                                    [&](const SurfaceCarrier& carrier) { return carrier.bone == attachment.bone; });
    carrier_of.push_back(static_cast<std::size_t>(known - carriage.carriers.begin()));
    if (known == carriage.carriers.end()) carriage.carriers.push_back({.bone = attachment.bone});
  }
  const bool still = std::all_of(carriage.carriers.begin(), carriage.carriers.end(),
                                 [&](const SurfaceCarrier& carrier) { return carrier.bone == frame_bone; });
  if (still) return Carriage{};

  const std::size_t vertices = positions.size();
  std::vector<std::uint8_t> fixed(vertices, 0);
  std::vector<float> fields(carriage.carriers.size() * vertices, 0.0f);
  for (std::size_t v = 0; v < vertices; ++v) {
    if (attachment_of[v] < 0) continue;
    fixed[v] = 1;
    fields[carrier_of[static_cast<std::size_t>(attachment_of[v])] * vertices + v] = 1.0f;
  }
  if (carriage.carriers.size() == 1) {
    std::fill(fields.begin(), fields.end(), 1.0f);
  } else {
    Result<std::vector<float>> solved = solve_harmonic(positions, triangles, fixed, fields);
    if (!solved) return solved.diagnostics();
    fields = std::move(*solved);
  }
  carriage.weights.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v) carriage.weights.push_back(largest_shares(fields, v, vertices));
  return carriage;
}

Carriage carry_by_sections(std::span<const glm::vec3> positions, const MuscleAsset& muscles, std::uint32_t muscle) {
  const MuscleLayout& layout = muscles.muscles[muscle];
  Carriage carriage;
  std::vector<glm::vec3> line;
  for (std::uint32_t s = 0; s < layout.section_count; ++s) {
    carriage.carriers.push_back({.section = static_cast<float>(s) / static_cast<float>(1u << layout.subdivision)});
    line.push_back(rest_point(muscles, muscle, s));
  }
  for (const glm::vec3& p : positions) {
    float nearest = std::numeric_limits<float>::max();
    CarryWeights weights;
    for (std::size_t s = 0; s + 1 < line.size(); ++s) {
      const glm::vec3 along = line[s + 1] - line[s];
      const float square = glm::dot(along, along);
      const float f = square > 0.0f ? glm::clamp(glm::dot(p - line[s], along) / square, 0.0f, 1.0f) : 0.0f;
      const float distance = glm::distance(p, line[s] + f * along);
      if (!(distance < nearest)) continue;
      nearest = distance;
      weights.carrier = {static_cast<std::uint16_t>(s), static_cast<std::uint16_t>(s + 1), 0, 0};
      weights.weight = {1.0f - f, f, 0.0f, 0.0f};
    }
    carriage.weights.push_back(weights);
  }
  return carriage;
}

}  // namespace fascicle::muscle
