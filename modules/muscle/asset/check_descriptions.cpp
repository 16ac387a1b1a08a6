#include "modules/muscle/asset/check_descriptions.hpp"

#include <cmath>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kFarthestAttachment = 1.0e4f;  // in the bone's units
constexpr float kClosestAttachments = 1.0e-5f;  // m
constexpr float kThickest = 10.0f;              // m, of a radius
constexpr float kStrongest = 1.0e7f;            // N, N/m^2 and the like: nothing larger is meant

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

  void check_attachments() {
    const auto& attachments = description_.attachments;
    if (attachments.size() < 2) {
      fault("origin", fmt::format("{} attachments", attachments.size()), "a muscle needs an origin and an insertion");
      return;
    }
    bool placed = true;
    for (std::size_t i = 0; i < attachments.size(); ++i) {
      const AttachmentDescription& attachment = attachments[i];
      if (attachment.bone < 0 || static_cast<std::size_t>(attachment.bone) >= bones_.size()) {
        fault(attachment_field(i) + "/bone", fmt::format("bone {} does not exist", attachment.bone),
              fmt::format("the skeleton has bones 0 to {}", static_cast<long>(bones_.size()) - 1));
        placed = false;
      }
      if (!is_finite(attachment.position)) {
        fault(attachment_field(i) + "/position", "the position is not finite", "give three numbers in metres");
        placed = false;
      } else if (glm::length(attachment.position) > kFarthestAttachment) {
        fault(attachment_field(i) + "/position",
              fmt::format("the position is {:.4g} m from its bone", glm::length(attachment.position)),
              "positions are in metres, in the bone's frame");
        placed = false;
      }
    }
    if (!placed) return;
    for (std::size_t i = 1; i < attachments.size(); ++i) {
      const auto place = [&](const AttachmentDescription& a) {
        return glm::vec3(bones_[static_cast<std::size_t>(a.bone)] * glm::vec4(a.position, 1.0f));
      };
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
    if (count < 6 || count > kMaxSectionVertices || count % 2 != 0) {
      fault("section_vertices", fmt::format("|C| is {}", count),
            fmt::format("an even number from 6 to {}, so that every vertex has an opposite", kMaxSectionVertices));
    }
    if (description_.longitudinal_subdivision > kMostSubdivisions) {
      fault("longitudinal_subdivision", fmt::format("it is {}", description_.longitudinal_subdivision),
            fmt::format("a number from 0 to {}", kMostSubdivisions));
    }
  }

  // A number that must be finite and lie in [0, largest].
  void check_number(const std::string& field, float value, float largest, const char* unit) {
    if (std::isfinite(value) && value >= 0.0f && value <= largest) return;
    fault(field, fmt::format("it is {}", value), fmt::format("a number from 0 to {:g} {}", largest, unit));
  }

  void check_hill() {
    check_number("max_isometric_force", description_.hill.max_isometric_force, kStrongest, "N");
    check_number("optimal_fibre_length", description_.hill.optimal_fibre_length, 10.0f, "m");
    check_number("tendon_slack_length", description_.hill.tendon_slack_length, 10.0f, "m");
    check_number("pennation", description_.hill.pennation, 1.5f, "rad");
    check_number("source_length", description_.source_length, 10.0f, "m");
    check_number("specific_tension", description_.specific_tension, kStrongest, "N/m^2");
  }

  void check_tendon() {
    check_number("tendon/origin", description_.tendon_at_origin, 1.0f, "(a fraction)");
    check_number("tendon/insertion", description_.tendon_at_insertion, 1.0f, "(a fraction)");
    const float sum = description_.tendon_at_origin + description_.tendon_at_insertion;
    if (sum > 1.0f + 1.0e-6f) {
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
    float largest = profile.radii.empty() ? 1.0f : 0.0f;
    for (std::size_t i = 0; i < profile.fractions.size(); ++i) {
      const float fraction = profile.fractions[i];
      if (!std::isfinite(fraction) || fraction < 0.0f || fraction > 1.0f ||
          (i > 0 && fraction <= profile.fractions[i - 1])) {
        fault(fmt::format("profile/fractions/{}", i), fmt::format("it is {}", fraction),
              "fractions rise from 0 (origin) to 1 (insertion)");
      }
      check_number(fmt::format("profile/radii/{}", i), profile.radii[i], profile.absolute ? kThickest : 1.0e6f,
                   profile.absolute ? "m" : "(relative)");
      largest = std::max(largest, profile.radii[i]);
    }
    if (!(largest > 0.0f)) fault("profile/radii", "all are zero", "at least one above zero");
  }

  void check_radius_source(const MuscleFit* fit) {
    const HillParameters& hill = description_.hill;
    const auto check_positive = [&](const char* field, float value, const char* unit) {
      if (!std::isfinite(value) || value <= 0.0f) {
        fault(field, fmt::format("it is {}", value), fmt::format("a number above 0 {}, or leave it out", unit));
      }
    };
    if (description_.pcsa) check_positive("pcsa", *description_.pcsa, "m^2");
    if (description_.volume) check_positive("volume", *description_.volume, "m^3");
    if (fit != nullptr && !fit->radii.empty()) return;
    if (description_.pcsa) {
      if (!(hill.optimal_fibre_length > 0.0f)) {
        fault("pcsa", "a PCSA without a fibre length does not say how thick the muscle is",
              "give optimal_fibre_length too, or give volume instead");
      }
      return;
    }
    if (description_.volume || (description_.profile.absolute && !description_.profile.radii.empty())) return;
    if (!(hill.max_isometric_force > 0.0f && hill.optimal_fibre_length > 0.0f)) {
      fault("", "nothing says how thick the muscle is",
            "give volume, pcsa, an absolute profile, or max_isometric_force and optimal_fibre_length");
    }
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
    for (const float radius : fit.radii) {
      if (!(std::abs(radius) <= kThickest)) {
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

Diagnostics check_descriptions(std::span<const MuscleDescription> descriptions, std::span<const glm::mat4> rest_bones,
                               std::span<const MuscleFit> fits) {
  Diagnostics found;
  for (std::size_t i = 0; i < rest_bones.size(); ++i) check_bone(i, rest_bones[i], found);
  if (!found.ok()) return found;
  if (!fits.empty() && fits.size() != descriptions.size()) {
    found.errors.push_back(make_fault("fits", fmt::format("{} fits for {} muscles", fits.size(), descriptions.size()),
                                      "none, or one per muscle"));
    return found;
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < descriptions.size(); ++i) {
    const MuscleDescription& description = descriptions[i];
    if (description.name.empty()) {
      found.errors.push_back(fault_of(description, "name", "a muscle has no name", "give it one"));
    } else if (!names.insert(description.name).second) {
      found.errors.push_back(fault_of(description, "name", fmt::format("'{}' occurs twice", description.name),
                                      "give each muscle a name of its own"));
    }
    Checker(description, rest_bones, found).check(fits.empty() ? nullptr : &fits[i]);
  }
  return found;
}

}  // namespace fascicle::muscle
