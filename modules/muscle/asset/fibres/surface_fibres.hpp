// The surface-fibre method (Kohout & Cholt 2017; 4.4): from fibres given side by side on one face of the muscle, as
// dissection of the superficial layer gives them, to fibres throughout. Centripetal Catmull-Rom curves across the given
// fibres make a sheet; straight in through the muscle it has its counterpart on the other face; fibres fill what lies
// between, evenly by volume.
#pragma once

#include "engine/content/result.hpp"
#include "modules/muscle/asset/fibres/fibre_curves.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

// Fibres of settings.points points; those of a head (FibreLine::head) follow each other, rising, and heads have them in
// proportion to their volumes. Not yet all inside. Errors: no fibres, fewer than two of a head, points that are not
// finite, fibres that come nowhere near the muscle, a muscle that does not lie under its fibres.
Result<FibreCurves> make_surface_fibres(const SurfaceAsset& surface, const FibreBundleSettings& settings);

}  // namespace fascicle::muscle
