#include "modules/muscle/asset/fit/fit_surface.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include <glm/geometric.hpp>

#include "engine/geometry/winding_number.hpp"
#include "modules/muscle/asset/fit/head_region.hpp"

namespace fascicle::muscle {
namespace {

constexpr int kSamplesAlongLine = 48;  // at least, over the mesh's size, where the winding number must be sampled
constexpr int kBisections = 24;
// On a line that crosses more triangles of an unsound mesh than this its own crossings stand for the winding number: of
// triangles without order every line crosses thousands, and each winding number there is a sum over most of them.
constexpr std::size_t kMostCrossings = 64;

}  // namespace

// The field, made when it is first asked for: a sound mesh hardly ever needs it.
struct FitSurface::Winding {
  std::once_flag made;
  std::optional<WindingField> field;
};

FitSurface::FitSurface(const TriangleMesh& mesh, RayScene scene, bool sound, const HeadRegion* region)
    : mesh_(mesh), scene_(std::move(scene)), region_(region), sound_(sound), winding_(std::make_unique<Winding>()) {
  const Bounds& bounds = scene_.bounds();
  middle_ = 0.5 * (glm::dvec3(bounds.lower) + glm::dvec3(bounds.upper));
  reach_ = 0.51 * double{bounds.diagonal()};
}

FitSurface::~FitSurface() = default;

bool FitSurface::contains(const glm::dvec3& point) const {
  return winds_round(point) && (region_ == nullptr || region_->contains(point));
}

bool FitSurface::winds_round(const glm::dvec3& point) const {
  std::call_once(winding_->made, [&] { winding_->field.emplace(mesh_); });
  return winding_->field->inside(point);
}

void FitSurface::append_by_winding(const Line& line, std::span<const LineCrossing> crossings,
                                   std::vector<InsideInterval>& intervals) const {
  const glm::dvec3 origin = line.origin, direction = line.direction;
  const auto inside = [&](double t) { return winds_round(origin + t * direction); };
  const double start = glm::dot(middle_ - origin, direction) - reach_, end = start + 2.0 * reach_;
  const std::size_t first = intervals.size();
  const auto add = [&](double from, double to) {
    if (intervals.size() > first && from <= intervals.back().to) intervals.back().to = to;
    else intervals.push_back({from, to});
  };
  if (crossings.size() > kMostCrossings) {
    int total = 0, entered = 0;
    for (const LineCrossing& crossing : crossings) total += crossing.exit ? -1 : 1;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
      entered += crossings[i].exit ? -1 : 1;
      if (2 * entered - total >= 1) add(crossings[i].t, crossings[i + 1].t);  // the mean from both ends >= 1/2
    }
    return;
  }
  // Between two crossings the winding number has no jumps: it is sampled, and bisected where it passes one half.
  double from = start;
  for (std::size_t i = 0; i <= crossings.size(); ++i) {
    const double to = i < crossings.size() ? std::clamp(double{crossings[i].t}, from, end) : end;
    const int samples = 1 + static_cast<int>((to - from) / (2.0 * reach_) * kSamplesAlongLine);
    double last = from;
    bool last_inside = false;
    for (int s = 0; s < samples; ++s) {
      const double t = from + (to - from) * (s + 0.5) / samples;
      const bool here = inside(t);
      double change = s == 0 ? from : 0.5 * (last + t);
      if (s > 0 && here != last_inside) {
        double low = last, high = t;
        for (int round = 0; round < kBisections; ++round) {
          const double middle = 0.5 * (low + high);
          (inside(middle) == last_inside ? low : high) = middle;
        }
        change = 0.5 * (low + high);
      }
      if (s > 0 && last_inside) add(last, here ? t : change);
      if (here) add(s > 0 && !last_inside ? change : (s == 0 ? from : last), t);
      last = t;
      last_inside = here;
    }
    if (last_inside) add(last, to);
    from = to;
  }
}

void FitSurface::find_inside(std::span<const Line> lines, std::vector<std::uint32_t>& starts,
                             std::vector<InsideInterval>& intervals) const {
  find_inside_mesh(lines, starts, intervals);
  if (region_ == nullptr) return;
  std::vector<std::uint32_t> clipped_starts{0};
  std::vector<InsideInterval> clipped;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t first = clipped.size();
    clipped.insert(clipped.end(), intervals.begin() + starts[i], intervals.begin() + starts[i + 1]);
    region_->clip(lines[i].origin, lines[i].direction, first, clipped);
    clipped_starts.push_back(static_cast<std::uint32_t>(clipped.size()));
  }
  starts = std::move(clipped_starts);
  intervals = std::move(clipped);
}

void FitSurface::find_inside_mesh(std::span<const Line> lines, std::vector<std::uint32_t>& starts,
                                  std::vector<InsideInterval>& intervals) const {
  std::vector<std::uint32_t> crossing_starts;
  std::vector<LineCrossing> all;
  scene_.cast_all(lines, crossing_starts, all);
  starts.assign(1, 0);
  intervals.clear();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::span<const LineCrossing> crossings =
        std::span(all).subspan(crossing_starts[i], crossing_starts[i + 1] - crossing_starts[i]);
    const std::size_t first = intervals.size();
    int winding = 0;
    bool counts = sound_;
    for (const LineCrossing& crossing : crossings) {
      winding += crossing.exit ? -1 : 1;
      if (winding < 0 || winding > 1) met_overlaps_ = true;
      counts = counts && winding >= 0;
      if (!counts) break;
      if (!crossing.exit && winding == 1) intervals.push_back({crossing.t, crossing.t});
      if (crossing.exit && winding == 0) intervals.back().to = crossing.t;
    }
    if (!counts || winding != 0) {  // a defect, or a line along an edge
      intervals.resize(first);
      append_by_winding(lines[i], crossings, intervals);
    }
    starts.push_back(static_cast<std::uint32_t>(intervals.size()));
  }
}

void FitSurface::cast_by_stretches(std::span<const Line> lines, std::span<LineExtremes> extremes) const {
  std::vector<std::uint32_t> starts;
  std::vector<InsideInterval> intervals;
  find_inside(lines, starts, intervals);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    extremes[i] = {};
    if (starts[i] == starts[i + 1]) continue;
    extremes[i].first_entry = static_cast<float>(intervals[starts[i]].from);
    extremes[i].last_exit = static_cast<float>(intervals[starts[i + 1] - 1].to);
    extremes[i].crossings = 2 * (starts[i + 1] - starts[i]);
  }
}

void FitSurface::cast(std::span<const Line> lines, std::span<LineExtremes> extremes) const {
  if (sound_ && region_ == nullptr) {
    scene_.cast(lines, extremes);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      LineExtremes& found = extremes[i];
      // Seen from one side alone, the line no more than touches the mesh.
      if (std::isinf(found.first_entry) || std::isinf(found.last_exit)) found = {};
      else if (found.backwards) cast_by_stretches(lines.subspan(i, 1), extremes.subspan(i, 1));
    }
    return;
  }
  cast_by_stretches(lines, extremes);
}

}  // namespace fascicle::muscle
