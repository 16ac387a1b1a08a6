#include "modules/muscle/systems/5_present/draw_collision.hpp"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "engine/render/renderer.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/kernels/transversal.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kLineOfDepth = 4.0f;      // a contact's line, in its depths
constexpr float kShortest = 0.004f;       // m: and at least this
constexpr float kLongest = 0.06f;         // m
constexpr float kDeep = 0.005f;           // m: a contact so deep has its kind's full colour
constexpr float kPalest = 0.65f;          // how white one without depth is
constexpr float kDisplaced = 0.0005f;     // m: centres moved by less have no line

std::uint32_t pale(std::uint32_t colour, float whiteness) {
  std::uint32_t result = colour & 0xff000000u;
  for (int shift = 0; shift < 24; shift += 8) {
    const float value = static_cast<float>((colour >> shift) & 0xffu);
    result |= static_cast<std::uint32_t>(value + whiteness * (255.0f - value)) << shift;
  }
  return result;
}

// The tagged end's section and vertex, by the collision asset's numbers.
TransversalEnd end_of(const CollisionAsset& asset, std::uint32_t number, std::uint32_t vertex,
                      const ActionLines& lines, const CrossSections& sections) {
  const CollisionSection& section = asset.sections[number];
  return {section_vertex(*asset.muscles, lines, sections, section.muscle, section.section, vertex),
          line_point(*asset.muscles, lines, section.muscle, section.section)};
}

// Whether the collision's state is laid out as the lines are; not so before its first step.
bool fits(const MuscleCollision& collision, const ActionLines& lines) {
  return collision.asset != nullptr && collision.asset->muscles->slot_count <= lines.x.size();
}

}  // namespace

glm::vec3 section_vertex(const MuscleAsset& asset, const ActionLines& lines, const CrossSections& sections,
                         std::uint32_t muscle, std::uint32_t section, std::uint32_t vertex) {
  const std::uint32_t slot = asset.slot(muscle, section);
  const Circle& circle = asset.circles[asset.muscles[muscle].circle];
  const float radius = sections.radii[asset.radius(muscle, section) + vertex];
  return glm::vec3(lines.x[slot], lines.y[slot], lines.z[slot]) +
         radius * (circle.cosines[vertex] * glm::vec3(sections.ux[slot], sections.uy[slot], sections.uz[slot]) +
                   circle.sines[vertex] * glm::vec3(sections.vx[slot], sections.vy[slot], sections.vz[slot]));
}

void mark_contacts(const MuscleContacts& contacts, CollisionMarks& marks) {
  for (const MuscleContact& contact : contacts.now) {
    const std::uint32_t kind =
        contact.bone >= 0 ? kCollisionColours.bone_contact : kCollisionColours.muscle_contact;
    const bool left = contact.left > kLeftToShow;
    const float depth = glm::clamp(contact.depth / kDeep, 0.0f, 1.0f);
    const std::uint32_t colour = left ? kCollisionColours.left : pale(kind, kPalest * (1.0f - depth));
    const float length = glm::clamp(kLineOfDepth * contact.depth, kShortest, kLongest);
    marks.lines.push_back({contact.place, contact.place + length * contact.normal, colour});
    marks.points.push_back({contact.place, colour, left ? 9.0f : 7.0f});
  }
}

void mark_transversals(const MuscleCollision& collision, const ActionLines& lines, const CrossSections& sections,
                       std::span<const TransversalTag> tags, std::span<const glm::mat4> bones, CollisionMarks& marks) {
  if (!fits(collision, lines)) return;
  const CollisionAsset& asset = *collision.asset;
  for (const Transversal& transversal : asset.transversals) {
    const TransversalEnd first = end_of(asset, transversal.section, transversal.vertex, lines, sections);
    TransversalEnd second;
    if (transversal.bone < 0) {
      second = end_of(asset, transversal.other_section, transversal.other_vertex, lines, sections);
    } else if (static_cast<std::size_t>(transversal.bone) < bones.size()) {
      const glm::vec4 point(transversal.point, 1.0f);
      second.tag = second.centre = glm::vec3(bones[static_cast<std::size_t>(transversal.bone)] * point);
    } else {
      continue;
    }
    const bool acts = measure_transversal(first, second).overlap > transversal.rest_depth + kLeftToShow;
    const bool automatic = transversal.tag < tags.size() && tags[transversal.tag].automatic;
    const std::uint32_t colour = acts        ? kCollisionColours.acting_tag
                                 : automatic ? kCollisionColours.automatic_tag
                                             : kCollisionColours.author_tag;
    marks.lines.push_back({first.tag, second.tag, colour});
    const float size = automatic && !acts ? 4.0f : 7.0f;
    marks.points.push_back({first.tag, colour, size});
    marks.points.push_back({second.tag, colour, size});
  }
}

void mark_displacements(const MuscleCollision& collision, const ActionLines& lines, std::span<const glm::mat4> bones,
                        CollisionMarks& marks) {
  if (!fits(collision, lines) || collision.offset_x.size() < collision.asset->muscles->slot_count) return;
  for (const CollisionSection& section : collision.asset->sections) {
    if (section.bone >= bones.size()) continue;
    const std::uint32_t slot = section.slot;
    const glm::vec3 offset(collision.offset_x[slot], collision.offset_y[slot], collision.offset_z[slot]);
    if (!(glm::dot(offset, offset) > kDisplaced * kDisplaced)) continue;
    const glm::vec3 now(lines.x[slot], lines.y[slot], lines.z[slot]);
    marks.lines.push_back({now - glm::mat3(bones[section.bone]) * offset, now, kCollisionColours.displacement});
  }
}

void mark_section(const MuscleAsset& asset, const ActionLines& lines, const CrossSections& sections,
                  std::uint32_t muscle, std::uint32_t section, std::uint32_t vertex, std::uint32_t colour,
                  CollisionMarks& marks) {
  const std::uint32_t count = asset.muscles[muscle].section_vertices;
  glm::vec3 last = section_vertex(asset, lines, sections, muscle, section, count - 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 next = section_vertex(asset, lines, sections, muscle, section, i);
    marks.lines.push_back({last, next, colour});
    last = next;
  }
  marks.points.push_back({section_vertex(asset, lines, sections, muscle, section, vertex), colour, 9.0f});
}

void draw_marks(const CollisionMarks& marks, Renderer& renderer) {
  for (const MarkLine& line : marks.lines) renderer.add_line(line.from, line.to, line.colour);
  for (const MarkPoint& point : marks.points) renderer.add_point(point.at, point.colour, point.size);
}

}  // namespace fascicle::muscle
