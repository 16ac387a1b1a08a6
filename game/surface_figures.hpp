// How well the surface muscles of a running scene do in the step that was just made: shape and volume
// (components/surface_muscle.hpp, SurfaceQuality), depth in bones and attachments by code of its own
// (modules/muscle/measure/surface_depth.hpp), fibres. For reports and fascicle-cook: it takes tens of milliseconds a
// muscle and step, and changes nothing in the simulation.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/ecs/entity.hpp"
#include "game/report.hpp"
#include "game/simulation.hpp"
#include "modules/muscle/measure/points_inside.hpp"
#include "modules/muscle/measure/surface_depth.hpp"

namespace fascicle::muscle {
struct SurfaceQuality;
}

namespace fascicle::game {

// Of a muscle that may be posed by its coarse hull (4.5).
struct HullFigures {
  bool posed = false;                               // in this step; else the rest says nothing
  bool converged = false;
  std::uint32_t iterations = 0;
  double residual = 0.0;                            // of the last of these; not a number: there was none
};

struct SurfaceFigures {
  ecs::Entity entity;
  std::shared_ptr<const muscle::SurfaceAsset> asset;
  const muscle::SurfaceQuality* quality = nullptr;  // of this step, until the next
  muscle::SurfaceDepths depths;
  std::vector<double> attachment_errors;            // m, by attachment
  double attachment_error = 0.0;                    // m, the worst of these
  std::vector<double> fibre_ratios;                 // length to rest, by fibre; empty: it has none
  double fibre_ratio_mean = 1.0;
  muscle::PointsOutside fibres_outside;             // the fibres' points that are not inside the muscle
  std::uint64_t fallbacks = 0;                      // so far
  std::optional<HullFigures> hull;                  // none: the muscle has no hull
};

class SurfaceMeters {
 public:
  // Gives surface muscles a SurfaceQuality, so that their angles are followed from the next step on. Where nobody did,
  // `measure` does.
  void start(Simulation& simulation);

  // A muscle each, in the order of their spawning. Bones are prepared when a character is first seen. What is posed by
  // its hull goes from rest straight to its pose: its angles are followed from rest anew in each step.
  const std::vector<SurfaceFigures>& measure(Simulation& simulation);

 private:
  struct Character {
    std::shared_ptr<const muscle::CharacterAsset> asset;
    std::shared_ptr<const muscle::BoneSolids> bones;
  };
  struct Meter {
    std::shared_ptr<const muscle::SurfaceAsset> asset;
    std::shared_ptr<const muscle::CharacterAsset> character;
    muscle::SurfaceDepthMeter depths;
    muscle::InsideMeter inside;
  };

  Meter& meter_of(const std::shared_ptr<const muscle::CharacterAsset>& character,
                  const std::shared_ptr<const muscle::SurfaceAsset>& asset);

  std::deque<Character> characters_;
  std::deque<Meter> meters_;
  std::vector<SurfaceFigures> figures_;
};

// Into a run's report, where the scene has surface muscles. Of several, each metric is that of the muscle that does
// worst by it: the ratios furthest from 1, else the largest.
//   surface.volume_ratio, edge_ratio_mean, edge_ratio_max, edge_ratio_abs_mean (mean |ratio - 1|),
//   dihedral_change_mean_rad, bone_depth_max_mm (triangles at attached vertices and their neighbours left out),
//   rest_distance_max_mm, attachment_error_max_mm, fibre_length_ratio_mean (null without fibres), fibre_points_outside
//   (where there are fibres), turned_edges (triangles that have swung through their neighbours) and fallbacks.
// Where a muscle may be posed by its coarse hull, of those that were in this step (null: none was):
//   surface.iterations, residual (of the last iteration: how far it moved a hull vertex, as a part of the muscle's size)
//   and converged (1, or 0 where one did not).
void record_surface_figures(const std::vector<SurfaceFigures>& figures, Report& report);

}  // namespace fascicle::game
