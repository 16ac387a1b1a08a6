#include "modules/muscle/asset/fibres/isocontour_fibres.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "modules/muscle/asset/fibres/attachment_patches.hpp"
#include "modules/muscle/asset/fibres/fibre_faults.hpp"
#include "modules/muscle/asset/fibres/fibre_template.hpp"
#include "modules/muscle/asset/fibres/isocontours.hpp"
#include "modules/muscle/asset/fibres/spanned_disc.hpp"
#include "modules/muscle/asset/surface/harmonic_field.hpp"

namespace fascicle::muscle {
namespace {

constexpr std::size_t kContours = 32;  // along the muscle; and places along each fibre before it is resampled

// The muscle as an image of the unit cylinder.
class CylinderMap {
 public:
  explicit CylinderMap(std::vector<SpannedDisc> discs) : discs_(std::move(discs)) {}

  glm::dvec3 at(const glm::dvec3& p) const {
    const double z = glm::clamp(p.z, 0.0, 1.0) * static_cast<double>(discs_.size() - 1);
    const auto i = static_cast<std::size_t>(z);
    const double share = z - static_cast<double>(i);
    const glm::dvec3 here = discs_[i].at(glm::dvec2(p));
    return share > 1.0e-9 && i + 1 < discs_.size() ? glm::mix(here, discs_[i + 1].at(glm::dvec2(p)), share) : here;
  }

  // m, mean of half the way from (-1, 0) to (1, 0)
  double half_width() const {
    double sum = 0.0;
    for (const SpannedDisc& disc : discs_) sum += 0.5 * glm::distance(disc.at({-1.0, 0.0}), disc.at({1.0, 0.0}));
    return sum / static_cast<double>(discs_.size());
  }

 private:
  std::vector<SpannedDisc> discs_;  // from origin to insertion
};

}  // namespace

Result<FibreCurves> make_isocontour_fibres(const SurfaceAsset& surface, const FibreBundleSettings& settings) {
  Result<AttachmentPatches> patches = find_attachment_patches(surface);
  if (!patches) return patches.diagnostics();
  std::vector<glm::vec3> positions(surface.vertex_count);
  std::vector<std::uint8_t> fixed(surface.vertex_count, 0);
  std::vector<float> values(surface.vertex_count, 0.0f);
  for (std::size_t v = 0; v < surface.vertex_count; ++v) {
    positions[v] = {surface.rest[v].x, surface.rest[v].y, surface.rest[v].z};
    fixed[v] = patches->of[v] != Patch::kBetween;
    values[v] = patches->of[v] == Patch::kInsertion ? 1.0f : 0.0f;
  }
  const Result<std::vector<float>> field = solve_harmonic(positions, surface.triangles, fixed, values);
  if (!field) return field.diagnostics();

  const Contours contours = trace_contours(positions, surface.triangles, *field, kContours);
  std::vector<SpannedDisc> discs;
  for (const Loop& loop : contours.loops) {
    if (std::optional<SpannedDisc> disc = SpannedDisc::span(loop)) discs.push_back(*std::move(disc));
  }
  if (discs.size() < kContours)
    return fibre_fault(surface, "no rings run round it between origin and insertion",
                       "attach connected areas of its surface that lie apart");

  const CylinderMap map(std::move(discs));
  const double half_width = map.half_width();
  const double tangent = std::tan(static_cast<double>(settings.pennation));
  const double slope = half_width > 0.0 ? tangent * contours.length / half_width : 0.0;
  FibreCurves fibres;
  fibres.points_per_fibre = settings.points;
  fibres.head.assign(settings.count, 0);
  fibres.points.reserve(std::size_t{settings.count} * settings.points);
  std::vector<glm::dvec3> curve(kContours);
  for (const TemplateFibre& fibre : make_template(settings.arrangement, settings.count, slope)) {
    for (std::size_t k = 0; k < kContours; ++k)
      curve[k] = map.at(fibre.at(static_cast<double>(k) / static_cast<double>(kContours - 1)));
    const std::vector<glm::dvec3> even = resample_curve(smooth_curve(curve), settings.points);
    fibres.points.insert(fibres.points.end(), even.begin(), even.end());
  }
  Diagnostics notes;
  if (contours.split_levels > 0)
    notes.warnings.push_back(
        fibre_fault(surface, std::to_string(contours.split_levels) + " of the rings fall into several",
                    "only the longest of each carries fibres: what lies in others gets none"));
  return Result<FibreCurves>(std::move(fibres), std::move(notes));
}

}  // namespace fascicle::muscle
