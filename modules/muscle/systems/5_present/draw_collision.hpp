// What collision does, as lines and points to draw: where muscles touch, how deep they were pressed and what the solve
// left of it, the tags and whether they act, and how far centres are from where their bones carry them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "modules/muscle/asset/collision/collision_description.hpp"
#include "modules/muscle/components/action_lines.hpp"
#include "modules/muscle/components/cross_sections.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/components/musculature.hpp"

namespace fascicle {
class Renderer;
}

namespace fascicle::muscle {

// sRGB, R in the lowest byte.
struct CollisionColours {
  std::uint32_t bone_contact = 0xffffd23cu;    // light blue; paler the less deep
  std::uint32_t muscle_contact = 0xff50e678u;  // green; paler the less deep
  std::uint32_t left = 0xff2828ffu;            // red: the solve left more than kLeftToShow
  std::uint32_t author_tag = 0xff28b4ffu;      // orange
  std::uint32_t automatic_tag = 0xffb4aa8cu;   // grey blue
  std::uint32_t acting_tag = 0xffff5af0u;      // magenta: its ends are in each other deeper than at rest
  std::uint32_t displacement = 0xff3cf0f0u;    // yellow
};
inline constexpr CollisionColours kCollisionColours;
inline constexpr float kLeftToShow = 0.0005f;  // m

struct MarkLine {
  glm::vec3 from{0.0f}, to{0.0f};  // m, world
  std::uint32_t colour = 0;
};
struct MarkPoint {
  glm::vec3 at{0.0f};              // m, world
  std::uint32_t colour = 0;
  float size = 5.0f;               // pixels
};
struct CollisionMarks {
  std::vector<MarkLine> lines;
  std::vector<MarkPoint> points;
};

// Appends. A contact is a point, and a line out of the other that is four times as long as the contact was deep. The
// state is that after a step; `tags` are those that the collision's asset was built from.
void mark_contacts(const MuscleContacts& contacts, CollisionMarks& marks);
void mark_transversals(const MuscleCollision& collision, const ActionLines& lines, const CrossSections& sections,
                       std::span<const TransversalTag> tags, std::span<const glm::mat4> bones, CollisionMarks& marks);
void mark_displacements(const MuscleCollision& collision, const ActionLines& lines, std::span<const glm::mat4> bones,
                        CollisionMarks& marks);

// The outline of a muscle's section, and a point on one of its vertices.
void mark_section(const MuscleAsset& asset, const ActionLines& lines, const CrossSections& sections,
                  std::uint32_t muscle, std::uint32_t section, std::uint32_t vertex, std::uint32_t colour,
                  CollisionMarks& marks);

// Vertex c_i^k (1.3), m, world.
glm::vec3 section_vertex(const MuscleAsset& asset, const ActionLines& lines, const CrossSections& sections,
                         std::uint32_t muscle, std::uint32_t section, std::uint32_t vertex);

// For the renderer's next draw.
void draw_marks(const CollisionMarks& marks, Renderer& renderer);

}  // namespace fascicle::muscle
