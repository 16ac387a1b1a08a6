#include "modules/muscle/asset/check_descriptions.hpp"

#include <cmath>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "modules/muscle/asset/muscle_limits.hpp"
#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kClosestAttachments = 1.0e-5f;  // m
// m, the ball around the cube of kPositionRange, and a hair for rounding on the way from space to space.
constexpr float kFarthestAttachment = 1.7321f * static_cast<float>(kPositionRange.max);

constexpr std::uint32_t kMostSubdivisions = static_cast<std::uint32_t>(kSubdivisionRange.max);

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Adds the faults of one description to `found`.
class Checker {
 public:
  Checker(const MuscleDescription& description, std::span<const glm::mat4> bones, Diagnostics& found)
      : description_(description), bones_(bones), found_(found) {}

  void check(const MuscleFit* fit) {
    check_attachments();
    check_level();
    check_hill();
    check_tendon();
    check_profile();
    check_radius_source(fit);
    if (fit != nullptr) check_fit(*fit);
  }

 private:
  void fault(const std::string& field, std::string cause, std::string remedy) {
    found_.errors.push_back(fault_of(description_, field, std::move(cause), std::move(remedy)));
  }

  std::string attachment_field(std::size_t i) const {
    if (i == 0) return "origin";
    if (i + 1 == description_.attachments.size()) return "insertion";
    return fmt::format("via/{}", i - 1);
  }

  // In the rest space.
  glm::vec3 place(const AttachmentDescription& attachment) const {
    return glm::vec3(bones_[static_cast<std::size_t>(attachment.bone)] * glm::vec4(attachment.position, 1.0f));
  }

  void check_attachments() {
    const auto& attachments = description_.attachments;
    if (attachments.size() < 2) {
      fault("origin", fmt::format("{} attachments", attachments.size()), "a muscle needs an origin and an insertion");
      return;
    }
    if (attachments.size() > kMostViaPoints + 2) {
      fault("via", fmt::format("{} via points", attachments.size() - 2), fmt::format("at most {}", kMostViaPoints));
    }
    bool placed = true;
    for (std::size_t i = 0; i < attachments.size(); ++i) {
      const AttachmentDescription& attachment = attachments[i];
      if (attachment.bone < 0 || static_cast<std::size_t>(attachment.bone) >= bones_.size()) {
        fault(attachment_field(i) + "/bone", fmt::format("bone {} does not exist", attachment.bone),
              fmt::format("the skeleton has bones 0 to {}", static_cast<long>(bones_.size()) - 1));
        placed = false;
        continue;
      }
      if (!is_finite(attachment.position)) {
        fault(attachment_field(i) + "/position", "the position is not finite", "give three numbers in metres");
        placed = false;
      } else if (!(glm::length(attachment.position) <= kFarthestAttachment ||
                   glm::length(place(attachment)) <= kFarthestAttachment)) {
        // A file gives positions in either space, and bones may be scaled: one of the two must be sane.
        fault(attachment_field(i) + "/position",
              fmt::format("the position is {:.4g} m from its bone", glm::length(attachment.position)),
              fmt::format("positions are in metres, in the bone's frame, each of the three from {:g} to {:g}",
                          kPositionRange.min, kPositionRange.max));
        placed = false;
      }
    }
    if (!placed) return;
    for (std::size_t i = 1; i < attachments.size(); ++i) {
      const float distance = glm::distance(place(attachments[i - 1]), place(attachments[i]));
      if (!(distance > kClosestAttachments)) {
        fault(attachment_field(i) + "/position",
              fmt::format("it is at the same place as the {} ({:.3g} m apart at rest)",
                          i == 1 ? "origin" : "via point before it", distance),
              "move one of them or leave it out");
      }
    }
  }

  void check_level() {
    const std::uint32_t count = description_.section_vertices;
    if (!lies_in(count, kSectionVerticesRange) || count % 2 != 0) {
      fault("section_vertices", fmt::format("|C| is {}", count),
            fmt::format("an even number from {:g} to {:g}, so that every vertex has an opposite",
                        kSectionVerticesRange.min, kSectionVerticesRange.max));
    }
    if (description_.longitudinal_subdivision > kMostSubdivisions) {
      fault("longitudinal_subdivision", fmt::format("it is {}", description_.longitudinal_subdivision),
            fmt::format("a number from 0 to {}", kMostSubdivisions));
    }
  }

  void check_number(const std::string& field, double value, const NumberRange& range, const char* unit) {
    if (lies_in(value, range)) return;
    fault(field, fmt::format("it is {:g}", value),
          fmt::format("a number {} {:g} {} {:g} {}", range.above_min ? "above" : "from", range.min,
                      range.above_min ? "and at most" : "to", range.max, unit));
  }
  // As check_number, with 0 for what is not known.
  void check_figure(const std::string& field, double value, const NumberRange& range, const char* unit) {
    if (value != 0.0) check_number(field, value, range, unit);
  }

  void check_hill() {
    const HillParameters& hill = description_.hill;
    check_number("max_isometric_force", hill.max_isometric_force, kForceRange, "N");
    check_figure("optimal_fibre_length", hill.optimal_fibre_length, kFibreLengthRange, "m");
    check_number("tendon_slack_length", hill.tendon_slack_length, kTendonLengthRange, "m");
    if (!(hill.pennation >= 0.0f && hill.pennation < kRightAngle)) {
      fault("pennation", fmt::format("it is {:g}", hill.pennation), "radians, at least 0 and less than pi/2 = 1.5708");
    }
    check_figure("source_length", description_.source_length, kSourceLengthRange, "m");
    check_figure("specific_tension", description_.specific_tension, kSpecificTensionRange, "N/m^2");
    if (description_.pcsa) check_number("pcsa", *description_.pcsa, kPcsaRange, "m^2");
    if (description_.volume) check_number("volume", *description_.volume, kVolumeRange, "m^3");
  }

  void check_tendon() {
    check_number("tendon/origin", description_.tendon_at_origin, kFractionRange, "(a fraction)");
    check_number("tendon/insertion", description_.tendon_at_insertion, kFractionRange, "(a fraction)");
    const float sum = description_.tendon_at_origin + description_.tendon_at_insertion;
    if (sum > 1.0f) {
      fault("tendon", fmt::format("the fractions sum to {}", sum), "origin and insertion together at most 1");
    }
  }

  void check_profile() {
    const RadiusProfile& profile = description_.profile;
    if (profile.fractions.size() != profile.radii.size()) {
      fault("profile", fmt::format("{} fractions but {} radii", profile.fractions.size(), profile.radii.size()),
            "as many of one as of the other");
      return;
    }
    const std::size_t points = profile.fractions.size();
    if (points != 0 && (points < kFewestProfilePoints || points > kMostProfilePoints)) {
      fault("profile/fractions", fmt::format("{} points", points),
            fmt::format("from {} to {}, or none", kFewestProfilePoints, kMostProfilePoints));
    }
    float largest = profile.radii.empty() ? 1.0f : 0.0f;
    for (std::size_t i = 0; i < profile.fractions.size(); ++i) {
      const float fraction = profile.fractions[i];
      if (!lies_in(fraction, kFractionRange) || (i > 0 && fraction <= profile.fractions[i - 1])) {
        fault(fmt::format("profile/fractions/{}", i), fmt::format("it is {}", fraction),
              "fractions rise from 0 (origin) to 1 (insertion)");
      }
      check_number(fmt::format("profile/radii/{}", i), profile.radii[i],
                   profile.absolute ? kRadiusRange : kRelativeRadiusRange, profile.absolute ? "m" : "(relative)");
      largest = std::max(largest, profile.radii[i]);
    }
    if (!(largest > 0.0f)) fault("profile/radii", "all are zero", "at least one above zero");
  }

  void check_radius_source(const MuscleFit* fit) {
    if (fit != nullptr && !fit->radii.empty()) return;
    const std::optional<MissingThickness> missing = find_missing_thickness(description_);
    if (missing) fault("", missing->cause, missing->remedy);
  }

  void check_fit(const MuscleFit& fit) {
    if (description_.attachments.size() < 2 || description_.longitudinal_subdivision > kMostSubdivisions) return;
    const std::size_t sections =
        ((description_.attachments.size() - 1) << description_.longitudinal_subdivision) + 1;
    const std::size_t radii = sections * description_.section_vertices;
    if (!fit.displacements.empty() && fit.displacements.size() != sections) {
      fault("", fmt::format("its fit has {} displacements", fit.displacements.size()),
            fmt::format("one per section: {}", sections));
    }
    if (!fit.radii.empty() && fit.radii.size() != radii) {
      fault("", fmt::format("its fit has {} radii", fit.radii.size()), fmt::format("|C| per section: {}", radii));
    }
    for (const glm::vec3& displacement : fit.displacements) {
      if (!is_finite(displacement)) {
        fault("", "its fit has a displacement that is not finite", "fit it again");
        break;
      }
    }
    for (const std::optional<glm::vec3>& normal : fit.end_normals) {
      if (normal && !(std::abs(glm::length(*normal) - 1.0f) < 1.0e-3f)) {
        fault("", "its fit has an end's normal that is not of unit length", "fit it again");
      }
    }
    for (const float radius : fit.radii) {
      if (!(std::abs(radius) <= static_cast<float>(kRadiusRange.max))) {
        fault("", fmt::format("its fit has a radius of {} m", radius), "fit it again");
        break;
      }
    }
  }

  const MuscleDescription& description_;
  std::span<const glm::mat4> bones_;
  Diagnostics& found_;
};

// A fault that belongs to no description.
Diagnostic make_fault(std::string path, std::string cause, std::string remedy) {
  Diagnostic fault;
  fault.path = std::move(path);
  fault.cause = std::move(cause);
  fault.remedy = std::move(remedy);
  return fault;
}

void check_bone(std::size_t index, const glm::mat4& bone, Diagnostics& found) {
  bool finite = true;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) finite = finite && std::abs(bone[c][r]) <= kLargestBoneEntry;
  }
  const std::string cause = !finite ? "its rest matrix is not finite"
                            : std::abs(glm::determinant(glm::dmat3(glm::dmat4(bone)))) < 1.0e-12
                                ? "its rest matrix is singular"
                                : "";
  if (!cause.empty()) {
    found.errors.push_back(make_fault(fmt::format("bone {}", index), cause, "correct the skeleton"));
  }
}

}  // namespace

Diagnostic fault_of(const MuscleDescription& description, const std::string& field, std::string cause,
                    std::string remedy) {
  Diagnostic fault = description.where;
  if (fault.path.empty()) fault.path = fmt::format("muscle '{}'", description.name);
  if (!field.empty()) fault.path += "/" + field;
  fault.cause = std::move(cause);
  fault.remedy = std::move(remedy);
  return fault;
}

std::optional<MissingThickness> find_missing_thickness(const MuscleDescription& description) {
  // In the order in which they are used: see MuscleDescription.
  if (!description.pcsa) {
    if (description.volume || (description.profile.absolute && !description.profile.radii.empty())) return std::nullopt;
    if (description.hill.max_isometric_force == 0.0f) {
      return MissingThickness{"nothing says how thick the muscle is",
                              "give max_isometric_force (N), pcsa (m^2), volume (m^3) or a profile with absolute radii "
                              "(m)"};
    }
  }
  if (description.hill.optimal_fibre_length != 0.0f) return std::nullopt;
  return MissingThickness{"the belly's volume follows from its cross section and its fibre length, which is missing",
                          "give optimal_fibre_length (m), or volume (m^3) without pcsa"};
}

Diagnostics check_rest_bones(std::span<const glm::mat4> rest_bones) {
  Diagnostics found;
  for (std::size_t i = 0; i < rest_bones.size(); ++i) check_bone(i, rest_bones[i], found);
  return found;
}

Diagnostics check_description(const MuscleDescription& description, std::span<const glm::mat4> rest_bones,
                              const MuscleFit* fit) {
  Diagnostics found;
  if (description.name.empty()) {
    found.errors.push_back(fault_of(description, "name", "a muscle has no name", "give it one"));
  }
  Checker(description, rest_bones, found).check(fit);
  return found;
}

Diagnostics check_descriptions(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                               std::span<const MuscleFit> fits) {
  Diagnostics found = check_rest_bones(rest_bones);
  if (!found.ok()) return found;
  if (!fits.empty() && fits.size() != descriptions.size()) {
    found.errors.push_back(make_fault("fits", fmt::format("{} fits for {} muscles", fits.size(), descriptions.size()),
                                      "none, or one per muscle"));
    return found;
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    const MuscleDescription& description = descriptions[i];
    if (!description.name.empty() && !names.insert(description.name).second) {
      found.errors.push_back(fault_of(description, "name", fmt::format("'{}' occurs twice", description.name),
                                      "give each muscle a name of its own"));
    }
    found.append(check_description(description, rest_bones, fits.empty() ? nullptr : &fits[i]));
  }
  return found;
}

}  // namespace fascicle::muscle
