#include "modules/muscle/systems/4_solve/legacy_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/geometry/finite.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/kernels/inflate_section.hpp"
#include "modules/muscle/kernels/sweep_rays.hpp"
#include "modules/muscle/kernels/transversal.hpp"

namespace fascicle::muscle {
namespace {

using Row = std::array<glm::vec3, kMaxSectionVertices>;
using Flags = std::array<std::uint8_t, kMaxSectionVertices>;

class Response {
 public:
  Response(const CollisionAsset& asset, const LegacyPlan& plan, std::span<const glm::mat4> bones,
           const CrossSections& sections, ActionLines& lines, MuscleCollision& collision)
      : asset_(asset), plan_(plan), bones_(bones), sections_(sections), lines_(lines), collision_(collision) {}

  LegacyOutcome run() {
    for (const Transversal& transversal : asset_.transversals) yield_to(transversal);
    for (std::size_t begin = 0; begin < plan_.sweeps.size();) {
      std::size_t end = begin + 1;
      while (end < plan_.sweeps.size() && plan_.sweeps[end].section == plan_.sweeps[begin].section) ++end;
      respond(std::span(plan_.sweeps).subspan(begin, end - begin));
      begin = end;
    }
    return outcome_;
  }

 private:
  glm::vec3 centre(const CollisionSection& section) const {
    return {lines_.x[section.slot], lines_.y[section.slot], lines_.z[section.slot]};
  }

  glm::vec3 vertex(const CollisionSection& section, std::uint32_t i) const {
    const std::uint32_t slot = section.slot;
    const Circle& circle = asset_.muscles->circles[asset_.muscles->layouts[section.muscle].circle];
    const glm::vec3 u(sections_.ux[slot], sections_.uy[slot], sections_.uz[slot]);
    const glm::vec3 v(sections_.vx[slot], sections_.vy[slot], sections_.vz[slot]);
    return centre(section) + collision_.radii[section.first_radius + i] * (circle.cosines[i] * u + circle.sines[i] * v);
  }

  std::span<glm::vec3> place(std::uint32_t number, Row& row) const {
    const CollisionSection& section = asset_.sections[number];
    for (std::uint32_t i = 0; i < section.count; ++i) row[i] = vertex(section, i);
    return std::span(row).first(section.count);
  }

  bool is_first(std::uint32_t number) const {
    return number == asset_.first_section[asset_.sections[number].muscle];
  }
  bool is_last(std::uint32_t number) const {
    return number + 1 == asset_.first_section[asset_.sections[number].muscle + 1];
  }

  bool is_held(const CollisionSection& section) const { return lines_.any_held && lines_.held[section.muscle] != 0; }

  // Adds to a centre's displacement, which is kept in its bone's frame.
  void move(const CollisionSection& section, const glm::vec3& by) {
    if (section.end || is_held(section) || by == glm::vec3(0.0f)) return;
    const glm::mat3 to_world(bones_[section.bone]);
    const std::uint32_t slot = section.slot;
    const glm::vec3 before(collision_.offset_x[slot], collision_.offset_y[slot], collision_.offset_z[slot]);
    glm::vec3 after = before + glm::inverse(to_world) * by;
    if (!is_finite(after)) {
      ++outcome_.clamped;
      return;
    }
    if (const float length = glm::length(after); length > kLegacyReach) {
      after *= kLegacyReach / length;
      ++outcome_.clamped;
    }
    const glm::vec3 place = centre(section) + to_world * (after - before);
    if (!is_finite(after) || !is_finite(place)) return;
    ++outcome_.moved;
    collision_.offset_x[slot] = after.x;
    collision_.offset_y[slot] = after.y;
    collision_.offset_z[slot] = after.z;
    lines_.x[slot] = place.x;
    lines_.y[slot] = place.y;
    lines_.z[slot] = place.z;
  }

  void yield_to(const Transversal& transversal) {
    const CollisionSection& first = asset_.sections[transversal.section];
    const CollisionSection& second = asset_.sections[transversal.other_section];
    const bool is_bone = transversal.bone >= 0;
    const TransversalEnd x{.tag = vertex(first, transversal.vertex), .centre = centre(first)};
    TransversalEnd y;
    if (is_bone) {
      y.tag = y.centre = glm::vec3(bones_[transversal.bone] * glm::vec4(transversal.point, 1.0f));
    } else {
      y = {.tag = vertex(second, transversal.other_vertex), .centre = centre(second)};
    }
    const TransversalDepth depth = measure_transversal(x, y);
    if (transversal.first_yields) move(first, transversal_displacement(depth.x, depth.thesis));
    if (transversal.second_yields && !is_bone) move(second, transversal_displacement(depth.y, depth.thesis));
  }

  // The surface on both sides of a section.
  void cast_at_section(std::uint32_t number, std::uint32_t count) {
    const std::span<const glm::vec3> middle = place(number, rows_[0]);
    const std::span<SweepTriangle> triangles = std::span(triangles_).first(2 * middle.size());
    if (!is_first(number)) {
      segment_triangles(place(number - 1, rows_[1]), middle, triangles);
      cast_at(triangles, count);
    }
    if (!is_last(number)) {
      segment_triangles(middle, place(number + 1, rows_[1]), triangles);
      cast_at(triangles, count);
    }
  }

  void cast_at(std::span<const SweepTriangle> triangles, std::uint32_t count) {
    mark_crossings(std::span(latitudinal_).first(count), triangles, std::span(latitudinal_hits_).first(count));
    mark_crossings(std::span(diagonal_).first(count), triangles, std::span(diagonal_hits_).first(count));
  }

  void cast_at_bone(std::int32_t bone, std::uint32_t count) {
    const TriangleTree& tree = *plan_.bones[bone];
    const glm::mat4 to_bone = glm::inverse(bones_[bone]);
    mark_crossings(std::span(latitudinal_).first(count), tree, to_bone, std::span(latitudinal_hits_).first(count));
    mark_crossings(std::span(diagonal_).first(count), tree, to_bone, std::span(diagonal_hits_).first(count));
  }

  // To what the sweeps of one section hit.
  void respond(std::span<const LegacySweep> sweeps) {
    const std::uint32_t number = sweeps[0].section;
    const CollisionSection& section = asset_.sections[number];
    if (is_held(section)) return;
    const std::uint32_t count = section.count, half = count / 2;
    const std::span<const glm::vec3> vertices = place(number, vertices_);
    sweep_edges(vertices, place(is_last(number) ? number - 1 : number + 1, rows_[0]),
                std::span(latitudinal_).first(count), std::span(diagonal_).first(count));
    std::fill_n(latitudinal_hits_.begin(), count, std::uint8_t{0});
    std::fill_n(diagonal_hits_.begin(), count, std::uint8_t{0});
    for (const LegacySweep& sweep : sweeps) {
      if (sweep.bone >= 0) cast_at_bone(sweep.bone, count);
      else cast_at_section(sweep.other_section, count);
    }
    const std::span<std::uint8_t> fixed = std::span(fixed_).first(count);
    mark_vertices(std::span(latitudinal_hits_).first(count), fixed);

    const glm::vec3 axis = centre(section);
    const std::span<float> radii = std::span(collision_.radii).subspan(section.first_radius, count);
    glm::vec3 push(0.0f);
    for (std::uint32_t i = 0; i < count; ++i) {
      bool pushes = diagonal_hits_[i] != 0;
      if (fixed[i] != 0) {
        const float shrunk = kLegacyShrink * radii[i];
        if (shrunk >= kLegacySmallestRadius) {
          radii[i] = shrunk;
          ++outcome_.shrunk;
        } else {
          pushes = true;
        }
      }
      if (pushes) push += kLegacyPush * (vertices[(i + half) % count] - axis);
    }
    move(section, push);
    const IterativeInflation inflation =
        inflate_iteratively(radii, fixed, section.rest_area, kLegacyAreaTolerance, kLegacyMostIterations);
    outcome_.iterations += inflation.iterations;
    if (inflation.iterations > 0) ++outcome_.inflated;
    for (float& radius : radii) {
      if (std::abs(radius) <= kLegacyReach) continue;
      radius = std::isfinite(radius) ? std::copysign(kLegacyReach, radius) : 0.0f;
      ++outcome_.clamped;
    }
  }

  const CollisionAsset& asset_;
  const LegacyPlan& plan_;
  const std::span<const glm::mat4> bones_;
  const CrossSections& sections_;
  ActionLines& lines_;
  MuscleCollision& collision_;
  LegacyOutcome outcome_;

  Row vertices_;
  std::array<Row, 2> rows_;
  std::array<SweepEdge, kMaxSectionVertices> latitudinal_, diagonal_;
  std::array<SweepTriangle, 2 * kMaxSectionVertices> triangles_;
  Flags latitudinal_hits_, diagonal_hits_, fixed_;
};

}  // namespace

LegacyPlan make_legacy_plan(const CollisionAsset& asset, std::vector<std::shared_ptr<const TriangleTree>> bones,
                            bool only_marked) {
  LegacyPlan plan{.sweeps = {}, .bones = std::move(bones)};
  for (const Transversal& transversal : asset.transversals) {
    if (only_marked && !transversal.sweeps) continue;
    const std::size_t bone = static_cast<std::size_t>(transversal.bone);
    if (transversal.bone < 0) {
      if (transversal.first_yields) plan.sweeps.push_back({transversal.section, -1, transversal.other_section});
      if (transversal.second_yields) plan.sweeps.push_back({transversal.other_section, -1, transversal.section});
    } else if (transversal.first_yields && bone < plan.bones.size() && plan.bones[bone]) {
      plan.sweeps.push_back({transversal.section, transversal.bone, 0});
    }
  }
  // Ends are fixed to their bones, which they would never come free of.
  std::erase_if(plan.sweeps, [&](const LegacySweep& sweep) { return asset.sections[sweep.section].end; });
  const auto order = [](const LegacySweep& sweep) {
    return std::tuple(sweep.section, sweep.bone < 0, sweep.bone, sweep.other_section);
  };
  std::sort(plan.sweeps.begin(), plan.sweeps.end(),
            [&](const LegacySweep& a, const LegacySweep& b) { return order(a) < order(b); });
  const auto same = [&](const LegacySweep& a, const LegacySweep& b) { return order(a) == order(b); };
  plan.sweeps.erase(std::unique(plan.sweeps.begin(), plan.sweeps.end(), same), plan.sweeps.end());
  return plan;
}

LegacyOutcome respond_as_legacy(const CollisionAsset& asset, const LegacyPlan& plan, std::span<const glm::mat4> bones,
                                const CrossSections& sections, ActionLines& lines, MuscleCollision& collision) {
  return Response(asset, plan, bones, sections, lines, collision).run();
}

std::size_t heap_bytes(const LegacyPlan& plan) {
  return plan.sweeps.capacity() * sizeof(LegacySweep) +
         plan.bones.capacity() * sizeof(std::shared_ptr<const TriangleTree>);
}

}  // namespace fascicle::muscle
