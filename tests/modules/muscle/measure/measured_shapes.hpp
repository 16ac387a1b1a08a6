// Muscles and bones with known depths, for tests of the measuring.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/measure/penetration_meter.hpp"
#include "modules/muscle/measure/rest_surfaces.hpp"
#include "tests/support/shapes.hpp"

namespace fascicle::test {

// A straight cylinder from one point of bone 0 to another, in 2^subdivision segments, without tendons.
inline muscle::MuscleDescription cylinder(const std::string& name, const glm::vec3& from, const glm::vec3& to,
                                          float radius, std::uint32_t subdivision = 3,
                                          std::uint32_t section_vertices = 64) {
  muscle::MuscleDescription description;
  description.name = name;
  description.attachments = {{0, from, true}, {0, to, true}};
  description.profile = {.fractions = {0.0f, 1.0f}, .radii = {radius, radius}, .absolute = true};
  description.tendon_at_origin = description.tendon_at_insertion = 0.0f;
  description.section_vertices = section_vertices;
  description.longitudinal_subdivision = subdivision;
  return description;
}

inline muscle::BoneMesh bone_of(const TriangleMesh& mesh, std::int32_t bone = 0,
                                const glm::mat4& transform = glm::mat4(1.0f)) {
  return {bone, transform, std::make_shared<const TriangleMesh>(mesh)};
}

// Muscles on one bone, or several, and what they are measured against.
struct Measured {
  std::shared_ptr<const muscle::MuscleAsset> asset;
  std::vector<muscle::BoneMesh> bones;

  Measured(const std::vector<muscle::MuscleDescription>& muscles, std::vector<muscle::BoneMesh> meshes,
           std::size_t bone_count = 1)
      : bones(std::move(meshes)), rest_(bone_count, glm::mat4(1.0f)) {
    const auto built = muscle::build_muscle_asset(muscles, rest_);
    if (!built) ADD_FAILURE() << to_text(built.diagnostics());
    if (built) asset = *built;
  }

  muscle::Penetration at(const std::vector<glm::mat4>& pose, float spacing = muscle::kSampleSpacing) const {
    muscle::PenetrationMeter meter(asset, muscle::make_bone_solids(bones), spacing);
    const muscle::RestSurfaces posed = muscle::make_rest_surfaces(asset, pose);
    return meter.measure(posed.surfaces, posed.tendons, pose);
  }
  muscle::Penetration at_rest(float spacing = muscle::kSampleSpacing) const { return at(rest_, spacing); }

 private:
  std::vector<glm::mat4> rest_;
};

}  // namespace fascicle::test
