// What a content file says about the collision of a character's muscles, names resolved: the settings, and the tags
// that authors place or `fascicle-cook constrain` finds. A tag says where on a muscle by the fraction of the arc length
// and by the angle, so that it holds at every |C| and LSS and after a new fit.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/content/result.hpp"

namespace fascicle::muscle {

// A place on a muscle's surface.
struct SectionTag {
  std::uint32_t muscle = 0;  // index of the muscle's description
  float fraction = 0.5f;     // of the rest line's arc length, origin 0 to insertion 1
  float angle = 0.0f;        // rad, 0..2 pi: theta about the section's normal (1.3), from tag_angle.hpp's u_k
};

// Who moves when two tagged sections have come into each other. Bones never do.
enum class Yields { kBoth, kFirst, kSecond };

// Thesis 4.1: a line between two tagged places that face each other.
struct TransversalTag {
  SectionTag first;
  std::int32_t bone = -1;      // >= 0: the other end is the point of this bone that is nearest to `first` at rest
  SectionTag second;           // else it is this one
  Yields yields = Yields::kBoth;
  bool sweeps = false;         // test the sections' own edges as rays against the partner (thesis 4.1.2)
  bool automatic = false;      // placed by fascicle-cook constrain, which may replace it
  Diagnostic where;            // its place in the file, for errors and for saving
};

// Sections of `muscle` between two fractions that must stay out of these bones, and out of no others.
struct BoneTag {
  std::uint32_t muscle = 0;
  float from = 0.0f, to = 1.0f;       // fractions of the rest line's arc length
  std::vector<std::int32_t> bones;
  bool automatic = false;             // only tells: every bone is tested where no author's tag covers a section
  Diagnostic where;
};

// A pair that never touches: two muscles, or a muscle and a bone.
struct IgnoredPair {
  std::uint32_t muscle = 0;
  std::int32_t bone = -1;             // >= 0: a bone, else
  std::uint32_t other = 0;            // this muscle
  Diagnostic where;
};

enum class CollisionMode {
  kReduced,  // the constraint solve in a_k and radii
  kLegacy,   // the thesis's own response, for comparison: permanent, unstable
};

// Compliances are given as times: how long what is pressed needs to come back by 63 % once it is free. That is what a
// compliance means where nothing has inertia, and it depends on neither the step's length nor their number.
struct CollisionSettings {
  bool enabled = true;
  CollisionMode mode = CollisionMode::kReduced;
  std::uint32_t substeps = 4;         // of a step of the simulation, 1..32
  std::uint32_t iterations = 3;       // over all constraints in a substep, 1..64
  float shape_time = 0.06f;           // s, radii to the rest shape
  float line_time = 0.06f;            // s, a_k to where the bones carry it
  float via_time = 0.02f;             // s, the same for the sections at via points
  float smoothing = 0.5f;             // 0..1: how strongly neighbours, along the line and round a section, pull alike
  float bone_margin = 0.0f;           // m kept between muscles and bones
  float muscle_margin = 0.0f;         // m kept between muscles
  float sample_spacing = 0.012f;      // m: the surface is tested in points about this far apart; to be the larger, the
                                      // larger the character, for what a contact looks ahead and pushes goes with it
  float bone_voxel = 0.002f;          // m: of the bones' fields
  bool keep_volume = true;            // belly sections widen as their muscle shortens

  friend bool operator==(const CollisionSettings&, const CollisionSettings&) = default;
};

struct CollisionDescription {
  CollisionSettings settings;
  std::vector<TransversalTag> transversals;
  std::vector<BoneTag> bone_tags;
  std::vector<IgnoredPair> ignored;
};

}  // namespace fascicle::muscle
