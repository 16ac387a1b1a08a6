// What `fascicle-cook surface` prints and writes of a run.
#pragma once

#include <string>
#include <vector>

#include "tools/fascicle_cook/surface_checks.hpp"
#include "tools/fascicle_cook/surface_run.hpp"

namespace fascicle::cook {

// The configuration: mesh, attachments, settings, what is switched off.
std::string surface_configuration(const SurfaceRun& run, const SurfaceMuscleRun& muscle);

// A row a figure: its values at steps 1, 50, 100 .. 300 (those there are), the worst over all steps and its step.
std::string surface_table(const SurfaceMuscleRun& muscle);

// A row a check, PASS or FAIL.
std::string surface_checks_table(const std::vector<SurfaceCheck>& checks);

// A line a muscle and step.
std::string surface_csv(const SurfaceRun& run);

}  // namespace fascicle::cook
