// The isocontour method (Kohout & Kukacka 2014; 4.4): rings of a harmonic field from origin to insertion carry a
// template of fibres from the unit cylinder into the muscle.
#pragma once

#include "engine/content/result.hpp"
#include "modules/muscle/asset/fibres/fibre_curves.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"

namespace fascicle::muscle {

// Fibres of settings.points points, in the template's order; not yet all inside. Errors: those of
// find_attachment_patches; a field that cannot be solved or cut.
Result<FibreCurves> make_isocontour_fibres(const SurfaceAsset& surface, const FibreBundleSettings& settings);

}  // namespace fascicle::muscle
