// The command line of `fascicle`, parsed and checked.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "modules/muscle/asset/surface/surface_description.hpp"

namespace fascicle::game {

// A PNG to write: after frame `frame` (counted from 1), or after the last one.
struct ScreenshotRequest {
  std::string file;
  std::optional<std::uint64_t> frame;
};

struct GameOptions {
  std::string scene = "walker";          // a name in content/scenes, or a scene file
  bool headless = false;
  bool draw = true;
  std::optional<std::uint64_t> frames;   // headless: the scene's own length where absent; a window: until closed
  int threads = 0;                       // workers; 0: one for each core
  int copies = 1;                        // how often the scene's characters are spawned, side by side
  std::string simd;                      // portable, avx2, avx512; empty: the best that the machine has
  std::optional<std::uint32_t> level;    // of detail, 0 the finest; absent: by size in the picture
  std::optional<muscle::SurfaceSolver> surface_solver;  // of those that have a hull; absent: as their levels say
  std::string stats_file;                // .csv, .json, else a table
  std::string trace_file;
  std::string report_file;
  std::optional<ScreenshotRequest> screenshot;
  std::string contact_sheet_file;        // pictures of frames from several sides, with and without skin
  std::vector<std::uint64_t> sheet_frames;  // those on it, rising; empty: eight, spread over the run
  int sheet_sides = 4;                   // it shows
  int sheet_width = 300, sheet_height = 420;  // pixels of one of its pictures: width and height where they are given
  bool show_collision = false;           // contacts, tags and depths in the picture, and no skin over them
  bool show_fibres = false;              // of surface muscles, which are translucent then
  bool detail = false;                   // statistics per character and muscle
  bool hash = false;
  bool print_schedule = false;
  bool print_dot = false;
  int width = 1280;                      // of the picture or window, pixels
  int height = 720;
};

// Exit statuses of the game.
inline constexpr int kExitOk = 0;
inline constexpr int kExitBadContent = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitNoData = 3;     // the scene needs data that is not on this machine
inline constexpr int kExitNoOutput = 4;   // a file that was asked for could not be written, or nothing can be drawn

// The options, or the status to leave with (help was asked for, or an argument was wrong and has been explained).
struct ParsedOptions {
  GameOptions options;
  std::optional<int> exit_status;
};
ParsedOptions parse_options(int argc, const char* const* argv);

}  // namespace fascicle::game
