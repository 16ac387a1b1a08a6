// fascicle-cook: makes content from other sources, and tells what content amounts to.
//
// Exit status: 0 done (warnings allowed), 1 errors in the input, 2 wrong usage.

#include <CLI/CLI.hpp>

#include "tools/fascicle_cook/commands.hpp"
#include "engine/content/run_program.hpp"

namespace {

using namespace fascicle;

int run(int argc, char** argv) {
  CLI::App program("Makes content for Fascicle from other sources, and tells what content amounts to.",
                   "fascicle-cook");
  program.require_subcommand(1);
  program.footer("Exit status: 0 done (warnings allowed), 1 errors in the input, 2 wrong usage.");
  cook::Command chosen;
  cook::add_import_osim(program, chosen);
  cook::add_fit(program, chosen);
  cook::add_constrain(program, chosen);
  cook::add_fields(program, chosen);
  cook::add_counts(program, chosen);
  cook::add_slices(program, chosen);
  cook::add_fibres(program, chosen);
  cook::add_hull(program, chosen);
#ifdef FASCICLE_COOK_PLAYS
  cook::add_collide(program, chosen);
  cook::add_surface(program, chosen);
#endif
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? cook::kFine : cook::kUsage;
  }
  return chosen();
}

}  // namespace

int main(int argc, char** argv) {
  return fascicle::run_program("fascicle-cook", [&] { return run(argc, argv); });
}
