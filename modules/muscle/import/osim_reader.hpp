// OpenSim models, .osim of version 4: bodies, joints with their splines, coordinates and couplings, bone geometry,
// muscles with fixed, conditional and moving path points, and the names of wrap objects.
//
// Joints: Pin, Slider, Weld, Ball, Gimbal, Universal, Planar, Free, Custom. Functions: Constant, LinearFunction,
// PolynomialFunction, PiecewiseLinearFunction, SimmSpline (NaturalCubicSpline), MultiplierFunction. A field that is
// absent has OpenSim's default, as OpenSim's own files leave defaults out.
#pragma once

#include <filesystem>
#include <string>

#include "engine/content/result.hpp"
#include "modules/muscle/import/osim_model.hpp"

namespace fascicle::muscle {

// Errors, all of the file in one go: not XML, not UTF-8, not a model, older than version 4 (OpenSim 4 converts it by
// opening and saving), unresolved frames and coordinates, bodies or joints in circles, unknown joints and functions,
// splines whose x do not rise, numbers that aren't finite, muscles with fewer than two points, names twice. Warnings:
// what is left out (other forces and constraints, prescribed coordinates, geometry that is no mesh).
Result<OsimModel> read_osim(const std::filesystem::path& file);
Result<OsimModel> parse_osim(std::string text, std::string file_name);

}  // namespace fascicle::muscle
