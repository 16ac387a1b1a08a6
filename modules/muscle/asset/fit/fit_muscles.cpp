#include "modules/muscle/asset/fit/fit_muscles.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/ray_scene.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/check_descriptions.hpp"
#include "modules/muscle/asset/fit/check_mesh.hpp"
#include "modules/muscle/asset/fit/end_area.hpp"
#include "modules/muscle/asset/fit/fit_line.hpp"
#include "modules/muscle/asset/fit/head_region.hpp"
#include "modules/muscle/asset/lay_out_muscles.hpp"

namespace fascicle::muscle {
namespace {

// m, in the rest bones' space.
std::vector<glm::dvec3> attachment_points(const MuscleDescription& description, std::span<const glm::mat4> bones) {
  std::vector<glm::dvec3> points;
  for (const AttachmentDescription& attachment : description.attachments) {
    points.push_back(rest_place(attachment, bones));
  }
  return points;
}

// The centres of a muscle's sections before the fit, m.
std::vector<glm::dvec3> section_points(const MuscleDescription& description, std::span<const glm::mat4> bones) {
  const std::size_t steps = std::size_t{1} << description.longitudinal_subdivision;
  const std::vector<glm::dvec3> attachments = attachment_points(description, bones);
  std::vector<glm::dvec3> points{attachments[0]};
  for (std::size_t i = 1; i < attachments.size(); ++i) {
    const glm::dvec3 from = points.back(), to = attachments[i];
    for (std::size_t k = 1; k <= steps; ++k) {
      points.push_back(from + (to - from) * (static_cast<double>(k) / static_cast<double>(steps)));
    }
  }
  return points;
}

// A muscle that only the fit gives a thickness can.
bool can_be_built(const MuscleDescription& description, std::span<const glm::mat4> rest_bones) {
  MuscleDescription checked = description;
  checked.pcsa.reset();
  checked.volume = 1.0e-4f;
  return check_description(checked, rest_bones).ok();
}

constexpr double kFarOff = 0.5;       // of a mesh's diagonal
constexpr double kSameLine = 1.0e-3;  // of a line's extent
constexpr const char* kUnfitted = "the muscle keeps its unfitted shape";

void warn(const FitInput& input, const std::string& cause, std::string remedy, FittedMuscle& fitted) {
  const std::string name = input.mesh->name.empty() ? "" : fmt::format(" '{}'", input.mesh->name);
  fitted.diagnostics.warnings.push_back(
      fault_of(*input.description, "mesh", fmt::format("its mesh{} {}", name, cause), std::move(remedy)));
}

// m, the diagonal of the line's bounds: a line that winds is longer than the muscle.
double extent_of(std::span<const glm::dvec3> points) {
  glm::dvec3 lower = points[0], upper = points[0];
  for (const glm::dvec3& p : points) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  return glm::distance(lower, upper);
}

// True where a vertex far from all others spoils the mesh; it says so.
bool warn_of_stray(const FitInput& input, FittedMuscle& fitted) {
  const std::optional<double> stray = find_stray_vertex(*input.mesh);
  if (!stray) return false;
  warn(input, fmt::format("has a vertex {:.3g} m away from the others", *stray),
       fmt::format("remove it; {}", kUnfitted), fitted);
  return true;
}

// True where the mesh is of the line's size; else it says so.
bool check_size(const FitInput& input, double size, double extent, FittedMuscle& fitted) {
  const double factor = size / extent;
  if (factor <= kWrongUnit && factor >= 1.0 / kWrongUnit) return true;
  if (warn_of_stray(input, fitted)) return false;
  const std::optional<UnitGuess> guess = guess_unit(factor);
  warn(input,
       fmt::format("is {:.3g} m across, on an action line {:.3g} m across{}", size, extent,
                   guess ? fmt::format(": it seems to be in {}", guess->unit) : ""),
       fmt::format("{}; {}", guess ? "give the mesh's unit" : "check the mesh's unit and the muscle's attachments",
                   kUnfitted),
       fitted);
  return false;
}

// m, between a line and a box. The distance to what is convex has one valley along a straight stretch.
double distance_between(std::span<const glm::dvec3> line, const Bounds& bounds) {
  const glm::dvec3 lower(bounds.lower), upper(bounds.upper);
  const auto from = [&](const glm::dvec3& p) { return glm::distance(p, glm::clamp(p, lower, upper)); };
  double least = from(line[0]);
  for (std::size_t k = 1; k < line.size(); ++k) {
    double low = 0.0, high = 1.0;
    for (int round = 0; round < 40; ++round) {
      const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
      if (from(glm::mix(line[k - 1], line[k], a)) <= from(glm::mix(line[k - 1], line[k], b))) high = b;
      else low = a;
    }
    least = std::min({least, from(line[k]), from(glm::mix(line[k - 1], line[k], 0.5 * (low + high)))});
  }
  return least;
}

// True where the line comes near the mesh; else it says so. Lines beside their meshes are fitted, too: of a curved
// muscle that is the rule.
bool check_place(const FitInput& input, const TriangleMesh& mesh, std::span<const glm::dvec3> line,
                 FittedMuscle& fitted) {
  const Bounds bounds = mesh_bounds(mesh);
  const double distance = distance_between(line, bounds);
  if (distance <= kFarOff * double{bounds.diagonal()}) return true;
  warn(input, fmt::format("lies {:.3g} m away from the muscle's action line", distance),
       fmt::format("check its place and unit; {}", kUnfitted), fitted);
  return false;
}

// The ends do not count: that the model has them outside of the mesh is common.
void warn_of_outside(const FitInput& input, FittedMuscle& fitted) {
  if (fitted.sections.size() < 3) return;
  const std::span inner = std::span<const SectionReport>(fitted.sections).subspan(1, fitted.sections.size() - 2);
  const auto outside = std::ranges::count_if(inner, [](const SectionReport& section) {
    return section.outcome == SectionOutcome::kMissed || section.outcome == SectionOutcome::kOutside;
  });
  if (2 * static_cast<std::size_t>(outside) <= inner.size()) return;
  warn(input, fmt::format("is found by few sections: round {} of {} inner ones there is none", outside, inner.size()),
       "lengthen the mesh, move the attachments, or give no mesh", fitted);
}

// The attachment area at an end, in the mesh as it was mended. Triangles that are not there are left out.
TriangleMesh find_area(const FitInput& input, const CheckedMesh& checked, const TriangleMesh& mesh, std::size_t end) {
  std::vector<std::uint32_t> triangles = input.areas[end];
  if (triangles.empty()) return {};
  const auto count = static_cast<std::uint32_t>(input.mesh->indices.size() / 3);
  std::erase_if(triangles, [&](std::uint32_t triangle) { return triangle >= count; });
  if (checked.mended) {
    std::vector<bool> wanted(count, false);
    for (const std::uint32_t triangle : triangles) wanted[triangle] = true;
    triangles.clear();
    for (std::uint32_t i = 0; i < checked.source_triangles.size(); ++i) {
      if (wanted[checked.source_triangles[i]]) triangles.push_back(i);
    }
  }
  return take_triangles(mesh, triangles);
}

FittedMuscle fit_muscle(const FitInput& input, const CheckedMesh& checked, std::span<const glm::mat4> rest_bones,
                        const RayDevice& device, const FitOptions& options, const HeadRegion* region) {
  FittedMuscle fitted;
  const MuscleDescription& description = *input.description;
  const std::vector<glm::dvec3> points = section_points(description, rest_bones);
  const TriangleMesh& mesh = checked.mended ? *checked.mended : *input.mesh;
  if (mesh.indices.empty()) {
    if (warn_of_stray(input, fitted)) return fitted;
    warn(input, input.mesh->indices.empty() ? "has no triangles" : "is left without triangles: " + checked.defects,
         fmt::format("give another mesh; {}", kUnfitted), fitted);
    return fitted;
  }
  if (!check_size(input, checked.size, extent_of(points), fitted)) return fitted;
  if (!check_place(input, mesh, points, fitted)) return fitted;
  const FitSurface surface(mesh, options.plain_rays ? RayScene(mesh) : RayScene(device, mesh), checked.sound,
                           region);
  const glm::dmat3 origin_bone{
      glm::dmat4(rest_bones[static_cast<std::size_t>(description.attachments.front().bone)])};
  const std::array areas{find_area(input, checked, mesh, 0), find_area(input, checked, mesh, 1)};
  const LineFit fit = fit_line(surface, points, origin_bone, description.section_vertices, areas, options);
  std::string defects = checked.defects;
  if (input.checked == nullptr && !checked.mended && surface.met_overlaps()) defects = clean_mesh(mesh).defects.to_text();
  if (!fit.any_hit) {
    if (region != nullptr && std::ranges::none_of(mesh.indices, [&](std::uint32_t v) {
          return region->contains(glm::dvec3(mesh.positions[v]));
        })) {
      warn(input, "is nearer to other heads' action lines everywhere",
           fmt::format("check the muscle's attachments, or give it another mesh; {}", kUnfitted), fitted);
      return fitted;
    }
    warn(input,
         defects.empty()
             ? "is missed by the muscle's action line altogether: no section's plane meets it"
             : fmt::format("is missed by the muscle's action line altogether, or encloses nothing: {}", defects),
         fmt::format("check its place, unit and holes; {}", kUnfitted), fitted);
    return fitted;
  }
  if (!defects.empty()) {
    warn(input, fmt::format("has defects: {}", defects),
         "the muscle is fitted all the same, inside being where the winding number exceeds one half; mend the mesh",
         fitted);
  }
  fitted.sections = fit.sections;
  for (std::size_t k = 0; k < points.size(); ++k) {
    fitted.fit.displacements.push_back(glm::vec3(fit.centres[k] - points[k]));
  }
  fitted.fit.radii.assign(fit.radii.begin(), fit.radii.end());
  for (std::size_t end = 0; end < 2; ++end) {
    if (fit.end_normals[end]) fitted.fit.end_normals[end] = glm::vec3(*fit.end_normals[end]);
  }
  warn_of_outside(input, fitted);
  return fitted;
}

// Heads whose lines are the same both get the whole mesh. Said once, at the later one.
void warn_of_same_lines(std::span<const FitInput> inputs, std::span<const glm::mat4> rest_bones,
                        std::vector<FittedMuscle>& fitted) {
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (inputs[j].mesh != inputs[i].mesh || fitted[i].fit.radii.empty() || fitted[j].fit.radii.empty()) continue;
      const std::vector<glm::dvec3> line = attachment_points(*inputs[i].description, rest_bones);
      const auto same = [tolerance = kSameLine * extent_of(line)](const glm::dvec3& a, const glm::dvec3& b) {
        return glm::distance(a, b) <= tolerance;
      };
      if (!std::ranges::equal(line, attachment_points(*inputs[j].description, rest_bones), same)) continue;
      warn(inputs[i],
           fmt::format("is shared whole with '{}', which has the same action line", inputs[j].description->name),
           "give each head a line of its own, or make them one muscle", fitted[i]);
      break;
    }
  }
}

// Of inputs that share their mesh with another.
std::vector<std::optional<HeadRegion>> find_regions(std::span<const FitInput> inputs, const std::vector<bool>& wanted,
                                                    std::span<const glm::mat4> rest_bones) {
  std::vector<std::optional<HeadRegion>> regions(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!wanted[i]) continue;
    std::vector<std::vector<glm::dvec3>> lines;
    std::size_t own = 0;
    for (std::size_t j = 0; j < inputs.size(); ++j) {
      if (!wanted[j] || inputs[j].mesh != inputs[i].mesh) continue;
      if (i == j) own = lines.size();
      lines.push_back(attachment_points(*inputs[j].description, rest_bones));
    }
    if (lines.size() > 1) regions[i].emplace(lines, own);
  }
  return regions;
}

// By input: its mesh, checked. A mesh of several heads is checked once, one that the caller has checked not at all.
std::vector<std::shared_ptr<const CheckedMesh>> check_meshes(std::span<const FitInput> inputs,
                                                             const std::vector<bool>& wanted) {
  std::vector<std::shared_ptr<const CheckedMesh>> checked(inputs.size());
  std::vector<std::size_t> first(inputs.size());  // with the same mesh
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto same = [&](std::size_t j) { return wanted[j] && inputs[j].mesh == inputs[i].mesh; };
    while (first[i] < i && !same(first[i])) ++first[i];
  }
  parallel::for_range(inputs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!wanted[i] || first[i] != i) continue;
      if (inputs[i].checked != nullptr) checked[i] = {std::shared_ptr<void>(), inputs[i].checked};
      else checked[i] = std::make_shared<const CheckedMesh>(check_mesh(*inputs[i].mesh));
    }
  });
  for (std::size_t i = 0; i < inputs.size(); ++i) checked[i] = checked[first[i]];
  return checked;
}

}  // namespace

std::vector<FittedMuscle> fit_muscles(std::span<const FitInput> inputs, std::span<const glm::mat4> rest_bones,
                                      const FitOptions& options) {
  std::vector<FittedMuscle> fitted(inputs.size());
  if (!check_rest_bones(rest_bones).ok()) return fitted;
  std::vector<bool> wanted(inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    wanted[i] = inputs[i].mesh != nullptr && can_be_built(*inputs[i].description, rest_bones);
  }
  const std::vector<std::optional<HeadRegion>> regions = find_regions(inputs, wanted, rest_bones);
  const std::vector<std::shared_ptr<const CheckedMesh>> checked = check_meshes(inputs, wanted);
  const RayDevice device;
  parallel::for_range(inputs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const HeadRegion* region = regions[i] ? &*regions[i] : nullptr;
      if (wanted[i]) fitted[i] = fit_muscle(inputs[i], *checked[i], rest_bones, device, options, region);
    }
  });
  warn_of_same_lines(inputs, rest_bones, fitted);
  return fitted;
}

}  // namespace fascicle::muscle
