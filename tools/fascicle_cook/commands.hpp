// The subcommands of fascicle-cook. Each adds itself to the program and leaves the function that runs it; that function
// returns the exit status.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace fascicle::cook {

inline constexpr int kFine = 0;
inline constexpr int kErrors = 1;
inline constexpr int kUsage = 2;

using Command = std::function<int()>;

// import-osim MODEL.osim [--out FILE] [--geometry DIR]: a character file from an OpenSim model.
void add_import_osim(CLI::App& program, Command& chosen);
// fit CHARACTER|MESH: muscles fitted to their meshes, reported, stored.
void add_fit(CLI::App& program, Command& chosen);
// constrain CHARACTER: tags for collision where muscles come close to each other and to bones.
void add_constrain(CLI::App& program, Command& chosen);
// fields CHARACTER [--rebuild] [--info]: the bones' fields, stored and measured.
void add_fields(CLI::App& program, Command& chosen);
// counts CHARACTER: sections and vertices at several levels of detail.
void add_counts(CLI::App& program, Command& chosen);
// fibres SCENE|CHARACTER: fibres inside surface muscles, made, measured and, with --play, watched.
void add_fibres(CLI::App& program, Command& chosen);
// hull CHARACTER: coarse hulls round its surface muscles, made, measured, stored and drawn.
void add_hull(CLI::App& program, Command& chosen);
// slices CHARACTER|MESH...: the shapes of muscle meshes' cross sections.
void add_slices(CLI::App& program, Command& chosen);
// collide CHARACTER: a character played and its muscles' penetration measured.
void add_collide(CLI::App& program, Command& chosen);
// surface SCENE: a scene played and its surface muscles' shapes measured and checked.
void add_surface(CLI::App& program, Command& chosen);

}  // namespace fascicle::cook
