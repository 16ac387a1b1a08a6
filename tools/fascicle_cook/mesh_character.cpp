#include "tools/fascicle_cook/mesh_character.hpp"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/animation/skeleton.hpp"
#include "engine/content/mesh_reader.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "engine/geometry/clean_mesh.hpp"
#include "engine/geometry/mesh_measures.hpp"
#include "engine/geometry/principal_axes.hpp"
#include "engine/geometry/ray_scene.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/fit/fit_muscles.hpp"

namespace fascicle::cook {
namespace {

using namespace fascicle::muscle;

constexpr float kInset = 0.01f;  // of the line's length, at each end

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
  const Line axis{glm::vec3(axes.centre), glm::vec3(axes.axes[0])};
  LineExtremes found;
  RayScene(RayDevice(), clean).cast(std::span(&axis, 1), std::span(&found, 1));
  if (!std::isfinite(found.first_entry) || !std::isfinite(found.last_exit) || found.last_exit <= found.first_entry) {
    return fault("the mesh's principal axis does not pass through it", "is it a closed muscle? give it an action line");
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
  const float inset = kInset * (found.last_exit - found.first_entry);
  for (const float t : {found.first_entry + inset, found.last_exit - inset}) {
    description.attachments.push_back({.bone = 0, .position = axis.origin + t * axis.direction});
  }
  description.where.file = reference;
  character->descriptions = {description};

  const FitInput input{.description = &description, .mesh = mesh.get(), .areas = {}};
  std::vector<FittedMuscle> fitted =
      fit_muscles(std::span(&input, 1), skeleton->rest_world, {.supersampling = options.supersampling});
  Diagnostics said{.errors = {}, .warnings = fitted[0].diagnostics.warnings};
  if (fitted[0].fit.radii.empty()) {
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
