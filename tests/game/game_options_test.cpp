#include "game/game_options.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace fascicle::game {
namespace {

ParsedOptions parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "fascicle");
  return parse_options(static_cast<int>(arguments.size()), arguments.data());
}

TEST(GameOptions, WrongArgumentsLeaveWithTheUsageStatus) {
  const std::vector<std::vector<const char*>> wrong = {
      {"--no-such-option"},
      {"--frames", "0"},
      {"--frames", "-3"},
      {"--frames", "many"},
      {"--threads", "0"},
      {"--characters", "0"},
      {"--simd", "neon"},
      {"--level", "coarse"},
      {"--surface-solver", "sparse"},
      {"--level", "-1"},
      {"--level", "1.5"},
      {"--scene"},
      {"--headless", "--no-draw", "--screenshot", "p.png"},
      {"--headless", "--no-draw", "--contact-sheet", "p.png"},
      {"--no-draw"},
      {"--headless", "--no-draw", "--show-collision"},
      {"--headless", "--frames", "10", "--screenshot", "p.png@11"},
      {"--width", "1"},
      {"--contact-sheet", "sheet.png"},
      {"--headless", "--sheet-frames", "1,2"},
      {"--headless", "--sheet-sides", "2"},
      {"--headless", "--contact-sheet", "sheet.png", "--sheet-frames", "0"},
      {"--headless", "--contact-sheet", "sheet.png", "--sheet-frames", "1,x"},
      {"--headless", "--contact-sheet", "sheet.png", "--sheet-sides", "0"},
      {"--headless", "--no-draw", "--show-fibres"},
      {"--headless", "--screenshot", ""},
      {"--headless", "--stats", ""},
      {"--headless", "--stats", "a.json", "--report", "a.json"},
  };
  for (const auto& arguments : wrong) {
    const ParsedOptions parsed = parse(arguments);
    ASSERT_TRUE(parsed.exit_status.has_value()) << arguments[0];
    EXPECT_EQ(*parsed.exit_status, kExitUsage) << arguments[0];
  }
}

TEST(GameOptions, HelpLeavesWithSuccess) { EXPECT_EQ(parse({"--help"}).exit_status, kExitOk); }

TEST(GameOptions, DefaultIsTheWalkerInAWindow) {
  const ParsedOptions parsed = parse({});
  ASSERT_FALSE(parsed.exit_status.has_value());
  EXPECT_EQ(parsed.options.scene, "walker");
  EXPECT_FALSE(parsed.options.headless);
  EXPECT_TRUE(parsed.options.draw);
  EXPECT_EQ(parsed.options.copies, 1);
  EXPECT_FALSE(parsed.options.frames.has_value());
}

TEST(GameOptions, CollisionIsShownOnRequest) {
  EXPECT_FALSE(parse({}).options.show_collision);
  EXPECT_TRUE(parse({"--show-collision"}).options.show_collision);
  EXPECT_TRUE(parse({"--headless", "--show-collision", "--screenshot", "p.png"}).options.show_collision);
}

TEST(GameOptions, ASheetsFramesAndSidesMayBeChosen) {
  const ParsedOptions plain = parse({"--headless", "--contact-sheet", "sheet.png"});
  EXPECT_TRUE(plain.options.sheet_frames.empty());
  EXPECT_EQ(plain.options.sheet_sides, 4);
  const ParsedOptions chosen =
      parse({"--headless", "--contact-sheet", "sheet.png", "--sheet-frames", "300,1,50,50", "--sheet-sides", "1"});
  ASSERT_FALSE(chosen.exit_status.has_value());
  EXPECT_EQ(chosen.options.sheet_frames, (std::vector<std::uint64_t>{1, 50, 300}));
  EXPECT_EQ(chosen.options.sheet_sides, 1);
  EXPECT_EQ(chosen.options.sheet_height, plain.options.sheet_height);
  EXPECT_EQ(parse({"--headless", "--contact-sheet", "sheet.png", "--width", "77"}).options.sheet_width, 77);
}

TEST(GameOptions, FibresAreShownOnRequest) {
  EXPECT_FALSE(parse({}).options.show_fibres);
  EXPECT_TRUE(parse({"--show-fibres"}).options.show_fibres);
}

TEST(GameOptions, LevelsAreBySizeOrByNumber) {
  EXPECT_FALSE(parse({}).options.level.has_value());
  EXPECT_FALSE(parse({"--level", "auto"}).options.level.has_value());
  EXPECT_EQ(parse({"--level", "0"}).options.level, 0u);
  EXPECT_EQ(parse({"--level", "2"}).options.level, 2u);
}

TEST(GameOptions, ASurfaceSolverMayBeForced) {
  EXPECT_FALSE(parse({}).options.surface_solver.has_value());
  EXPECT_EQ(parse({"--surface-solver", "dynamic"}).options.surface_solver, muscle::SurfaceSolver::kDynamic);
  EXPECT_EQ(parse({"--surface-solver", "coarse_hull"}).options.surface_solver, muscle::SurfaceSolver::kCoarseHull);
}

TEST(GameOptions, ScreenshotMayNameAFrame) {
  const auto last = parse({"--headless", "--screenshot", "p.png"}).options.screenshot;
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->file, "p.png");
  EXPECT_FALSE(last->frame.has_value());

  const auto tenth = parse({"--headless", "--screenshot", "p.png@10"}).options.screenshot;
  ASSERT_TRUE(tenth.has_value());
  EXPECT_EQ(tenth->file, "p.png");
  EXPECT_EQ(tenth->frame, 10u);

  const auto mail = parse({"--headless", "--screenshot", "me@home.png"}).options.screenshot;
  ASSERT_TRUE(mail.has_value());
  EXPECT_EQ(mail->file, "me@home.png");
  EXPECT_FALSE(mail->frame.has_value());
}

}  // namespace
}  // namespace fascicle::game
