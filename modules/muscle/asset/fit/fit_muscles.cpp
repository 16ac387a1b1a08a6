#include "modules/muscle/asset/fit/fit_muscles.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/ray_scene.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/asset/check_descriptions.hpp"
#include "modules/muscle/asset/fit/fit_line.hpp"

namespace fascicle::muscle {
namespace {

// The centres of a muscle's sections before the fit, m.
std::vector<glm::dvec3> section_points(const MuscleDescription& description, std::span<const glm::mat4> bones) {
  const auto place = [&](const AttachmentDescription& attachment) {
    return glm::dvec3(glm::dmat4(bones[static_cast<std::size_t>(attachment.bone)]) *
                      glm::dvec4(attachment.position, 1.0));
  };
  const std::size_t steps = std::size_t{1} << description.longitudinal_subdivision;
  std::vector<glm::dvec3> points{place(description.attachments.front())};
  for (std::size_t i = 1; i < description.attachments.size(); ++i) {
    const glm::dvec3 from = points.back(), to = place(description.attachments[i]);
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

void warn(const FitInput& input, std::string cause, std::string remedy, FittedMuscle& fitted) {
  fitted.diagnostics.warnings.push_back(
      fault_of(*input.description, "mesh", fmt::format("its mesh '{}' {}", input.mesh->name, cause), std::move(remedy)));
}

FittedMuscle fit_muscle(const FitInput& input, std::span<const glm::mat4> rest_bones, const RayDevice& device,
                        const FitOptions& options) {
  FittedMuscle fitted;
  const MuscleDescription& description = *input.description;
  const std::vector<glm::dvec3> points = section_points(description, rest_bones);
  const TriangleMesh& mesh = *input.mesh;
  if (mesh.indices.empty()) {
    warn(input, "has no triangles", "the muscle keeps its unfitted shape; give it another mesh", fitted);
    return fitted;
  }
  const FitSurface surface(mesh, options.plain_rays ? RayScene(mesh) : RayScene(device, mesh), true);
  const glm::dmat3 origin_bone{
      glm::dmat4(rest_bones[static_cast<std::size_t>(description.attachments.front().bone)])};
  const LineFit fit = fit_line(surface, points, origin_bone, description.section_vertices, options);
  if (!fit.any_hit) {
    warn(input, "is missed by the muscle's action line altogether",
         "the muscle keeps its unfitted shape; check the mesh's place and unit", fitted);
    return fitted;
  }
  fitted.sections = fit.sections;
  for (std::size_t k = 0; k < points.size(); ++k) {
    fitted.fit.displacements.push_back(glm::vec3(fit.centres[k] - points[k]));
  }
  fitted.fit.radii.assign(fit.radii.begin(), fit.radii.end());
  return fitted;
}

}  // namespace

std::vector<FittedMuscle> fit_muscles(std::span<const FitInput> inputs, std::span<const glm::mat4> rest_bones,
                                      const FitOptions& options) {
  std::vector<FittedMuscle> fitted(inputs.size());
  if (!check_rest_bones(rest_bones).ok()) return fitted;
  const RayDevice device;
  parallel::for_range(inputs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (inputs[i].mesh == nullptr || !can_be_built(*inputs[i].description, rest_bones)) continue;
      fitted[i] = fit_muscle(inputs[i], rest_bones, device, options);
    }
  });
  return fitted;
}

}  // namespace fascicle::muscle
