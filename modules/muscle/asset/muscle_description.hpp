// What a muscle is before it is built: the fields of a content file, or what a program fills in by hand.
// `build_muscle_asset` turns descriptions into the immutable, solver-ready MuscleAsset.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/content/result.hpp"

namespace fascicle::muscle {

// One point of the action line, fixed to a bone: the origin, a via point or the insertion.
struct AttachmentDescription {
  std::int32_t bone = -1;        // index into the skeleton
  glm::vec3 position{0.0f};      // m, in the bone's frame
  bool counts = true;            // false: an extra via point, left out of the vertex counts of the method's table 3
};

// Hill-type parameters (Delp et al. 1990). Zero: unknown.
struct HillParameters {
  float max_isometric_force = 0.0f;   // N
  float optimal_fibre_length = 0.0f;  // m
  float tendon_slack_length = 0.0f;   // m
  float pennation = 0.0f;             // rad, at optimal fibre length
};

// A spindle: relative radius at fractions of the rest arc length, origin 0 to insertion 1, linear between.
struct RadiusProfile {
  std::vector<float> fractions;  // rising, 0..1
  std::vector<float> radii;      // relative (scaled to the volume) or, where `absolute`, m
  bool absolute = false;
};

struct MuscleDescription {
  std::string name;
  std::vector<AttachmentDescription> attachments;  // origin, via points in order, insertion: at least 2
  HillParameters hill;
  float source_length = 0.0f;       // m, the action line's length in the source model (l_A); 0: the same as here
  float specific_tension = 0.0f;    // N/m^2, 32e4..61e4; 0: 61e4
  // The rest radii come from the first of these that is given: pcsa, volume, absolute profile, else
  // PCSA = max_isometric_force / specific_tension.
  std::optional<float> pcsa;        // m^2
  std::optional<float> volume;      // m^3, of the belly
  RadiusProfile profile;            // empty: the default spindle
  float tendon_at_origin = 0.0f;    // fraction of the scaled tendon slack length drawn as free tendon at each end
  float tendon_at_insertion = 0.5f; // (the seeds: half of it at the insertion)
  std::uint32_t section_vertices = 8;       // |C|, even, >= 6
  std::uint32_t longitudinal_subdivision = 1;  // LSS, 0..6
  std::string mesh;                 // name of the anatomical mesh, empty: none (used by the fit)
  std::vector<std::string> groups;  // names of the groups it belongs to ("knee_ext_r"), for a game to choose by
  Diagnostic where;                 // file, line, column and path to quote in errors; empty for muscles made in code
};

}  // namespace fascicle::muscle
