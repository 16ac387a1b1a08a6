#include "modules/muscle/asset/lay_out_muscles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "modules/muscle/asset/surface_topology.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle {
namespace {

std::uint32_t round_up(std::uint32_t value, std::uint32_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

std::uint32_t find_circle(std::uint32_t count, MuscleAsset& asset) {
  for (std::uint32_t i = 0; i < asset.circle_tables.size(); ++i) {
    if (asset.circle_tables[i].section_vertices == count) return i;
  }
  CircleTable table{.section_vertices = count, .cosines = {}, .sines = {}};
  for (std::uint32_t i = 0; i < count + 2 * kLanes; ++i) {  // from theta_{-kLanes} on
    const double angle = 2.0 * 3.14159265358979323846 * ((i + kLanes * (count - 1)) % count) / count;
    table.cosines.push_back(static_cast<float>(std::cos(angle)));
    table.sines.push_back(static_cast<float>(std::sin(angle)));
  }
  asset.circle_tables.push_back(std::move(table));
  return static_cast<std::uint32_t>(asset.circle_tables.size() - 1);
}

// Rest length and tendons (1.4).
void measure_rest(const MuscleDescription& description, std::span<const glm::mat4> bones, MuscleLayout& muscle) {
  double length = 0.0;
  for (std::size_t i = 1; i < description.attachments.size(); ++i) {
    length += glm::distance(rest_place(description.attachments[i - 1], bones),
                            rest_place(description.attachments[i], bones));
  }
  const HillParameters& hill = description.hill;
  const double source_length = description.source_length > 0.0f ? double{description.source_length} : length;
  const double l_r = double{hill.tendon_slack_length} +
                     double{hill.optimal_fibre_length} * std::cos(double{hill.pennation});
  const double l_rs = l_r * length / source_length;
  const double l_tss = l_r > 0.0 ? l_rs * double{hill.tendon_slack_length} / l_r : 0.0;
  muscle.rest_length = static_cast<float>(length);
  muscle.source_length = static_cast<float>(source_length);
  muscle.source_rest_length = static_cast<float>(l_r);
  muscle.scaled_rest_length = static_cast<float>(l_rs);
  muscle.scaled_tendon_slack_length = static_cast<float>(l_tss);
  muscle.tendon_lengths = {static_cast<float>(l_tss * double{description.tendon_at_origin}),
                           static_cast<float>(l_tss * double{description.tendon_at_insertion})};
  for (std::size_t end = 0; end < 2; ++end) muscle.tendon_drawn[end] = muscle.tendon_lengths[end] > 0.0f;
}

// Sorted by section count, longest first, so that a block's lanes end at about the same row.
void assign_lanes(MuscleAsset& asset) {
  std::vector<std::uint32_t> order(asset.muscles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return asset.muscles[a].section_count > asset.muscles[b].section_count;
  });
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const std::uint32_t lane = i % kLanes;
    MuscleLayout& muscle = asset.muscles[order[i]];
    if (lane == 0) {
      LaneBlock block;
      std::fill(std::begin(block.muscles), std::end(block.muscles), -1);
      block.first_slot = asset.slot_count;
      block.height = muscle.section_count;
      asset.slot_count += kLanes * block.height;
      asset.blocks.push_back(block);
    }
    LaneBlock& block = asset.blocks.back();
    block.counts[lane] = static_cast<std::int32_t>(muscle.section_count);
    block.muscles[lane] = static_cast<std::int32_t>(order[i]);
    muscle.first_slot = block.first_slot + lane;
    muscle.lane_index = i;
  }
  asset.lane_count = kLanes * static_cast<std::uint32_t>(asset.blocks.size());
  for (AlignedVector<float>& lengths : asset.tendon_lengths) lengths.assign(asset.lane_count, 0.0f);
  for (const MuscleLayout& muscle : asset.muscles) {
    for (std::size_t end = 0; end < 2; ++end) asset.tendon_lengths[end][muscle.lane_index] = muscle.tendon_lengths[end];
  }
}

// The weights and the weighted place in one bone's frame.
void bind(float weight, const AttachmentDescription& attachment, const glm::vec3& displacement,
          std::span<const glm::mat4> bones, float to[4]) {
  glm::dvec3 place = attachment.position;
  if (displacement != glm::vec3(0.0f)) {  // p = a + R^-1 mu
    const glm::dmat3 turn{glm::dmat4(bones[static_cast<std::size_t>(attachment.bone)])};
    place += glm::inverse(turn) * glm::dvec3(displacement);
  }
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(double{weight} * place[i]);
  to[3] = weight;
}

}  // namespace

glm::dvec3 rest_place(const AttachmentDescription& attachment, std::span<const glm::mat4> bones) {
  return glm::dvec3(glm::dmat4(bones[static_cast<std::size_t>(attachment.bone)]) *
                    glm::dvec4(attachment.position, 1.0));
}

void lay_out_muscles(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                     MuscleAsset& asset) {
  asset.radius_count = kLanes;  // kernels read one number before a row
  for (const MuscleDescription& description : descriptions) {
    MuscleLayout muscle;
    muscle.name = description.name;
    muscle.hill = description.hill;
    muscle.specific_tension =
        description.specific_tension > 0.0f ? description.specific_tension : kDefaultSpecificTension;
    muscle.subdivision = description.longitudinal_subdivision;
    muscle.attachment_count = static_cast<std::uint32_t>(description.attachments.size());
    muscle.section_vertices = description.section_vertices;
    muscle.section_count = ((muscle.attachment_count - 1) << muscle.subdivision) + 1;
    measure_rest(description, rest_bones, muscle);

    std::uint32_t extras = 0;
    for (std::uint32_t i = 1; i + 1 < muscle.attachment_count; ++i) extras += description.attachments[i].counts ? 0 : 1;
    muscle.counted_sections = ((muscle.attachment_count - 1 - extras) << muscle.subdivision) + 1;
    muscle.counted_vertices = muscle.counted_sections * muscle.section_vertices + 2;

    muscle.first_radius = asset.radius_count;
    muscle.radius_stride = round_up(muscle.section_vertices, 8);
    asset.radius_count += muscle.radius_stride * muscle.section_count;
    muscle.first_row = asset.row_count;
    muscle.row_count = muscle.section_count + (muscle.tendon_drawn[0] ? 1 : 0) + (muscle.tendon_drawn[1] ? 1 : 0);
    asset.row_count += muscle.row_count;
    muscle.first_vertex = asset.vertex_count;
    muscle.vertex_count = muscle.row_count * muscle.section_vertices + 2;
    asset.vertex_count += muscle.vertex_count;
    muscle.circle = find_circle(muscle.section_vertices, asset);

    muscle.first_strip_index = static_cast<std::uint32_t>(asset.strip_indices.size());
    append_strips(muscle, asset.strip_indices);
    muscle.strip_index_count = static_cast<std::uint32_t>(asset.strip_indices.size()) - muscle.first_strip_index;
    muscle.first_fan_index = static_cast<std::uint32_t>(asset.fan_indices.size());
    append_fans(muscle, asset.fan_indices);
    muscle.fan_index_count = static_cast<std::uint32_t>(asset.fan_indices.size()) - muscle.first_fan_index;
    const std::uint32_t index = static_cast<std::uint32_t>(asset.muscles.size());
    asset.row_muscles.insert(asset.row_muscles.end(), muscle.row_count, index);
    for (std::uint32_t row = 0; row < muscle.row_count; ++row) {
      asset.vertex_rows.insert(asset.vertex_rows.end(), muscle.section_vertices, muscle.first_row + row);
    }
    asset.vertex_rows.push_back(muscle.first_row);
    asset.vertex_rows.push_back(muscle.first_row + muscle.row_count - 1);
    asset.muscles.push_back(std::move(muscle));
  }
  for (const CircleTable& table : asset.circle_tables) {
    asset.circles.push_back({table.cosines.data() + kLanes, table.sines.data() + kLanes});
  }
  assign_lanes(asset);
}

void bind_points(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                 std::span<const MuscleFit> fits, MuscleAsset& asset) {
  std::vector<PointBinding> single, blended;
  for (std::uint32_t m = 0; m < descriptions.size(); ++m) {
    const std::vector<AttachmentDescription>& attachments = descriptions[m].attachments;
    MuscleLayout& muscle = asset.muscles[m];
    const std::uint32_t steps = 1u << muscle.subdivision;
    const bool displaced = !fits.empty() && !fits[m].displacements.empty();
    for (const AttachmentDescription& attachment : attachments) {
      asset.bone_count = std::max(asset.bone_count, static_cast<std::uint32_t>(attachment.bone) + 1);
    }
    for (std::uint32_t k = 0; k < muscle.section_count; ++k) {
      const AttachmentDescription& from = attachments[k / steps];
      const glm::vec3 displacement = displaced ? fits[m].displacements[k] : glm::vec3(0.0f);
      PointBinding binding;
      binding.slot = muscle.first_slot + kLanes * k;
      binding.muscle = m;
      binding.first_bone = binding.second_bone = static_cast<std::uint32_t>(from.bone);
      if (k % steps == 0) {
        bind(1.0f, from, displacement, rest_bones, binding.first);
        single.push_back(binding);
        continue;
      }
      const AttachmentDescription& to = attachments[k / steps + 1];
      const float s = static_cast<float>(k % steps) / static_cast<float>(steps);
      if (from.bone == to.bone) {  // between two points of one bone lies a point of that bone
        const AttachmentDescription between{
            .bone = from.bone, .position = from.position + s * (to.position - from.position), .counts = true};
        bind(1.0f, between, displacement, rest_bones, binding.first);
        single.push_back(binding);
        continue;
      }
      binding.second_bone = static_cast<std::uint32_t>(to.bone);
      bind(1.0f - s, from, displacement, rest_bones, binding.first);
      bind(s, to, displacement, rest_bones, binding.second);
      blended.push_back(binding);
    }
    // The functional length must see neither the fit's displacement nor what collision moves, which is anything but
    // the ends.
    muscle.first_attachment_slot = muscle.first_slot;
    muscle.attachment_slot_step = kLanes << muscle.subdivision;
    if (displaced || attachments.size() > 2) {
      muscle.first_attachment_slot = asset.slot_count;
      muscle.attachment_slot_step = 1;
      for (const AttachmentDescription& attachment : attachments) {
        PointBinding binding;
        binding.slot = asset.slot_count++;
        binding.muscle = m;
        binding.first_bone = binding.second_bone = static_cast<std::uint32_t>(attachment.bone);
        bind(1.0f, attachment, glm::vec3(0.0f), rest_bones, binding.first);
        single.push_back(binding);
      }
    }
  }
  asset.single_point_count = static_cast<std::uint32_t>(single.size());
  asset.points = std::move(single);
  asset.points.insert(asset.points.end(), blended.begin(), blended.end());

  for (AlignedVector<float>* axis : {&asset.rest_x, &asset.rest_y, &asset.rest_z}) axis->assign(asset.slot_count, 0.0f);
  PlacePointsJob job;
  job.bones = rest_bones.empty() ? nullptr : &rest_bones[0][0][0];
  job.points = asset.points.data();
  job.single_count = asset.single_point_count;
  job.count = asset.points.size();
  job.x = asset.rest_x.data();
  job.y = asset.rest_y.data();
  job.z = asset.rest_z.data();
  mtu_kernels(SimdLevel::kPortable).place_points(job);
}

}  // namespace fascicle::muscle
