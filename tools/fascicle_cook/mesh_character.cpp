#include "tools/fascicle_cook/mesh_character.hpp"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/content/mesh_reader.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/principal_axes.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"
#include "modules/muscle/asset/fit/section_slice.hpp"

namespace fascicle::cook {
namespace {

using namespace fascicle::muscle;

constexpr double kInset = 0.01;  // of the mesh's length, at each end

// Deepest inside the mesh's largest slice at `along` the axis (m from the centre); nothing where there is no slice.
std::optional<glm::vec3> find_end(const TriangleMesh& mesh, const PrincipalAxes& axes, double along) {
  const glm::dvec3 origin = axes.centre + along * axes.axes[0];
  const SectionFrame frame{.centre = origin, .tangent = axes.axes[0], .u = axes.axes[1], .v = axes.axes[2]};
  const std::vector<SectionSlice> slices = slice_section(mesh, frame);
  if (slices.empty()) return std::nullopt;
  const glm::dvec2 deepest = deepest_point(slices.front());
  return glm::vec3(origin + deepest.x * frame.u + deepest.y * frame.v);
}

}  // namespace

Result<std::shared_ptr<const CharacterAsset>> make_mesh_character(const std::string& reference,
                                                                  const MeshFitOptions& options) {
  Result<TriangleMesh> read = read_mesh(reference);
  if (!read) return read.diagnostics();
  auto mesh = std::make_shared<TriangleMesh>(std::move(*read));
  for (glm::vec3& position : mesh->positions) position *= options.unit;
  const auto fault = [&](const char* cause, const char* remedy) { return Diagnostic{reference, 0, 0, {}, cause, remedy}; };

  const TriangleMesh clean = clean_mesh(*mesh).mesh;
  const PrincipalAxes axes = principal_axes(clean);
  const double inset = kInset * (axes.ranges[0].y - axes.ranges[0].x);
  const std::array ends{find_end(clean, axes, axes.ranges[0].x + inset), find_end(clean, axes, axes.ranges[0].y - inset)};
  if (!ends[0] || !ends[1]) {
    return fault("no plane square to the mesh's principal axis cuts it in a closed outline near its ends",
                 "is it a closed muscle? give it an action line in a character file");
  }

  auto character = std::make_shared<CharacterAsset>();
  character->name = mesh->name;
  auto skeleton = std::make_shared<Skeleton>();
  skeleton->names = {"bone"};
  skeleton->parents = {-1};
  skeleton->rest_local.resize(1);
  skeleton->rest_world = {glm::mat4(1.0f)};
  character->skeleton = skeleton;

  MuscleDescription description;
  description.name = description.mesh = mesh->name;
  description.volume = static_cast<float>(mesh_volume(clean));
  description.section_vertices = options.section_vertices;
  description.longitudinal_subdivision = options.longitudinal_subdivision;
  for (const auto& end : ends) description.attachments.push_back({.bone = 0, .position = *end});
  description.where.file = reference;
  character->descriptions = {description};

  const FitInput input{.description = &description, .mesh = mesh.get(), .areas = {}};
  std::vector<FittedMuscle> fitted =
      fit_muscles(std::span(&input, 1), skeleton->rest_world, {.supersampling = options.supersampling});
  Diagnostics said{.errors = {}, .warnings = fitted[0].diagnostics.warnings};
  if (fitted[0].fit.radii.empty()) {
    if (said.warnings.empty()) {
      const Bounds bounds = mesh_bounds(clean);
      said.warnings.push_back({reference, 0, 0, {},
                               fmt::format("no muscle can be {:.3g} m across, or lie {:.3g} m from the origin",
                                           bounds.diagonal(), glm::length(0.5f * (bounds.lower + bounds.upper))),
                               "give the mesh's unit with --unit, or move it nearer"});
    }
    return Diagnostics{.errors = std::move(said.warnings), .warnings = {}};
  }
  const auto built =
      build_muscle_asset(character->descriptions, skeleton->rest_world, std::span(&fitted[0].fit, 1));
  if (!built) return built.diagnostics();
  character->muscles = *built;
  character->fits = {{0, {{options.section_vertices, options.longitudinal_subdivision, std::move(fitted[0])}}}};
  character->muscle_meshes.emplace(description.name, std::move(mesh));
  return {std::shared_ptr<const CharacterAsset>(character), std::move(said)};
}

}  // namespace fascicle::cook
