// How a surface muscle of a character file is solved: which solver at which size in the picture, its coarse hull and
// its line. Ranges: surface_limits.hpp.

#include <fmt/format.h>

#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/surface_limits.hpp"

namespace fascicle::muscle {

namespace {

constexpr float kMillimetre = 1.0e-3f;  // m

bool read_solver(const JsonNode& node, SurfaceSolver& solver, Diagnostics& diagnostics) {
  constexpr std::string_view kNames[] = {"dynamic", "coarse_hull"};
  std::size_t choice = 0;
  if (!node.exists() || !node.read_choice(choice, diagnostics, kNames)) return false;
  solver = choice == 0 ? SurfaceSolver::kDynamic : SurfaceSolver::kCoarseHull;
  return true;
}

void read_hull(const JsonNode& node, HullSettings& hull, const ReadContext& context) {
  JsonObject object(node, context.diagnostics);
  object.optional("vertices", hull.vertices, kHullVerticesRange);
  float error = 0.0f;
  if (object.optional("error_mm", error, kHullErrorRange)) hull.error = kMillimetre * error;
  object.optional("iterations", hull.iterations, kHullIterationsRange);
  object.optional("tolerance", hull.tolerance, kHullToleranceRange);
  object.optional("refinements", hull.refinements, kRefinementsRange);
  object.optional("bending", hull.bending, kHullWeightRange);
  object.optional("direction", hull.direction, kHullWeightRange);
  finish_object(object, "hull", context);
}

// `usual`: refinements of a level that says nothing of them.
SurfaceLevel read_level(const JsonNode& node, std::uint32_t usual, const ReadContext& context) {
  SurfaceLevel level{.refinements = usual};
  JsonObject object(node, context.diagnostics);
  const bool known = read_solver(object.require("solver"), level.solver, context.diagnostics);
  object.optional("above_pixels", level.above_pixels, kAbovePixelsRange);
  const bool refined = object.optional("refinements", level.refinements, kRefinementsRange);
  finish_object(object, "surface_level", context);
  if (known && refined && level.solver != SurfaceSolver::kCoarseHull) {
    object.optional("refinements").error(context.diagnostics, "only the coarse hull's result is refined",
                                         "leave it out, or give \"solver\": \"coarse_hull\"");
  }
  return level;
}

// The sizes fall, and the last level is there for whatever is smaller.
void check_sizes(const JsonNode& list, std::span<const SurfaceLevel> levels, Diagnostics& diagnostics) {
  std::size_t i = 0;
  for (const JsonNode node : list) {
    const JsonNode size = node.member("above_pixels");
    const float pixels = levels[i].above_pixels;
    if (i + 1 == levels.size()) {
      if (pixels > 0.0f) {
        size.error(diagnostics, fmt::format("no level is left for a muscle of less than {:.6g} pixels", pixels),
                   "leave it out at the last level, or add one below");
      }
    } else if (!(pixels > 0.0f)) {
      (size.exists() ? size : node)
          .error(diagnostics, "the levels after this one are never used", "give its \"above_pixels\", more than 0");
    } else if (i > 0 && pixels >= levels[i - 1].above_pixels) {
      size.error(diagnostics,
                 fmt::format("{:.6g} pixels are no less than the level before has ({:.6g})", pixels,
                             levels[i - 1].above_pixels),
                 "order the levels from the finest, their \"above_pixels\" falling");
    }
    ++i;
  }
}

LinePointEntry read_line_point(const JsonNode& node, const ReadContext& context) {
  LinePointEntry point;
  point.node = node;
  JsonObject object(node, context.diagnostics);
  point.bone = read_name(object, "bone", true);
  object.require("at", point.position, kLinePointRange);
  std::size_t space = 0;
  if (object.optional_choice("space", space, {"mesh", "character"})) point.in_rest_space = space == 1;
  finish_object(object, "line_point", context);
  return point;
}

}  // namespace

void read_surface_solver(JsonObject& object, SurfaceMuscleEntry& entry, const ReadContext& context) {
  Diagnostics& diagnostics = context.diagnostics;
  if (const JsonNode hull = object.optional("hull"); hull.exists()) read_hull(hull, entry.hull, context);
  const JsonNode solver = object.optional("solver");
  const JsonNode list = object.optional_array("levels", 1, kMostSurfaceLevels);
  const std::size_t errors_before = diagnostics.errors.size();
  entry.levels = {{.refinements = entry.hull.refinements}};
  read_solver(solver, entry.levels.front().solver, diagnostics);
  if (entry.levels.front().solver == SurfaceSolver::kCoarseHull) entry.coarse_hull = solver;
  if (list.size() > 0) {
    if (solver.exists()) {
      solver.error(diagnostics, "the muscle has both \"solver\" and \"levels\"",
                   "leave out one of the two: \"solver\" is short for one level");
    }
    entry.levels.clear();
    for (const JsonNode node : list) {
      entry.levels.push_back(read_level(node, entry.hull.refinements, context));
      const bool coarse = entry.levels.back().solver == SurfaceSolver::kCoarseHull;
      if (coarse && !entry.coarse_hull.exists()) entry.coarse_hull = node.member("solver");
    }
    if (diagnostics.errors.size() == errors_before) check_sizes(list, entry.levels, diagnostics);
  }
  entry.action_line_node = object.optional_array("action_line", 2, kMostLinePoints);
  for (const JsonNode node : entry.action_line_node) entry.action_line.push_back(read_line_point(node, context));
  if (!entry.coarse_hull.exists()) return;
  if (!object.optional("action_line").exists() && !object.optional("driver").exists()) {
    entry.coarse_hull.error(diagnostics, "the coarse hull goes by the muscle's line, and there is none",
                            "give \"action_line\": [{\"bone\": \"pelvis\", \"at\": [x, y, z]}, ...] from origin to "
                            "insertion, or a \"driver\"");
  }
  if (entry.attachments.empty()) {
    entry.coarse_hull.error(diagnostics, "nothing says where the coarse hull is: the muscle is attached to no bone",
                            "give it \"attachments\", or \"solver\": \"dynamic\"");
  }
}

}  // namespace fascicle::muscle
