#include "modules/muscle/asset/rest_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "modules/muscle/asset/check_descriptions.hpp"
#include "modules/muscle/asset/rest_reference.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kTendonThickness = 0.3f;  // of the belly's, in the default spindle
constexpr float kShortestBelly = 1.0e-4f;  // m

// The state that the kernels write, at rest.
struct RestState {
  AlignedVector<float> ux, uy, uz, vx, vy, vz, arc, twist;
  std::array<AlignedVector<std::int32_t>, 2> segment;
  std::array<AlignedVector<float>, 2> fraction, border;
  std::vector<float> volumes;

  explicit RestState(const MuscleAsset& asset) {
    for (AlignedVector<float>* array : {&ux, &uy, &uz, &vx, &vy, &vz, &arc}) array->assign(asset.slot_count, 0.0f);
    twist.assign(asset.lane_count, 0.0f);
    for (std::size_t end = 0; end < 2; ++end) {
      segment[end].assign(asset.lane_count, 0);
      fraction[end].assign(asset.lane_count, 0.0f);
      border[end].assign(asset.lane_count, 0.0f);
    }
    volumes.assign(asset.size(), 0.0f);
  }
};

void build_rest_frames(const MuscleAsset& asset, std::span<const glm::mat4> rest_bones, RestState& state) {
  BuildFramesJob job;
  job.bones = rest_bones.empty() ? nullptr : &rest_bones[0][0][0];
  job.blocks = asset.blocks.data();
  job.block_count = asset.blocks.size();
  job.ends = asset.ends.data();
  job.restart_twist = true;
  job.x = asset.rest_x.data();
  job.y = asset.rest_y.data();
  job.z = asset.rest_z.data();
  job.ux = state.ux.data();
  job.uy = state.uy.data();
  job.uz = state.uz.data();
  job.vx = state.vx.data();
  job.vy = state.vy.data();
  job.vz = state.vz.data();
  job.arc = state.arc.data();
  job.twist = state.twist.data();
  mtu_kernels(SimdLevel::kPortable).build_frames(job);
}

glm::dmat3 turn_of(std::int32_t bone, std::span<const glm::mat4> rest_bones) {
  return glm::dmat3(glm::dmat4(rest_bones[static_cast<std::size_t>(bone)]));
}

void set_end(const glm::dvec3& tangent, const glm::dvec3& reference, std::int32_t bone,
             std::span<const glm::mat4> rest_bones, bool fixed, EndFrame& end) {
  const glm::dmat3 to_bone = glm::inverse(turn_of(bone, rest_bones));
  const glm::dvec3 t = to_bone * tangent, u = to_bone * reference;
  for (int i = 0; i < 3; ++i) {
    end.tangent[i] = static_cast<float>(t[i]);
    end.reference[i] = static_cast<float>(u[i]);
  }
  end.tangent[3] = end.reference[3] = 0.0f;
  end.bone = static_cast<std::uint32_t>(bone);
  end.fixed = fixed ? 1 : 0;
}

// Of an end section that an attachment area turns, else along the line.
std::optional<glm::dvec3> fixed_normal(std::span<const MuscleFit> fits, std::uint32_t m, MuscleEnd end) {
  if (fits.empty() || !fits[m].end_normals[static_cast<std::size_t>(end)]) return std::nullopt;
  return glm::normalize(glm::dvec3(*fits[m].end_normals[static_cast<std::size_t>(end)]));
}

// The end frames. What the untwisted frame at the insertion is, the frame kernel knows best: it runs once with a
// stand-in there, whose twist is then taken back.
void set_end_frames(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                    std::span<const MuscleFit> fits, MuscleAsset& asset, RestState& state) {
  asset.ends.assign(std::size_t{2} * asset.lane_count, EndFrame{});
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const MuscleLayout& muscle = asset.muscles[m];
    const std::uint32_t last = muscle.section_count - 1;
    const auto along = [&](std::uint32_t from, std::uint32_t to) {
      return glm::normalize(glm::dvec3(rest_point(asset, m, to)) - glm::dvec3(rest_point(asset, m, from)));
    };
    const auto first_normal = fixed_normal(fits, m, MuscleEnd::kOrigin);
    const auto last_normal = fixed_normal(fits, m, MuscleEnd::kInsertion);
    const glm::dvec3 start = first_normal.value_or(along(0, 1)), finish = last_normal.value_or(along(last - 1, last));
    EndFrame* ends = &asset.ends[std::size_t{2} * muscle.lane_index];
    const std::int32_t origin = descriptions[m].attachments.front().bone;
    const std::int32_t insertion = descriptions[m].attachments.back().bone;
    set_end(start, rest_reference(turn_of(origin, rest_bones), start), origin, rest_bones, first_normal.has_value(),
            ends[0]);
    set_end(finish, rest_reference(turn_of(insertion, rest_bones), finish), insertion, rest_bones,
            last_normal.has_value(), ends[1]);
  }
  build_rest_frames(asset, rest_bones, state);
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const MuscleLayout& muscle = asset.muscles[m];
    const std::uint32_t slot = asset.slot(m, muscle.section_count - 1);
    const glm::dvec3 u(state.ux[slot], state.uy[slot], state.uz[slot]);
    const glm::dvec3 v(state.vx[slot], state.vy[slot], state.vz[slot]);
    const double twist = double{state.twist[muscle.lane_index]};
    EndFrame& end = asset.ends[std::size_t{2} * muscle.lane_index + 1];
    set_end(glm::cross(u, v), std::cos(twist) * u - std::sin(twist) * v, descriptions[m].attachments.back().bone,
            rest_bones, end.fixed != 0, end);
  }
  build_rest_frames(asset, rest_bones, state);
}

void find_rest_tendons(const MuscleAsset& asset, RestState& state) {
  FindTendonsJob job;
  job.blocks = asset.blocks.data();
  job.block_count = asset.blocks.size();
  job.origin_lengths = asset.tendon_lengths[0].data();
  job.insertion_lengths = asset.tendon_lengths[1].data();
  job.arc = state.arc.data();
  for (std::size_t end = 0; end < 2; ++end) {
    job.segment[end] = state.segment[end].data();
    job.fraction[end] = state.fraction[end].data();
    job.border_arc[end] = state.border[end].data();
  }
  mtu_kernels(SimdLevel::kPortable).find_tendons(job);
}

void measure_rest_volumes(const MuscleAsset& asset, RestState& state) {
  MeasureVolumeJob job;
  SectionsView& view = job.sections;
  view.layouts = asset.layouts.data();
  view.muscle_count = asset.size();
  view.circles = asset.circles.data();
  view.x = asset.rest_x.data();
  view.y = asset.rest_y.data();
  view.z = asset.rest_z.data();
  view.ux = state.ux.data();
  view.uy = state.uy.data();
  view.uz = state.uz.data();
  view.vx = state.vx.data();
  view.vy = state.vy.data();
  view.vz = state.vz.data();
  view.radii = asset.rest_radii.data();
  for (std::size_t end = 0; end < 2; ++end) {
    view.segment[end] = state.segment[end].data();
    view.fraction[end] = state.fraction[end].data();
  }
  job.volumes = state.volumes.data();
  mtu_kernels(SimdLevel::kPortable).measure_volume(job);
}

float evaluate_profile(const RadiusProfile& profile, float fraction) {
  const auto above = std::upper_bound(profile.fractions.begin(), profile.fractions.end(), fraction);
  const std::size_t i = static_cast<std::size_t>(above - profile.fractions.begin());
  if (i == 0) return profile.radii.front();
  if (i == profile.fractions.size()) return profile.radii.back();
  const float s = (fraction - profile.fractions[i - 1]) / (profile.fractions[i] - profile.fractions[i - 1]);
  return profile.radii[i - 1] + s * (profile.radii[i] - profile.radii[i - 1]);
}

// Thin along the tendons, a half wave along the belly.
float evaluate_spindle(float arc, float belly_start, float belly_end) {
  if (belly_end - belly_start < kShortestBelly) return kTendonThickness;
  const float place = std::clamp((arc - belly_start) / (belly_end - belly_start), 0.0f, 1.0f);
  return kTendonThickness + (1.0f - kTendonThickness) * std::sin(3.14159265f * place);
}

// The volume that the belly must have (1.6 turned round), or nothing where the radii are given in metres.
std::optional<double> wanted_volume(const MuscleDescription& description, const MuscleLayout& muscle,
                                    const MuscleFit* fit) {
  if (fit != nullptr && !fit->radii.empty()) return std::nullopt;
  const double fibre_length = double{muscle.hill.optimal_fibre_length} / std::cos(double{muscle.hill.pennation});
  if (description.pcsa) return double{*description.pcsa} * fibre_length;
  if (description.volume) return double{*description.volume};
  if (description.profile.absolute && !description.profile.radii.empty()) return std::nullopt;
  return double{muscle.hill.max_isometric_force} / double{muscle.specific_tension} * fibre_length;
}

// Before scaling: relative radii, radii in metres, or the fit's.
void set_radii(const MuscleDescription& description, const MuscleFit* fit, const MuscleLayout& muscle,
               const RestState& state, AlignedVector<float>& radii) {
  const std::uint32_t count = muscle.section_vertices;
  const float total = state.arc[muscle.first_slot + kLanes * (muscle.section_count - 1)];
  const float start = state.border[0][muscle.lane_index], end = state.border[1][muscle.lane_index];
  for (std::uint32_t k = 0; k < muscle.section_count; ++k) {
    const float arc = state.arc[muscle.first_slot + kLanes * k];
    const float radius = description.profile.radii.empty() ? evaluate_spindle(arc, start, end)
                                                           : evaluate_profile(description.profile, arc / total);
    for (std::uint32_t i = 0; i < muscle.radius_stride; ++i) {
      const bool fitted = fit != nullptr && !fit->radii.empty();
      radii[muscle.first_radius + muscle.radius_stride * k + i] =
          fitted ? fit->radii[std::size_t{count} * k + i % count] : radius;
    }
  }
}

}  // namespace

Diagnostics shape_rest(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                       std::span<const MuscleFit> fits, MuscleAsset& asset) {
  Diagnostics found;
  RestState state(asset);
  set_end_frames(descriptions, rest_bones, fits, asset, state);
  find_rest_tendons(asset, state);

  asset.rest_radii.assign(asset.radius_count + kLanes, 0.0f);
  std::vector<std::optional<double>> wanted(asset.size());
  const auto scale = [&](const MuscleLayout& muscle, double factor) {
    float* radii = &asset.rest_radii[muscle.first_radius];
    for (std::uint32_t i = 0; i < muscle.radius_stride * muscle.section_count; ++i) {
      radii[i] = static_cast<float>(double{radii[i]} * factor);
    }
  };
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const MuscleLayout& muscle = asset.muscles[m];
    const MuscleFit* fit = fits.empty() ? nullptr : &fits[m];
    set_radii(descriptions[m], fit, muscle, state, asset.rest_radii);
    wanted[m] = wanted_volume(descriptions[m], muscle, fit);
    const float belly = state.border[1][muscle.lane_index] - state.border[0][muscle.lane_index];
    if (!wanted[m]) continue;
    if (belly < kShortestBelly) {
      found.errors.push_back(fault_of(
          descriptions[m], "tendon",
          fmt::format("the drawn tendons ({:.4g} m) leave no belly on a line of {:.4g} m",
                      muscle.tendon_lengths[0] + muscle.tendon_lengths[1], muscle.rest_length),
          "lower the tendon fractions or tendon_slack_length, or give source_length"));
      wanted[m].reset();
      continue;
    }
    // A first guess: a cylinder.
    float widest = 0.0f;
    for (std::uint32_t i = 0; i < muscle.radius_stride * muscle.section_count; ++i) {
      widest = std::max(widest, asset.rest_radii[muscle.first_radius + i]);
    }
    scale(muscle, std::sqrt(*wanted[m] / (3.14159 * double{belly})) / double{widest});
  }
  if (!found.ok()) return found;

  // The volume is a quadratic in the common scale of the radii, plus a cubic part where the line bends: taking the
  // square root of the ratio again and again settles within a few rounds.
  for (int round = 0; round < 12; ++round) {
    measure_rest_volumes(asset, state);
    for (std::uint32_t m = 0; m < asset.size(); ++m) {
      if (!wanted[m] || !(state.volumes[m] > 0.0f)) continue;
      scale(asset.muscles[m], std::sqrt(*wanted[m] / double{state.volumes[m]}));
    }
  }
  measure_rest_volumes(asset, state);
  asset.rest_ux = state.ux;
  asset.rest_uy = state.uy;
  asset.rest_uz = state.uz;
  asset.rest_vx = state.vx;
  asset.rest_vy = state.vy;
  asset.rest_vz = state.vz;
  asset.rest_arc = state.arc;
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    asset.muscles[m].rest_volume = state.volumes[m];
    if (wanted[m] && std::abs(double{state.volumes[m]} - *wanted[m]) > 1.0e-3 * *wanted[m]) {
      found.errors.push_back(fault_of(
          descriptions[m], "volume",
          fmt::format("no radii give a belly of {:.4g} m^3; the nearest has {:.4g} m^3", *wanted[m], state.volumes[m]),
          "lower the volume, or straighten the line where it bends back on itself"));
    }
  }
  return found;
}

}  // namespace fascicle::muscle
