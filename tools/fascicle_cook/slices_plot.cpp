#include "tools/fascicle_cook/slices_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include "tools/fascicle_cook/svg_plot.hpp"

namespace fascicle::cook {
namespace {

constexpr double kCirclePerimeter = 3.5449077018110318;  // of a circle with an area of 1
constexpr const char* kConvexColour = "#2a6fbb";
constexpr const char* kConcaveColour = "#d9661f";

// Those with a loop that has an area.
std::vector<const SliceOutline*> outlines_of(std::span<const MeshSlice> slices) {
  std::vector<const SliceOutline*> outlines;
  for (const MeshSlice& slice : slices) {
    if (!slice.loops.empty() && slice.loops[0].shape.quotient > 0.0) outlines.push_back(&slice.loops[0]);
  }
  return outlines;
}

const char* colour_of(const SliceOutline& outline) { return outline.shape.convex ? kConvexColour : kConcaveColour; }

// Filled where the centroid lies inside, hollow where it does not.
std::string dot_style(const char* colour, bool inside) {
  return inside ? fmt::format("fill=\"{}\" fill-opacity=\"0.55\" stroke=\"{}\" stroke-width=\"0.8\"", colour, colour)
                : fmt::format("fill=\"#ffffff\" stroke=\"{}\" stroke-width=\"2\"", colour);
}

void plot_quotients(Svg& svg, const Panel& panel, std::span<const SliceOutline* const> outlines) {
  draw_frame(svg, panel, std::max(tick_step(panel.x1 - panel.x0, 6.0), 1.0), 0.2,
             "perimeter of the slice scaled to an area of 1", "isoperimetric quotient q = 4\xCF\x80 A / P\xC2\xB2");
  svg.line(panel.left, panel.y(0.5), panel.left + panel.width, panel.y(0.5),
           "stroke=\"#777777\" stroke-width=\"1.2\" stroke-dasharray=\"6 4\"");

  // No shape lies elsewhere: with the area fixed the perimeter decides the quotient.
  std::vector<glm::dvec2> curve;
  for (int i = 0; i <= 200; ++i) {
    const double p = kCirclePerimeter + (panel.x1 - kCirclePerimeter) * i / 200.0;
    curve.emplace_back(panel.x(p), panel.y(4.0 * std::numbers::pi / (p * p)));
  }
  svg.path(curve, false, "fill=\"none\" stroke=\"#222222\" stroke-width=\"1.5\"");
  for (const SliceOutline* outline : outlines) {
    svg.circle(panel.x(outline->shape.normalised_perimeter), panel.y(outline->shape.quotient), 5.0,
               dot_style(colour_of(*outline), outline->shape.centroid_inside));
  }
  struct Known {
    const char* name;
    double quotient;
  };
  for (const Known& known : {Known{"circle", 1.0}, Known{"hexagon", 0.9069}, Known{"square", 0.7854},
                             Known{"rectangle 1 : 4", 0.5027}, Known{"rectangle 1 : 10", 0.2596}}) {
    const double p = std::sqrt(4.0 * std::numbers::pi / known.quotient);
    if (p > panel.x1) continue;
    svg.circle(panel.x(p), panel.y(known.quotient), 2.2, "fill=\"#222222\"");
    svg.line(panel.x(p) + 4, panel.y(known.quotient) - 3, panel.x(p) + 17, panel.y(known.quotient) - 9,
             "stroke=\"#999999\" stroke-width=\"1\"");
    svg.text(panel.x(p) + 20, panel.y(known.quotient) - 8, 12, "start", known.name, "#555555");
  }
}

// How many slices have about that quotient: bars beside the panel of quotients, whose axis they share.
void plot_counts(Svg& svg, const Panel& panel, std::span<const SliceOutline* const> outlines) {
  constexpr std::size_t kBins = 20;
  std::array<std::size_t, kBins> bins{};
  for (const SliceOutline* outline : outlines) {
    bins[std::min(static_cast<std::size_t>(outline->shape.quotient * kBins), kBins - 1)] += 1;
  }
  const std::size_t most = std::max<std::size_t>(*std::ranges::max_element(bins), 1);
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (bins[bin] == 0) continue;
    const double length = (panel.width - 32.0) * static_cast<double>(bins[bin]) / static_cast<double>(most);
    const double low = static_cast<double>(bin) / kBins, high = static_cast<double>(bin + 1) / kBins;
    const double top = panel.y(high), bottom = panel.y(low);
    svg.box(panel.left, top + 1, length, bottom - top - 2, "fill=\"#b9c1cc\"");
    svg.text(panel.left + length + 5, 0.5 * (top + bottom) + 4, 12, "start", fmt::format("{}", bins[bin]), "#555555");
  }
  svg.line(panel.left, panel.top, panel.left, panel.top + panel.height, kAxisStyle);
  svg.text(panel.left + 0.5 * panel.width, panel.top + panel.height + 45, 15, "middle", "slices");
}

void plot_outlines(Svg& svg, const Panel& panel, std::span<const SliceOutline* const> outlines) {
  const double step = std::max(tick_step(panel.x1 - panel.x0, 7.0), 0.5);
  draw_frame(svg, panel, step, step, "along the longer axis, in lengths of which the area is the square", "across it");
  const double opacity = std::clamp(25.0 / static_cast<double>(std::max<std::size_t>(outlines.size(), 1)), 0.18, 0.8);
  for (const SliceOutline* outline : outlines) {
    std::vector<glm::dvec2> points = normalise_outline(outline->loop);
    for (glm::dvec2& p : points) p = {panel.x(p.x), panel.y(p.y)};
    svg.path(points, true,
             fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\" stroke-opacity=\"{:.2f}\"",
                         colour_of(*outline), opacity));
  }
  svg.circle(panel.x(0.0), panel.y(0.0), panel.x(1.0 / std::sqrt(std::numbers::pi)) - panel.x(0.0),
             "fill=\"none\" stroke=\"#111111\" stroke-width=\"1.6\" stroke-dasharray=\"7 5\"");
  svg.circle(panel.x(0.0), panel.y(0.0), 2.5, "fill=\"#111111\"");
}

}  // namespace

std::string plot_slices(const std::string& title, std::span<const MeshSlice> slices) {
  const std::vector<const SliceOutline*> outlines = outlines_of(slices);
  double most_perimeter = 5.6, reach = 0.9;
  std::size_t convex = 0, outside = 0;
  for (const SliceOutline* outline : outlines) {
    most_perimeter = std::max(most_perimeter, outline->shape.normalised_perimeter + 0.3);
    for (const glm::dvec2& p : normalise_outline(outline->loop)) {
      reach = std::max({reach, std::abs(p.x) + 0.05, std::abs(p.y) + 0.05});
    }
    convex += outline->shape.convex ? 1 : 0;
    outside += outline->shape.centroid_inside ? 0 : 1;
  }
  const SliceSummary summary = summarise_slices(slices);

  Svg svg(1320, 730);
  svg.text(40, 42, 21, "start", title, "#111111", " font-weight=\"bold\"");
  svg.text(40, 68, 14, "start",
           fmt::format("{} slices; q: mean {:.2f}, median {:.2f}, above 0.5 in {:.0f} %; {:.0f} % concave; "
                       "centroid outside in {:.0f} %",
                       summary.slices, summary.mean_quotient, summary.median_quotient, 100.0 * summary.share_round,
                       100.0 * summary.share_concave, 100.0 * summary.share_centroid_outside),
           "#444444");

  plot_quotients(svg, {90, 130, 450, 520, 3.0, most_perimeter, 0.0, 1.05}, outlines);
  plot_counts(svg, {556, 130, 110, 520, 0.0, 1.0, 0.0, 1.05}, outlines);
  plot_outlines(svg, {760, 130, 520, 520, -reach, reach, -reach, reach}, outlines);

  // Legends, over their panels.
  double x = 90;
  const auto dot = [&](const char* colour, bool inside, const std::string& words) {
    svg.circle(x + 6, 108, 5.0, dot_style(colour, inside));
    svg.text(x + 18, 113, 14, "start", words);
    x += 46.0 + 7.6 * static_cast<double>(words.size());
  };
  dot(kConvexColour, true, fmt::format("convex ({})", convex));
  dot(kConcaveColour, true, fmt::format("concave ({})", outlines.size() - convex - outside));
  dot(kConcaveColour, false, fmt::format("concave with the centroid outside ({})", outside));
  svg.line(760, 108, 790, 108, "stroke=\"#111111\" stroke-width=\"1.6\" stroke-dasharray=\"7 5\"");
  svg.text(798, 113, 14, "start", "circle of the same area; the dot is every slice's centroid");
  return svg.finish();
}

}  // namespace fascicle::cook
