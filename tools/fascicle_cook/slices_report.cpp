#include "tools/fascicle_cook/slices_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/loop/quoted_csv.hpp"

namespace fascicle::cook {

std::string slices_csv(std::span<const MeshSlice> slices) {
  std::string text =
      "mesh,fraction,loop,closed,area_mm2,perimeter_mm,quotient,normalised_perimeter,dent,convex,centroid_inside\n";
  for (const MeshSlice& slice : slices) {
    const std::string head = fmt::format("{},{:.6g}", quoted_csv(slice.mesh), slice.fraction);
    if (slice.loops.empty()) text += head + ",,,,,,,,,\n";
    for (std::size_t i = 0; i < slice.loops.size(); ++i) {
      const auto& [loop, shape] = slice.loops[i];
      text += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{}\n", head, i, loop.closed ? 1 : 0,
                          1e6 * loop.area, 1e3 * loop.perimeter, shape.quotient, shape.normalised_perimeter,
                          shape.dent, shape.convex ? 1 : 0, shape.centroid_inside ? 1 : 0);
    }
  }
  return text;
}

std::string slices_table(std::span<const MeshSlice> slices) {
  std::size_t width = 4;
  for (const MeshSlice& slice : slices) width = std::max(width, slice.mesh.size());
  std::string text = fmt::format("{:<{}}    at  area mm^2  perimeter mm      q  shape\n", "mesh", width);
  for (const MeshSlice& slice : slices) {
    text += fmt::format("{:<{}} {:5.3g}", slice.mesh, width, slice.fraction);
    if (slice.loops.empty()) {
      text += "  the plane misses the mesh\n";
      continue;
    }
    const auto& [loop, shape] = slice.loops[0];
    text += fmt::format(" {:10.1f}  {:12.1f}  {:5.3f}  {}{}{}{}\n", 1e6 * std::abs(loop.area), 1e3 * loop.perimeter,
                        shape.quotient, shape.convex ? "convex" : "concave",
                        shape.centroid_inside ? "" : ", centroid outside", loop.closed ? "" : ", open",
                        slice.loops.size() > 1 ? fmt::format(", the largest of {} loops", slice.loops.size()) : "");
  }
  return text;
}

std::string describe_slices(const SliceSummary& summary, std::size_t meshes) {
  std::string text = fmt::format("{} slice{} of {} mesh{}", summary.slices, summary.slices == 1 ? "" : "s", meshes,
                                 meshes == 1 ? "" : "es");
  if (summary.missed > 0) {
    text += fmt::format("; {} more plane{} missed", summary.missed, summary.missed == 1 ? "" : "s");
  }
  if (summary.slices == 0) return text + "\n";
  return text + fmt::format(
                    "\n"
                    "  isoperimetric quotient  mean {:.3f}, median {:.3f}  "
                    "(the method's authors, on 72 slices of 24 meshes: about 0.6)\n"
                    "  quotient above 0.5      {:.0f} %  (75 %)\n"
                    "  concave                 {:.0f} %  (more than half)\n"
                    "  centroid outside        {:.0f} %\n"
                    "  in several loops        {:.0f} %\n",
                    summary.mean_quotient, summary.median_quotient, 100.0 * summary.share_round,
                    100.0 * summary.share_concave, 100.0 * summary.share_centroid_outside,
                    100.0 * summary.share_several);
}

}  // namespace fascicle::cook
