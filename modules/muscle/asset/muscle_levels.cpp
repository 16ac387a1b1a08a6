#include "modules/muscle/asset/muscle_levels.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "modules/muscle/kernels/mtu_kernels.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kSamePlace = 1.0e-5f;      // m
constexpr double kSameTurn = 1.0e-4;       // vertices: a rounding
constexpr double kMostVertices = 0.95;     // of all vertices: the rest may move further than the level's error
constexpr double kPi = 3.14159265358979323846;
constexpr float kSmallestError = 1.0e-6f;  // m

std::vector<std::int32_t> points_by_slot(const MuscleAsset& asset) {
  std::vector<std::int32_t> points(asset.slot_count, -1);
  for (std::size_t i = 0; i < asset.points.size(); ++i) points[asset.points[i].slot] = static_cast<std::int32_t>(i);
  return points;
}

// An asset with what building a morph looks up in it.
struct Level {
  const MuscleAsset& asset;
  std::vector<std::int32_t> point_of_slot = points_by_slot(asset);

  const PointBinding& binding(std::uint32_t slot) const {
    return asset.points[static_cast<std::size_t>(point_of_slot[slot])];
  }
  const PointBinding& section(std::uint32_t m, std::uint32_t k) const { return binding(asset.slot(m, k)); }
  const PointBinding& attachment(std::uint32_t m, std::uint32_t i) const {
    const MuscleLayout& layout = asset.muscles[m];
    return binding(layout.first_attachment_slot + layout.attachment_slot_step * i);
  }
  glm::dvec3 centre(std::uint32_t m, std::uint32_t k) const { return rest_point(asset, m, k); }
  glm::dvec3 u(std::uint32_t m, std::uint32_t k) const {
    const std::uint32_t slot = asset.slot(m, k);
    return {asset.rest_ux[slot], asset.rest_uy[slot], asset.rest_uz[slot]};
  }
  glm::dvec3 v(std::uint32_t m, std::uint32_t k) const {
    const std::uint32_t slot = asset.slot(m, k);
    return {asset.rest_vx[slot], asset.rest_vy[slot], asset.rest_vz[slot]};
  }
  double radius(std::uint32_t m, std::uint32_t k, std::uint32_t i) const {
    return double{asset.rest_radii[asset.radius(m, k) + i % asset.muscles[m].section_vertices]};
  }
  // The unit vector along which vertex i lies, in the frame of `u` and `v`.
  glm::dvec3 along(std::uint32_t m, std::uint32_t i, const glm::dvec3& u_k, const glm::dvec3& v_k) const {
    const MuscleLayout& layout = asset.muscles[m];
    const Circle& circle = asset.circles[layout.circle];
    const std::uint32_t turn = i % layout.section_vertices;
    return double{circle.cosines[turn]} * u_k + double{circle.sines[turn]} * v_k;
  }
  glm::dvec3 vertex(std::uint32_t m, std::uint32_t k, std::uint32_t i) const {
    return centre(m, k) + radius(m, k, i) * along(m, i, u(m, k), v(m, k));
  }
};

// --- Do two levels belong together?

bool same_binding(const PointBinding& a, const PointBinding& b) {
  if (a.first_bone != b.first_bone || a.second_bone != b.second_bone) return false;
  for (int i = 0; i < 4; ++i) {
    if (std::abs(a.first[i] - b.first[i]) > kSamePlace) return false;
    if (std::abs(a.second[i] - b.second[i]) > kSamePlace) return false;
  }
  return true;
}

// What keeps muscle `m` of the coarser level from being the same muscle as the finer level's; nothing where it is.
std::optional<Diagnostic> find_mismatch(const Level& fine, const Level& coarse, std::uint32_t m) {
  const MuscleLayout& a = fine.asset.muscles[m];
  const MuscleLayout& b = coarse.asset.muscles[m];
  const auto mismatch = [&](std::string cause, std::string remedy) {
    return Diagnostic{.file = {}, .line = 0, .column = 0, .path = a.name, .cause = std::move(cause),
                      .remedy = std::move(remedy)};
  };
  if (a.name != b.name) {
    return mismatch(fmt::format("the coarser level has \"{}\" in its place", b.name),
                    "build all levels from the same muscles in the same order");
  }
  bool same = a.attachment_count == b.attachment_count;
  for (std::uint32_t i = 0; same && i < a.attachment_count; ++i) {
    same = same_binding(fine.attachment(m, i), coarse.attachment(m, i));
  }
  if (!same) return mismatch("the coarser level has other attachments", "build all levels from the same muscles");
  if (a.tendon_lengths != b.tendon_lengths) {
    return mismatch("the coarser level has other tendons", "build all levels from the same muscles");
  }
  if (a.section_vertices != b.section_vertices && a.section_vertices != 2 * b.section_vertices) {
    return mismatch(fmt::format("section_vertices goes from {} to {}", a.section_vertices, b.section_vertices),
                    "keep it or halve it from one level to the next");
  }
  if (a.subdivision != b.subdivision && a.subdivision != b.subdivision + 1) {
    return mismatch(fmt::format("longitudinal_subdivision goes from {} to {}", a.subdivision, b.subdivision),
                    "keep it or lower it by one from one level to the next");
  }
  for (std::uint32_t i = 0; a.attachment_slot_step != 1 && i < a.attachment_count; ++i) {
    if (same_binding(coarse.section(m, i << b.subdivision), coarse.attachment(m, i))) continue;
    return mismatch("a fit has displaced the coarser level's sections but not this one's",
                    "fit both levels or neither");
  }
  return std::nullopt;
}

// --- What the finer level becomes.

// From `u` of one frame to `direction`, rad, within half a turn.
double angle_between(const glm::dvec3& direction, const glm::dvec3& u, const glm::dvec3& v) {
  return std::atan2(glm::dot(direction, v), glm::dot(direction, u));
}

// Of a section of the finer level: the coarser section that it becomes, or the one before it where it lies between two.
struct Place {
  std::uint32_t section = 0;
  bool between = false;
};
Place coarse_place(const Level& fine, const Level& coarse, std::uint32_t m, std::uint32_t k) {
  const bool halved = fine.asset.muscles[m].subdivision != coarse.asset.muscles[m].subdivision;
  return halved ? Place{k / 2, k % 2 == 1} : Place{k, false};
}

// Adds a binding's share `weight` to `to`, which is carried by the same bones.
void add_share(float weight, const PointBinding& from, PointBinding& to) {
  const auto add = [&](std::uint32_t bone, const float* values) {
    float* const sum = bone == to.first_bone ? to.first : to.second;
    for (int i = 0; i < 4; ++i) sum[i] += weight * values[i];
  };
  add(from.first_bone, from.first);
  if (from.second_bone != from.first_bone) add(from.second_bone, from.second);
}

std::vector<PointBinding> morph_points(const Level& fine, const Level& coarse) {
  std::vector<PointBinding> points = fine.asset.points;  // attachments with slots of their own stay
  for (std::uint32_t m = 0; m < fine.asset.size(); ++m) {
    for (std::uint32_t k = 0; k < fine.asset.muscles[m].section_count; ++k) {
      PointBinding& point = points[static_cast<std::size_t>(fine.point_of_slot[fine.asset.slot(m, k)])];
      std::fill(std::begin(point.first), std::end(point.first), 0.0f);
      std::fill(std::begin(point.second), std::end(point.second), 0.0f);
      const Place place = coarse_place(fine, coarse, m, k);
      add_share(place.between ? 0.5f : 1.0f, coarse.section(m, place.section), point);
      if (place.between) add_share(0.5f, coarse.section(m, place.section + 1), point);
    }
  }
  return points;
}

// Two levels may count a muscle's vertices from different directions: by how many vertices of its own the finer level's
// start is to be turned. Whole ones, so that vertices meet vertices, and the nearest, so that the muscle is not seen to
// turn as it morphs.
std::uint32_t find_shift(const Level& fine, const Level& coarse, std::uint32_t m) {
  const int count = static_cast<int>(fine.asset.muscles[m].section_vertices);
  const double turns = angle_between(fine.u(m, 0), coarse.u(m, 0), coarse.v(m, 0)) / (2.0 * kPi);
  return static_cast<std::uint32_t>((static_cast<int>(std::lround(turns * count)) + count) % count);
}
double shifted_turns(const Level& fine, const Level& coarse, std::uint32_t m) {
  return double(find_shift(fine, coarse, m)) / fine.asset.muscles[m].section_vertices;
}

// `from` turned about its tangent. Bones may be scaled, but evenly.
EndFrame turn_end(const EndFrame& from, double turns) {
  const glm::dvec3 t(from.tangent[0], from.tangent[1], from.tangent[2]);
  const glm::dvec3 u(from.reference[0], from.reference[1], from.reference[2]);
  const glm::dvec3 turned =
      std::cos(2.0 * kPi * turns) * u + std::sin(2.0 * kPi * turns) * glm::cross(glm::normalize(t), u);
  EndFrame to = from;
  for (int i = 0; i < 3; ++i) to.reference[i] = static_cast<float>(turned[i]);
  return to;
}

std::vector<EndFrame> morph_ends(const Level& fine, const Level& coarse) {
  std::vector<EndFrame> ends = fine.asset.ends;
  for (std::uint32_t m = 0; m < fine.asset.size(); ++m) {
    for (std::size_t end = 0; end < 2; ++end) {
      const EndFrame& from = coarse.asset.ends[std::size_t{2} * coarse.asset.muscles[m].lane_index + end];
      ends[std::size_t{2} * fine.asset.muscles[m].lane_index + end] = turn_end(from, shifted_turns(fine, coarse, m));
    }
  }
  return ends;
}

// The morphed level's action lines and frames at rest, by the finer asset's slots.
struct MorphedLines {
  AlignedVector<float> x, y, z, ux, uy, uz, vx, vy, vz;

  MorphedLines(const Level& fine, const Level& coarse)
      : x(fine.asset.rest_x), y(fine.asset.rest_y), z(fine.asset.rest_z) {
    const MuscleAsset& asset = fine.asset;
    for (AlignedVector<float>* array : {&ux, &uy, &uz, &vx, &vy, &vz}) array->assign(asset.slot_count, 0.0f);
    // Nobody knows the rest bones any more, but what they make of the ends: the coarser level's own directions.
    const std::array<float, 16> still = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::vector<EndFrame> ends(std::size_t{2} * asset.lane_count);
    for (std::uint32_t m = 0; m < asset.size(); ++m) {
      const MuscleLayout& layout = asset.muscles[m];
      for (std::uint32_t k = 0; k < layout.section_count; ++k) {
        const Place place = coarse_place(fine, coarse, m, k);
        glm::dvec3 centre = coarse.centre(m, place.section);
        if (place.between) centre = 0.5 * (centre + coarse.centre(m, place.section + 1));
        const std::uint32_t slot = asset.slot(m, k);
        x[slot] = static_cast<float>(centre.x);
        y[slot] = static_cast<float>(centre.y);
        z[slot] = static_cast<float>(centre.z);
      }
      for (std::size_t end = 0; end < 2; ++end) {
        const std::uint32_t k = end == 0 ? 0 : coarse.asset.muscles[m].section_count - 1;
        const glm::dvec3 u = coarse.u(m, k), t = glm::cross(u, coarse.v(m, k));
        EndFrame frame;
        for (int i = 0; i < 3; ++i) {
          frame.tangent[i] = static_cast<float>(t[i]);
          frame.reference[i] = static_cast<float>(u[i]);
        }
        frame.fixed = coarse.asset.ends[std::size_t{2} * coarse.asset.muscles[m].lane_index + end].fixed;
        ends[std::size_t{2} * layout.lane_index + end] = turn_end(frame, shifted_turns(fine, coarse, m));
      }
    }
    AlignedVector<float> arc(asset.slot_count), twist(asset.lane_count, 0.0f);
    BuildFramesJob job;
    job.bones = still.data();
    job.blocks = asset.blocks.data();
    job.block_count = asset.blocks.size();
    job.ends = ends.data();
    job.restart_twist = true;
    job.x = x.data();
    job.y = y.data();
    job.z = z.data();
    job.ux = ux.data();
    job.uy = uy.data();
    job.uz = uz.data();
    job.vx = vx.data();
    job.vy = vy.data();
    job.vz = vz.data();
    job.arc = arc.data();
    job.twist = twist.data();
    mtu_kernels(SimdLevel::kPortable).build_frames(job);
  }
};

// The radius of the point on the chord between neighbours of radii `a` and `b` that is `after_a` rad from the former
// and `before_b` rad from the latter. Where they have different signs no radius leads to the chord; then the one that
// leads nearest to an end of it.
double chord_radius(double a, double b, double after_a, double before_b) {
  if (a * b > 0.0) return a * b * std::sin(after_a + before_b) / (a * std::sin(after_a) + b * std::sin(before_b));
  const bool nearer_a = std::abs(a * std::sin(after_a)) <= std::abs(b * std::sin(before_b));
  return nearer_a ? a * std::cos(after_a) : b * std::cos(before_b);
}

// Where the line origin + r direction meets a triangle.
std::optional<double> meet_triangle(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& a,
                                    const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, p = glm::cross(direction, ac), to = origin - a;
  const double determinant = glm::dot(ab, p);
  if (std::abs(determinant) < 1.0e-18) return std::nullopt;
  const double s = glm::dot(to, p) / determinant;
  const glm::dvec3 q = glm::cross(to, ab);
  const double t = glm::dot(direction, q) / determinant;
  constexpr double kRim = 1.0e-9;
  if (s < -kRim || t < -kRim || s + t > 1.0 + kRim) return std::nullopt;
  return glm::dot(ac, q) / determinant;
}

// The radius along `direction`, `turn` vertices after vertex 0, that lies on the coarse section.
double section_radius(const Level& coarse, std::uint32_t m, std::uint32_t K, double turn) {
  const std::uint32_t count = coarse.asset.muscles[m].section_vertices;
  const double j = std::floor(turn), step = 2.0 * kPi / count;
  const std::uint32_t first = static_cast<std::uint32_t>(j);
  return chord_radius(coarse.radius(m, K, first), coarse.radius(m, K, first + 1), (turn - j) * step,
                      (j + 1.0 - turn) * step);
}

// The radius at `turn` of a section that both levels have: a vertex that comes to lie within `reach` of one of the
// coarser section's goes as near to it as it can, lest a spike be cut off; all others go onto its sides.
double kept_radius(const Level& coarse, std::uint32_t m, std::uint32_t K, double turn, double reach) {
  const double corner = std::round(turn), off = turn - corner;
  if (std::abs(off) >= reach) return section_radius(coarse, m, K, turn);
  const double step = 2.0 * kPi / coarse.asset.muscles[m].section_vertices;
  return std::cos(off * step) * coarse.radius(m, K, static_cast<std::uint32_t>(corner));
}

// The place on a section at `turn`.
glm::dvec3 section_place(const Level& coarse, std::uint32_t m, std::uint32_t K, double turn) {
  const double angle = 2.0 * kPi * turn / coarse.asset.muscles[m].section_vertices;
  return coarse.centre(m, K) +
         section_radius(coarse, m, K, turn) * (std::cos(angle) * coarse.u(m, K) + std::sin(angle) * coarse.v(m, K));
}

// The radius that leads from `centre`, between coarse sections K and K + 1, along `direction` onto the surface between
// them, where it lies about `turn` vertices after vertex 0. Where nothing is met (beside an oblique end): nearest to
// the middle of the two sections' places.
double strip_radius(const Level& coarse, std::uint32_t m, std::uint32_t K, double turn, const glm::dvec3& centre,
                    const glm::dvec3& direction) {
  const std::uint32_t count = coarse.asset.muscles[m].section_vertices;
  const glm::dvec3 middle = 0.5 * (section_place(coarse, m, K, turn) + section_place(coarse, m, K + 1, turn));
  const double expected = glm::dot(middle - centre, direction);
  double best = expected, best_off = std::numeric_limits<double>::infinity();
  const std::uint32_t side = static_cast<std::uint32_t>(turn) + count;
  for (std::uint32_t i = side - 1; i <= side + 1; ++i) {
    const glm::dvec3 a = coarse.vertex(m, K, i), b = coarse.vertex(m, K, i + 1);
    const glm::dvec3 c = coarse.vertex(m, K + 1, i), d = coarse.vertex(m, K + 1, i + 1);
    for (const std::optional<double> r : {meet_triangle(centre, direction, a, b, d),
                                          meet_triangle(centre, direction, a, d, c)}) {
      if (!r || std::abs(*r - expected) >= best_off) continue;
      best = *r;
      best_off = std::abs(*r - expected);
    }
  }
  return best;
}

// Radii, and how far they move the surface at rest.
void morph_radii(const Level& fine, const Level& coarse, LevelMorph& morph) {
  const MorphedLines lines(fine, coarse);
  morph.radii = fine.asset.rest_radii;
  std::vector<float> moves;
  for (std::uint32_t m = 0; m < fine.asset.size(); ++m) {
    const MuscleLayout& layout = fine.asset.muscles[m];
    const std::uint32_t count = layout.section_vertices;
    const double coarse_count = coarse.asset.muscles[m].section_vertices;
    for (std::uint32_t k = 0; k < layout.section_count; ++k) {
      const Place place = coarse_place(fine, coarse, m, k);
      const std::uint32_t slot = fine.asset.slot(m, k);
      const glm::dvec3 centre(lines.x[slot], lines.y[slot], lines.z[slot]);
      const glm::dvec3 u(lines.ux[slot], lines.uy[slot], lines.uz[slot]);
      const glm::dvec3 v(lines.vx[slot], lines.vy[slot], lines.vz[slot]);
      // How far the sections are turned against the coarser ones, which two chains of frames never quite agree on.
      const double roll = angle_between(u, coarse.u(m, place.section), coarse.v(m, place.section)) / (2.0 * kPi);
      float* const radii = &morph.radii[fine.asset.radius(m, k)];
      for (std::uint32_t i = 0; i < count; ++i) {
        double turn = coarse_count * (double(i) / count + roll);
        if (std::abs(turn - std::round(turn)) < kSameTurn) turn = std::round(turn);
        turn -= coarse_count * std::floor(turn / coarse_count);
        const glm::dvec3 direction = fine.along(m, i, u, v);
        const double r = place.between ? strip_radius(coarse, m, place.section, turn, centre, direction)
                                       : kept_radius(coarse, m, place.section, turn, 0.5 * coarse_count / count);
        radii[i] = static_cast<float>(r);
        const double moved = glm::dot(centre + r * direction - fine.vertex(m, k, i), direction);
        moves.push_back(static_cast<float>(std::abs(moved)));
      }
      for (std::uint32_t i = count; i < layout.radius_stride; ++i) radii[i] = radii[i % count];
    }
  }
  if (moves.empty()) return;
  const auto most = moves.begin() + static_cast<std::ptrdiff_t>(kMostVertices * static_cast<double>(moves.size() - 1));
  std::nth_element(moves.begin(), most, moves.end());
  morph.error = *most;
}

void find_extent(const MuscleAsset& asset, MuscleLevels& levels) {
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    for (std::uint32_t k = 0; k < asset.muscles[m].section_count; ++k) {
      low = glm::min(low, rest_point(asset, m, k));
      high = glm::max(high, rest_point(asset, m, k));
    }
  }
  const glm::vec3 middle = 0.5f * (low + high);
  const auto place_of = [&](const PointBinding& point) {
    return glm::vec3(asset.rest_x[point.slot], asset.rest_y[point.slot], asset.rest_z[point.slot]);
  };
  if (asset.points.empty()) return;
  levels.anchor = *std::min_element(asset.points.begin(), asset.points.end(),
                                    [&](const PointBinding& a, const PointBinding& b) {
                                      return glm::distance(place_of(a), middle) < glm::distance(place_of(b), middle);
                                    });
  const glm::vec3 anchor = place_of(levels.anchor);
  for (std::uint32_t m = 0; m < asset.size(); ++m) {
    const MuscleLayout& layout = asset.muscles[m];
    for (std::uint32_t k = 0; k < layout.section_count; ++k) {
      const float* radii = &asset.rest_radii[asset.radius(m, k)];
      const auto larger = [](float a, float b) { return std::abs(a) < std::abs(b); };
      const float widest = std::abs(*std::max_element(radii, radii + layout.section_vertices, larger));
      levels.radius = std::max(levels.radius, glm::distance(anchor, rest_point(asset, m, k)) + widest);
    }
  }
}

}  // namespace

MuscleLevel coarser_level(MuscleLevel level) {
  const std::uint32_t half = level.section_vertices / 2;
  if (level.section_vertices % 2 == 0 && half % 2 == 0 && half >= 6) level.section_vertices = half;
  if (level.longitudinal_subdivision > 1) --level.longitudinal_subdivision;
  return level;
}

Result<std::shared_ptr<const MuscleLevels>> make_muscle_levels(
    std::span<const std::shared_ptr<const MuscleAsset>> finest_first) {
  assert(!finest_first.empty() && std::find(finest_first.begin(), finest_first.end(), nullptr) == finest_first.end());
  Diagnostics found;
  const auto levels = std::make_shared<MuscleLevels>();
  levels->assets.assign(finest_first.begin(), finest_first.end());
  double total = 0.0;
  for (std::size_t i = 0; i + 1 < finest_first.size(); ++i) {
    const Level fine{*finest_first[i]}, coarse{*finest_first[i + 1]};
    if (fine.asset.size() != coarse.asset.size()) {
      return Diagnostic{.file = {}, .line = 0, .column = 0, .path = fmt::format("level {}", i + 1),
                        .cause = fmt::format("{} muscles; the next finer level has {}", coarse.asset.size(),
                                             fine.asset.size()),
                        .remedy = "build all levels from the same muscles in the same order"};
    }
    for (std::uint32_t m = 0; m < fine.asset.size(); ++m) {
      if (auto mismatch = find_mismatch(fine, coarse, m)) found.errors.push_back(std::move(*mismatch));
    }
    if (!found.ok()) return found;
    LevelMorph& morph = levels->morphs.emplace_back();
    morph.points = morph_points(fine, coarse);
    morph.ends = morph_ends(fine, coarse);
    for (std::uint32_t m = 0; m < fine.asset.size(); ++m) morph.shifts.push_back(find_shift(fine, coarse, m));
    morph_radii(fine, coarse, morph);
    total += double{std::max(morph.error, kSmallestError)};
    const float before = i == 0 ? 0.0f : kMorphBand * levels->morphs[i - 1].complete;
    morph.complete = std::max(static_cast<float>(total), before);
  }
  find_extent(*finest_first.front(), *levels);
  return {std::shared_ptr<const MuscleLevels>(levels), std::move(found)};
}

std::size_t heap_bytes(const MuscleLevels& levels) {
  std::size_t sum = levels.assets.capacity() * sizeof(levels.assets[0]) +
                    levels.morphs.capacity() * sizeof(levels.morphs[0]);
  for (const LevelMorph& morph : levels.morphs) {
    sum += morph.points.capacity() * sizeof(PointBinding) + morph.ends.capacity() * sizeof(EndFrame) +
           morph.radii.capacity() * sizeof(float) + morph.shifts.capacity() * sizeof(std::uint32_t);
  }
  return sum;
}

}  // namespace fascicle::muscle
