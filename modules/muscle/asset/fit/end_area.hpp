// Wide attachments: where fibres start on an area of the mesh and not in a point, the end section lies on that area.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/fit/section_rays.hpp"

namespace fascicle::muscle {

// The triangles of an attachment area by themselves.
TriangleMesh take_triangles(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles);

// The normal of the area's best-fit plane, about in the direction of the unit vector `along`, the line's, and at most
// 60 degrees off it; unit. Nothing for an area without extent.
std::optional<glm::dvec3> area_normal(const TriangleMesh& area, const glm::dvec3& along);

// The end section's rays reach to the area's outline, seen along the section's normal: section `section` of `rays` is
// set so, by the method's rules (2.1). Rays that do not meet it miss.
void cast_area(const TriangleMesh& area, const SectionFrame& frame, std::size_t section,
               std::span<const glm::dvec2> directions, SectionRays& rays);

}  // namespace fascicle::muscle
