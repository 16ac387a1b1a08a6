// Older versions of the content files. The readers know the current version only; a file of an older one is rewritten
// in memory first, token by token, so that it keeps its lines and its author's layout, and errors still point at the
// right line. The load warns and names the command that rewrites the file itself.
//
// Version 0 was used before the first release. Against version 1:
//   character file  /lod {sections, subdivisions}    is /level {section_vertices, longitudinal_subdivision}
//                   /specific_tension_ncm2 (N/cm^2)  is /specific_tension (N/m^2)
//     a muscle      fmax                             is max_isometric_force
//                   fibre_length, tendon_length      are optimal_fibre_length, tendon_slack_length
//                   pennation_degrees (degrees)      is pennation (rad)
//                   via_points                       is via
//   scene file      /fps                             is /step_hz
//     a character   path, heading_degrees (degrees)  are file, heading (rad)
//     the camera    fov_degrees (degrees)            is fov (rad)
// There are no collision files of version 0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "engine/content/json_reader.hpp"
#include "engine/content/result.hpp"

namespace fascicle::muscle {

inline constexpr int kContentVersion = 1;

enum class ContentKind : std::uint8_t { kCharacter, kScene, kCollision };

// What the file is by its name (.character.json, .scene.json, .collision.json), else by its members; nothing where
// neither tells.
std::optional<ContentKind> content_kind(const std::filesystem::path& file, const JsonNode& root);

// The document in the current version, as it is where it has that already. Errors: no version, not a whole number, a
// version from the future (the way out is named).
Result<JsonDocument> migrate(const JsonDocument& document, ContentKind kind);

// Reads a file and migrates it.
Result<JsonDocument> read_content_file(const std::filesystem::path& file, ContentKind kind);

}  // namespace fascicle::muscle
