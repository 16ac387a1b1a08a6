#include "game/game_options.hpp"

#include <algorithm>
#include <charconv>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/math/simd_level.hpp"

namespace fascicle::game {
namespace {

constexpr std::uint32_t kCoarsestLevel = 9;

// FILE or FILE@FRAME, frames counted from 1. An '@' that no such number follows belongs to the file's name.
ScreenshotRequest parse_screenshot(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at != std::string::npos && at + 1 < text.size()) {
    std::uint64_t frame = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + at + 1, end, frame);
    if (error == std::errc{} && stop == end && frame > 0) return {text.substr(0, at), frame};
  }
  return {text, std::nullopt};
}

}  // namespace

ParsedOptions parse_options(int argc, const char* const* argv) {
  ParsedOptions parsed;
  GameOptions& options = parsed.options;
  std::string screenshot, detail = "auto", solver;
  bool no_draw = false;

  CLI::App app("Fascicle: muscles on a walking character. Without arguments: the walker, in a window.", "fascicle");
  app.footer(
      "Keys in a window: Space pauses, Period steps, R resets the camera, H hides the overlay. S B M A C T G switch\n"
      "skin, bones, muscles, action lines, sections, tendons and ground; F shows fibres, K contacts and tags. E adds a\n"
      "tag by two clicks (Enter saves, Backspace forgets a click, Y who yields, W sweeps, O both sides). Escape ends.");
  app.add_option("--scene", options.scene,
                 "A name in content/scenes (walker, walker-surface, gait2392, cesium-man, box, hip-gluteus, hip-iliacus, "
                 "hip-hull) or a scene file");
  app.add_flag("--headless", options.headless, "No window: run, then print the time per system");
  app.add_option("--frames", options.frames, "Steps to run (headless: the scene's own length by default)")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100'000'000}));
  app.add_option("--threads", options.threads, "Workers (default: one for each core)")->check(CLI::Range(1, 1024));
  app.add_option("--characters", options.copies, "How many characters: the scene's are repeated side by side")
      ->check(CLI::Range(1, 100'000));
  app.add_flag("--no-draw", no_draw, "Simulate only: no GL, and no skinning of meshes that nobody would see");
  app.add_option("--simd", options.simd, "Force the instruction set of the muscle kernels")
      ->check(CLI::IsMember({"portable", "avx2", "avx512"}));
  app.add_option("--level", detail, "Muscles' level of detail: auto (by size in the picture), 0 (finest), 1, ...")
      ->check(CLI::IsMember({"auto"}) | CLI::Range(std::uint32_t{0}, kCoarsestLevel));
  app.add_option("--surface-solver", solver,
                 "Who shapes muscles that are meshes and have a coarse hull: dynamic, coarse_hull (default: as their\n"
                 "levels of detail say)")
      ->check(CLI::IsMember({"dynamic", "coarse_hull"}));
  app.add_option("--stats", options.stats_file, "Write the time per system (.csv, .json, else a table)");
  app.add_flag("--detail", options.detail, "Statistics per character and per muscle as well");
  app.add_option("--trace", options.trace_file, "Write a Chrome trace, which ui.perfetto.dev opens");
  app.add_option("--report", options.report_file,
                 "Write JSON with a value per frame of every metric; penetration is measured for it, which takes some\n"
                 "tens of milliseconds a character and frame");
  app.add_option("--screenshot", screenshot, "Write a PNG of the last frame, or of one: FILE[@FRAME]");
  app.add_option("--contact-sheet", options.contact_sheet_file,
                 "Write a PNG with frames of the run from several sides, with and without skin");
  app.add_option("--sheet-frames", options.sheet_frames, "The frames on the contact sheet, as in 1,50,100")
      ->delimiter(',')
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{100'000'000}));
  app.add_option("--sheet-sides", options.sheet_sides, "From how many sides it shows them")->check(CLI::Range(1, 12));
  app.add_flag("--show-collision", options.show_collision,
               "Draw contacts, transversal tags and displaced centres, without the skin (in a window: K)");
  app.add_flag("--show-fibres", options.show_fibres,
               "Draw the fibres inside surface muscles, without the skin (in a window: F)");
  app.add_flag("--hash", options.hash, "Print a hash of the last frame's state");
  app.add_flag("--schedule", options.print_schedule, "Print the systems, their order and what they access, and stop");
  app.add_flag("--schedule-dot", options.print_dot, "The same as a graph for Graphviz");
  app.add_option("--width", options.width, "Picture or window width, pixels; of each on a contact sheet")->check(CLI::Range(16, 8192));
  app.add_option("--height", options.height, "Picture or window height, pixels; of each on a contact sheet")->check(CLI::Range(16, 8192));

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    parsed.exit_status = app.exit(error) == 0 ? kExitOk : kExitUsage;
    return parsed;
  }
  options.draw = !no_draw;
  if (solver == "dynamic") options.surface_solver = muscle::SurfaceSolver::kDynamic;
  if (solver == "coarse_hull") options.surface_solver = muscle::SurfaceSolver::kCoarseHull;
  if (detail != "auto") options.level = static_cast<std::uint32_t>(std::stoul(detail));
  if (const auto level = parse_simd_level(options.simd); level && *level > detect_simd()) {
    std::fprintf(stderr, "--simd %s: this processor has no more than %s; leave the option out\n",
                 options.simd.c_str(), std::string(to_string(detect_simd())).c_str());
    parsed.exit_status = kExitUsage;
  }
  const auto refuse = [&](const char* text) {
    std::fprintf(stderr, "%s\n", text);
    parsed.exit_status = kExitUsage;
  };
  for (const char* name : {"--screenshot", "--stats", "--trace", "--report", "--contact-sheet"}) {
    const CLI::Option* option = app.get_option(name);
    if (option->count() > 0 && option->as<std::string>().empty()) refuse("an output file needs a name");
  }
  if (!screenshot.empty()) options.screenshot = parse_screenshot(screenshot);
  if (!options.contact_sheet_file.empty() && !options.headless) {
    refuse("--contact-sheet is made by a headless run; add --headless");
  }
  std::vector<std::string> outputs = {options.stats_file, options.trace_file, options.report_file,
                                      options.contact_sheet_file, options.screenshot ? options.screenshot->file : ""};
  std::erase(outputs, "");
  std::sort(outputs.begin(), outputs.end());
  if (std::adjacent_find(outputs.begin(), outputs.end()) != outputs.end()) {
    refuse("two outputs have the same file name; give each its own");
  }
  if (!options.draw && (options.screenshot || !options.contact_sheet_file.empty())) {
    refuse("--screenshot and --contact-sheet need drawing; leave out --no-draw");
  }
  if (!options.draw && options.show_collision) refuse("--show-collision needs drawing; leave out --no-draw");
  if (!options.draw && options.show_fibres) refuse("--show-fibres needs drawing; leave out --no-draw");
  if (options.contact_sheet_file.empty() && app.count("--sheet-frames") + app.count("--sheet-sides") > 0) {
    refuse("--sheet-frames and --sheet-sides are of a contact sheet; add --contact-sheet FILE");
  }
  if (app.count("--width") > 0) options.sheet_width = options.width;
  if (app.count("--height") > 0) options.sheet_height = options.height;
  std::sort(options.sheet_frames.begin(), options.sheet_frames.end());
  options.sheet_frames.erase(std::unique(options.sheet_frames.begin(), options.sheet_frames.end()),
                             options.sheet_frames.end());
  if (!options.draw && !options.headless) {
    refuse("--no-draw leaves nothing to show in a window; add --headless");
  }
  if (options.screenshot && options.screenshot->frame && options.frames &&
      *options.screenshot->frame > *options.frames) {
    std::fprintf(stderr, "--screenshot asks for frame %llu of %llu; ask for an earlier one or more --frames\n",
                 static_cast<unsigned long long>(*options.screenshot->frame),
                 static_cast<unsigned long long>(*options.frames));
    parsed.exit_status = kExitUsage;
  }
  return parsed;
}

}  // namespace fascicle::game
