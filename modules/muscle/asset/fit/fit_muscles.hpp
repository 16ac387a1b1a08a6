// Fits muscles to anatomical meshes by casting rays (the method's page 2): from each section's centre outward in the
// section's plane, onto the mesh. Centres that lie outside the mesh are moved inside first. Done once, when content is
// cooked or loaded; the result goes to build_muscle_asset.
//
//   rest_frames      the planes of the sections                               1.2
//   section_rays     lines in a section's plane -> algebraic radii            2.1
//   match_order      which opposite rays found the same stretch, in order     2.2
//   inner_point      a point inside the slice, from the matches               2.2
//   fit_line         two sweeps over one line's sections                      2.3
//   fit_muscles      checks of the meshes, one muscle after the other         this file
//
// Beyond the papers:
//
//   check_mesh       what is wrong with a mesh, and which unit it is in
//   fit_surface      what is inside along a line, of defective meshes by winding number
//   section_slice    planes that cut the mesh in several loops
//   outside_section  sections whose centres the model has outside of the mesh
//   unfold_sections  planes that cross inside a bend
//   head_region      several action lines in one mesh
//   end_area         wide attachments
//   fill_misses      rays that found nothing
//   compare_fit      how well it went, independent of all of this
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"

namespace fascicle::muscle {

struct FitOptions {
  std::uint32_t supersampling = 3;  // CSS, >= 1: CSS |C| rays a section find the inner points
  bool restore_ends = true;         // off for the article's table 4
  // Ours; off for the method's plain form and table 4: keep to one loop where a plane cuts the mesh in several, put
  // centres that the rays left outside deep into the slice, give sections whose ends the model has outside a shape, and
  // keep neighbouring sections from passing through each other.
  bool rescue = true;
  bool plain_rays = false;          // the plain loop over all triangles in place of Embree: for tests and benchmarks
};

enum class SectionOutcome {
  kFitted,   // every ray found the mesh
  kPartial,  // some did
  kMissed,   // none did: the section's plane misses the mesh
  kOutside,  // the centre lies outside of the mesh
};

inline constexpr std::array<std::string_view, 4> kOutcomeNames{"fitted", "partial", "missed", "outside"};
constexpr std::string_view name_of(SectionOutcome outcome) { return kOutcomeNames[static_cast<std::size_t>(outcome)]; }

struct SectionReport {
  std::uint32_t hits = 0, misses = 0;  // of the |C| final rays
  std::uint32_t matches = 0;           // that the first, supersampled rays found
  std::uint32_t loops = 0;             // in which the section's plane cuts the mesh; 0: not looked at
  float moved = 0.0f;                  // m, the centre, by the fit
  bool inside = false;                 // the centre, by winding number
  bool rescued = false;
  SectionOutcome outcome = SectionOutcome::kMissed;
};

struct FittedMuscle {
  MuscleFit fit;                        // empty: not fitted, keeps its unfitted shape
  std::vector<SectionReport> sections;  // empty with it
  Diagnostics diagnostics;              // warnings only
};

struct CheckedMesh;

struct FitInput {
  const MuscleDescription* description = nullptr;
  const TriangleMesh* mesh = nullptr;  // in the rest bones' space, m; null: none, not fitted and nothing said
  // Triangles of the mesh that are attachment area at the origin and at the insertion; empty: none.
  std::array<std::vector<std::uint32_t>, 2> areas;
  // The mesh as check_mesh gives it, for callers that fit to it again and again; null: it is checked here. With it,
  // overlaps that only the fit meets are not told.
  const CheckedMesh* checked = nullptr;
};

// Fits each input, at the |C| and LSS of its description; one result an input. Inputs that share a mesh (the same
// pointer) are the heads of one muscle. `rest_bones` are the skeleton's bone-to-character matrices at rest.
//
// A mesh that cannot be fitted to (empty, in another unit, away from the action line, all another head's) leaves a
// warning and an empty fit; one with defects is fitted all the same, with a warning that names them. Told are, too,
// fits that most sections' planes or centres miss, and heads with the same action line. A description that
// check_description refuses gives an empty fit without a warning, because the builder will say it. All numbers are
// finite. The same bits for any number of workers.
std::vector<FittedMuscle> fit_muscles(std::span<const FitInput> inputs, std::span<const glm::mat4> rest_bones,
                                      const FitOptions& options = {});

}  // namespace fascicle::muscle
