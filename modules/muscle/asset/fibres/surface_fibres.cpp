#include "modules/muscle/asset/fibres/surface_fibres.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/finite.hpp"
#include "engine/geometry/ray_scene.hpp"
#include "modules/muscle/asset/fibres/fibre_faults.hpp"
#include "modules/muscle/asset/fibres/fibre_sheet.hpp"
#include "modules/muscle/asset/fibres/surface_mesh.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kNear = 0.1;              // of the muscle's size: a fibre that stays further off is not the muscle's
constexpr std::size_t kColumns = 33;       // across a sheet
constexpr std::size_t kRows = FibreSheet::kStations;
constexpr double kLeastUnder = 0.5;        // of a sheet's places must have muscle under them
constexpr int kSmoothings = 3;             // of the depths, over neighbours
constexpr double kSkin = 0.04;             // of the thickness that is left free on both faces
constexpr double kSpreadX = 0.7548776662466927, kSpreadY = 0.5698402909980532;  // see fibre_template.cpp

// What lies under one place of a sheet, along its inward normal.
struct Under {
  glm::dvec3 place{0.0}, inward{0.0};
  double entry = 0.0, exit = 0.0;          // m
  bool known = false;
};

// A head's muscle: a sheet with depth.
struct Slab {
  FibreSheet sheet;
  std::vector<Under> under;                // by column, then row
  std::vector<double> volume_before;       // m^3, by column: what lies before it; the last is all
  Under& at(std::size_t column, std::size_t row) { return under[column * kRows + row]; }
  const Under& at(std::size_t column, std::size_t row) const { return under[column * kRows + row]; }
};

double across(std::size_t column) { return static_cast<double>(column) / static_cast<double>(kColumns - 1); }

// Places, and normals by the differences of neighbours; zero where the sheet has shrunk to a point.
void lay_out(Slab& slab) {
  for (std::size_t c = 0; c < kColumns; ++c)
    for (std::size_t r = 0; r < kRows; ++r) slab.at(c, r).place = slab.sheet.at(across(c), r);
  for (std::size_t c = 0; c < kColumns; ++c) {
    for (std::size_t r = 0; r < kRows; ++r) {
      const glm::dvec3 u = slab.at(std::min(c + 1, kColumns - 1), r).place - slab.at(c > 0 ? c - 1 : 0, r).place;
      const glm::dvec3 v = slab.at(c, std::min(r + 1, kRows - 1)).place - slab.at(c, r > 0 ? r - 1 : 0).place;
      const glm::dvec3 n = glm::cross(u, v);
      const double length = glm::length(n);
      slab.at(c, r).inward = length > 0.0 ? n / length : glm::dvec3(0.0);
    }
  }
}

// One sense for the whole sheet: against the outward normals of the surface next to it.
void turn_inward(const TriangleMesh& mesh, const ClosestPoints& surface, Slab& slab) {
  double out = 0.0;
  for (const Under& under : slab.under) {
    const std::uint32_t t = surface.at(glm::vec3(under.place)).triangle;
    const glm::dvec3 a(mesh.positions[mesh.indices[3 * t]]), b(mesh.positions[mesh.indices[3 * t + 1]]),
        c(mesh.positions[mesh.indices[3 * t + 2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    if (length > 0.0) out += glm::dot(normal / length, under.inward);
  }
  if (out > 0.0)
    for (Under& under : slab.under) under.inward = -under.inward;
}

// The part of the muscle on each line whose entry is nearest to the sheet. Returns the share of lines that found one.
double look_under(const RayScene& scene, Slab& slab) {
  std::vector<Line> lines;
  for (const Under& under : slab.under) {
    const bool none = under.inward == glm::dvec3(0.0);
    lines.push_back({glm::vec3(under.place), none ? glm::vec3(0, 1, 0) : glm::vec3(under.inward)});
  }
  std::vector<std::uint32_t> starts;
  std::vector<LineCrossing> crossings;
  scene.cast_all(lines, starts, crossings);
  std::size_t found = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Under& under = slab.under[i];
    if (under.inward == glm::dvec3(0.0)) continue;
    for (std::uint32_t k = starts[i]; k + 1 < starts[i + 1]; ++k) {
      if (crossings[k].exit || !crossings[k + 1].exit) continue;
      const double entry = static_cast<double>(crossings[k].t);
      if (under.known && std::abs(entry) >= std::abs(under.entry)) continue;
      under.entry = entry;
      under.exit = static_cast<double>(crossings[k + 1].t);
      under.known = true;
    }
    found += under.known;
  }
  return static_cast<double>(found) / static_cast<double>(lines.size());
}

// Places without an answer take the mean of their neighbours' until all have one; then all are smoothed.
void settle_depths(Slab& slab) {
  const auto mean_about = [&](std::size_t c, std::size_t r, double& entry, double& exit) {
    double weight = 0.0;
    entry = exit = 0.0;
    for (std::size_t i = c > 0 ? c - 1 : 0; i <= std::min(c + 1, kColumns - 1); ++i) {
      for (std::size_t j = r > 0 ? r - 1 : 0; j <= std::min(r + 1, kRows - 1); ++j) {
        if (!slab.at(i, j).known) continue;
        const double w = (i == c ? 2.0 : 1.0) * (j == r ? 2.0 : 1.0);
        entry += w * slab.at(i, j).entry;
        exit += w * slab.at(i, j).exit;
        weight += w;
      }
    }
    if (weight > 0.0) entry /= weight, exit /= weight;
    return weight > 0.0;
  };
  const auto pass = [&](bool all) {
    std::vector<Under> next = slab.under;
    bool changed = false;
    for (std::size_t c = 0; c < kColumns; ++c) {
      for (std::size_t r = 0; r < kRows; ++r) {
        Under& under = next[c * kRows + r];
        if (under.known && !all) continue;
        under.known = mean_about(c, r, under.entry, under.exit);
        changed = true;
      }
    }
    slab.under = std::move(next);
    return changed;
  };
  while (pass(false)) {
  }
  for (int i = 0; i < kSmoothings; ++i) pass(true);
}

void measure_volume(Slab& slab) {
  slab.volume_before.assign(kColumns, 0.0);
  for (std::size_t c = 0; c + 1 < kColumns; ++c) {
    double sum = 0.0;
    for (std::size_t r = 0; r + 1 < kRows; ++r) {
      const Under &a = slab.at(c, r), &b = slab.at(c + 1, r), &d = slab.at(c, r + 1), &e = slab.at(c + 1, r + 1);
      const double area = 0.5 * (glm::length(glm::cross(b.place - a.place, d.place - a.place)) +
                                 glm::length(glm::cross(b.place - e.place, d.place - e.place)));
      sum += 0.25 * area * (a.exit - a.entry + b.exit - b.entry + d.exit - d.entry + e.exit - e.entry);
    }
    slab.volume_before[c + 1] = slab.volume_before[c] + sum;
  }
}

// `share` of the head's volume lies before the fibre, `depth` of the thickness above it.
std::vector<glm::dvec3> fibre_of(const Slab& slab, double share, double depth) {
  const double before = share * slab.volume_before.back();
  const auto end = static_cast<std::size_t>(std::ranges::upper_bound(slab.volume_before, before) -
                                            slab.volume_before.begin());
  const std::size_t c = std::clamp<std::size_t>(end, 1, kColumns - 1) - 1;
  const double step = slab.volume_before[c + 1] - slab.volume_before[c];
  const double f = step > 0.0 ? glm::clamp((before - slab.volume_before[c]) / step, 0.0, 1.0) : 0.5;
  const double place = glm::mix(across(c), across(c + 1), f);
  std::vector<glm::dvec3> curve(kRows);
  for (std::size_t r = 0; r < kRows; ++r) {
    const Under &a = slab.at(c, r), &b = slab.at(c + 1, r);
    const double entry = glm::mix(a.entry, b.entry, f), exit = glm::mix(a.exit, b.exit, f);
    glm::dvec3 inward = glm::mix(a.inward, b.inward, f);
    const double length = glm::length(inward);
    if (length > 0.0) inward /= length;
    curve[r] = slab.sheet.at(place, r) + inward * glm::mix(entry, exit, glm::mix(kSkin, 1.0 - kSkin, depth));
  }
  return curve;
}

// The fibres by head; faults where they cannot be used.
std::map<std::uint32_t, std::vector<std::vector<glm::dvec3>>> sort_by_head(const SurfaceAsset& surface,
                                                                           const ClosestPoints& nearest,
                                                                           Diagnostics& faults) {
  std::map<std::uint32_t, std::vector<std::vector<glm::dvec3>>> heads;
  for (std::size_t i = 0; i < surface.fibres.size(); ++i) {
    const FibreLine& fibre = surface.fibres[i];
    std::vector<glm::dvec3> points(fibre.points.begin(), fibre.points.end());
    if (points.size() < 2 || !std::ranges::all_of(points, [](const glm::dvec3& p) { return is_finite(p); }) ||
        !(curve_length(points) > 0.0)) {
      faults.errors.push_back(fibre_fault(surface, fmt::format("surface fibre {} has no length", i + 1),
                                          "give every fibre two points or more at different places"));
      continue;
    }
    float distance = std::numeric_limits<float>::max();
    for (const glm::dvec3& p : resample_curve(points, kRows))
      distance = std::min(distance, nearest.at(glm::vec3(p)).distance);
    if (static_cast<double>(distance) > kNear * static_cast<double>(surface.size)) {
      faults.errors.push_back(fibre_fault(
          surface, fmt::format("surface fibre {} does not touch the muscle: it stays {:.3g} mm off", i + 1,
                               1000.0 * static_cast<double>(distance)),
          "is it another muscle's, or in another unit or frame?"));
      continue;
    }
    heads[fibre.head].push_back(std::move(points));
  }
  return heads;
}

// Mean of the attached vertices of one end; nothing attached: false.
bool end_place(const SurfaceAsset& surface, bool origin, glm::dvec3& place) {
  double count = 0.0;
  place = glm::dvec3(0.0);
  for (const AttachedVertex& a : surface.attached) {
    if (surface.attachments[a.attachment].origin != origin) continue;
    const SurfacePoint& p = surface.rest[a.vertex];
    place += glm::dvec3(p.x, p.y, p.z);
    count += 1.0;
  }
  if (count > 0.0) place /= count;
  return count > 0.0;
}

// So that fibres run from the origin to the insertion, where both are known.
void turn_from_origin(const SurfaceAsset& surface, FibreSheet& sheet) {
  glm::dvec3 origin, insertion;
  if (!end_place(surface, true, origin) || !end_place(surface, false, insertion)) return;
  const glm::dvec3 first = sheet.at(0.5, 0), last = sheet.at(0.5, FibreSheet::kStations - 1);
  const double as_is = glm::distance(first, origin) + glm::distance(last, insertion);
  if (as_is > glm::distance(last, origin) + glm::distance(first, insertion)) sheet.turn_round();
}

// `count` in proportion to the volumes, every head one at least while there are enough.
std::vector<std::uint32_t> share_out(std::uint32_t count, const std::vector<Slab>& slabs) {
  double all = 0.0;
  for (const Slab& slab : slabs) all += slab.volume_before.back();
  std::vector<std::uint32_t> shares;
  double volume = 0.0;
  std::uint32_t given = 0;
  for (std::size_t h = 0; h < slabs.size(); ++h) {
    volume += slabs[h].volume_before.back();
    const auto upto = all > 0.0 ? static_cast<std::uint32_t>(std::lround(count * (volume / all))) : count;
    const auto left = static_cast<std::uint32_t>(slabs.size() - h - 1);
    const std::uint32_t most = count > given + left ? count - given - left : 0;
    shares.push_back(std::min(std::max(upto > given ? upto - given : 0u, 1u), std::max(most, count > given ? 1u : 0u)));
    given += shares.back();
  }
  return shares;
}

}  // namespace

Result<FibreCurves> make_surface_fibres(const SurfaceAsset& surface, const FibreBundleSettings& settings) {
  if (surface.fibres.empty())
    return fibre_fault(surface, "it has no fibres on its surface",
                       "give some with its field \"fibres\", or use the method \"isocontours\"");
  const TriangleMesh mesh = surface_mesh(surface);
  const ClosestPoints nearest(mesh);
  const RayDevice device;
  const RayScene scene(device, mesh);
  Diagnostics faults;
  std::vector<Slab> slabs;
  std::vector<std::uint32_t> heads;
  for (auto& [head, fibres] : sort_by_head(surface, nearest, faults)) {
    if (fibres.size() < 2) {
      faults.errors.push_back(fibre_fault(surface, fmt::format("head {} has one fibre on its surface", head),
                                          "give two or more: inner fibres lie between and under them"));
      continue;
    }
    FibreSheet sheet(fibres);
    turn_from_origin(surface, sheet);
    Slab slab{std::move(sheet), std::vector<Under>(kColumns * kRows), {}};
    lay_out(slab);
    turn_inward(mesh, nearest, slab);
    if (look_under(scene, slab) < kLeastUnder) {
      faults.errors.push_back(
          fibre_fault(surface, fmt::format("the muscle does not lie under the fibres of head {}", head),
                      "give fibres that lie on its surface side by side"));
      continue;
    }
    settle_depths(slab);
    measure_volume(slab);
    slabs.push_back(std::move(slab));
    heads.push_back(head);
  }
  if (!faults.ok()) return faults;

  FibreCurves fibres;
  fibres.points_per_fibre = settings.points;
  const std::vector<std::uint32_t> shares = share_out(settings.count, slabs);
  for (std::size_t h = 0; h < slabs.size(); ++h) {
    for (std::uint32_t i = 1; i <= shares[h]; ++i) {
      const std::vector<glm::dvec3> curve =
          fibre_of(slabs[h], std::fmod(0.5 + kSpreadX * i, 1.0), std::fmod(0.5 + kSpreadY * i, 1.0));
      const std::vector<glm::dvec3> even = resample_curve(smooth_curve(curve), settings.points);
      fibres.points.insert(fibres.points.end(), even.begin(), even.end());
      fibres.head.push_back(heads[h]);
    }
  }
  return fibres;
}

}  // namespace fascicle::muscle
