#include "tools/fascicle_cook/fibres_report.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "modules/muscle/asset/fibres/fibre_direction.hpp"
#include "tools/fascicle_cook/svg_plot.hpp"

namespace fascicle::cook {
namespace {

using namespace muscle;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kView = 420.0, kMargin = 20.0, kTitle = 40.0;  // pixels

// From magenta to green by way of blue: fibres that begin side by side look alike.
std::string colour_of(double share) {
  const auto part = [](double x) { return static_cast<int>(std::clamp(x, 0.0, 1.0) * 200.0 + 20.0); };
  return fmt::format("#{:02x}{:02x}{:02x}", part(1.0 - 1.6 * share), part(1.4 * share - 0.4),
                     part(1.0 - std::abs(2.0 * share - 0.9)));
}

}  // namespace

const char* to_string(FibreMethod method) { return method == FibreMethod::kSurface ? "surface" : "isocontours"; }

const char* to_string(FibreArrangement arrangement) {
  switch (arrangement) {
    case FibreArrangement::kPennate: return "pennate";
    case FibreArrangement::kFan: return "fan";
    case FibreArrangement::kParallel: break;
  }
  return "parallel";
}

std::string fibres_table(const MuscleFibres& muscle) {
  const FibreBundleAsset& bundle = *muscle.bundle;
  const FibreBundleSettings& settings = bundle.settings;
  std::string text;
  const auto line = [&](std::string_view what, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "  {:<26} {}\n", what, value);
  };
  text += muscle.surface->name + "\n";
  std::string how = to_string(settings.method);
  if (settings.method == FibreMethod::kIsocontour) how += std::string(", ") + to_string(settings.arrangement);
  if (settings.method == FibreMethod::kIsocontour && settings.arrangement == FibreArrangement::kPennate)
    how += fmt::format(", {:.4g} degrees", static_cast<double>(settings.pennation) * kDegrees);
  line("method", how);
  line("fibres", fmt::format("{} of {} points", bundle.count, bundle.points_per_fibre));
  std::map<std::uint32_t, std::size_t> heads;
  for (const std::uint32_t head : bundle.head) ++heads[head];
  if (heads.size() > 1)
    for (const auto& [head, count] : heads) line(fmt::format("  of head {}", head), fmt::format("{}", count));
  const auto [least, most] = std::ranges::minmax(bundle.rest_length);
  const double sum = std::accumulate(bundle.rest_length.begin(), bundle.rest_length.end(), 0.0);
  line("length min/mean/max (mm)", fmt::format("{:.1f} / {:.1f} / {:.1f}", 1e3 * static_cast<double>(least),
                                               1e3 * sum / bundle.count, 1e3 * static_cast<double>(most)));
  line("points pulled inside",
       fmt::format("{} of {}, by {:.2f} mm at most", bundle.pulled_in, bundle.rest_points.size(),
                   1e3 * static_cast<double>(bundle.most_pulled)));
  const DirectionError error = measure_direction(bundle, muscle.surface->fibres);
  std::string angles = "no fibres are given on the surface";
  if (error.places > 0) {
    angles = fmt::format("mean {:.2f}, largest {:.2f}, against {} surface fibres at {} places", error.mean * kDegrees,
                         error.max * kDegrees, muscle.surface->fibres.size(), error.places);
  }
  line("direction error (degrees)", angles);
  return text;
}

std::string fibres_csv(std::span<const MuscleFibres> muscles) {
  std::string csv = "muscle,fibre,head,length_mm,point,x_m,y_m,z_m\n";
  for (const MuscleFibres& muscle : muscles) {
    const FibreBundleAsset& bundle = *muscle.bundle;
    for (std::size_t i = 0; i < bundle.rest_points.size(); ++i) {
      const std::size_t fibre = i / bundle.points_per_fibre;
      const glm::vec3& p = bundle.rest_points[i];
      const double length_mm = 1e3 * static_cast<double>(bundle.rest_length[fibre]);
      fmt::format_to(std::back_inserter(csv), "{},{},{},{:.4f},{},{:.6f},{:.6f},{:.6f}\n", muscle.surface->name, fibre,
                     bundle.head[fibre], length_mm, i % bundle.points_per_fibre, p.x, p.y, p.z);
    }
  }
  return csv;
}

std::string fibres_svg(const MuscleFibres& muscle) {
  const FibreBundleAsset& bundle = *muscle.bundle;
  glm::vec3 lower(std::numeric_limits<float>::max()), upper(std::numeric_limits<float>::lowest());
  for (const SurfacePoint& p : std::span(muscle.surface->rest).first(muscle.surface->vertex_count)) {
    lower = glm::min(lower, glm::vec3(p.x, p.y, p.z));
    upper = glm::max(upper, glm::vec3(p.x, p.y, p.z));
  }
  const glm::dvec3 size(upper - lower);
  const double scale = (kView - 2.0 * kMargin) / std::max({size.x, size.y, size.z, 1.0e-6});
  Svg svg(2.0 * kView, kView + kTitle);
  svg.text(kMargin, 26, 15, "start",
           fmt::format("{}: {} fibres ({})", muscle.surface->name, bundle.count, to_string(bundle.settings.method)));
  struct View {
    int across;
    double left;
  };
  for (const View view : {View{0, kMargin}, View{2, kView + kMargin}}) {
    const auto place = [&](const glm::vec3& p) {
      return glm::dvec2(view.left + scale * static_cast<double>(p[view.across] - lower[view.across]),
                        kTitle + kMargin + scale * static_cast<double>(upper.y - p.y));
    };
    const auto draw = [&](std::span<const glm::vec3> points, const std::string& style) {
      std::vector<glm::dvec2> path;
      for (const glm::vec3& p : points) path.push_back(place(p));
      svg.path(path, false, style);
    };
    for (std::size_t f = 0; f < bundle.count; ++f) {
      const auto points = std::span(bundle.rest_points).subspan(f * bundle.points_per_fibre, bundle.points_per_fibre);
      const double share = size.x > 0.0 ? static_cast<double>(points[0].x - lower.x) / size.x : 0.5;
      draw(points, fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"0.6\"", colour_of(share)));
    }
    for (const FibreLine& given : muscle.surface->fibres)
      draw(given.points, "fill=\"none\" stroke=\"#000000\" stroke-width=\"2\"");
  }
  return svg.finish();
}

}  // namespace fascicle::cook
