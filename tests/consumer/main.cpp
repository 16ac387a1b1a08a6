// Muscles in somebody else's engine: its own loop, its own clock and time scale, its own bone matrices. Every claim is
// checked; the exit status is the number of those that fail.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/muscle.hpp"

namespace {

using namespace fascicle;

int failures = 0;

void check(bool holds, const char* claim) {
  std::printf("%s %s\n", holds ? "ok  " : "FAIL", claim);
  if (!holds) ++failures;
}

// The host's skeleton: a thigh and a shank, bone to world; the knee bends about x.
std::vector<glm::mat4> pose_leg(const glm::vec3& hip, float knee) {
  const glm::mat4 thigh = glm::translate(glm::mat4(1.0f), hip);
  const glm::mat4 shank = glm::rotate(glm::translate(thigh, {0.0f, -0.4f, 0.0f}), knee, {1.0f, 0.0f, 0.0f});
  return {thigh, shank};
}

std::vector<muscle::MuscleDescription> describe_leg() {
  muscle::MuscleDescription hamstring;
  hamstring.name = "hamstring";
  hamstring.attachments = {{0, {0.0f, -0.02f, -0.05f}}, {1, {0.02f, -0.05f, -0.03f}}};
  hamstring.hill = {.max_isometric_force = 900.0f, .optimal_fibre_length = 0.11f, .tendon_slack_length = 0.32f,
                    .pennation = 0.0f};
  muscle::MuscleDescription vastus;
  vastus.name = "vastus";
  vastus.attachments = {{0, {0.0f, -0.05f, 0.03f}}, {0, {0.0f, -0.37f, 0.05f}}, {1, {0.0f, -0.06f, 0.04f}}};
  vastus.hill = {.max_isometric_force = 1300.0f, .optimal_fibre_length = 0.09f, .tendon_slack_length = 0.13f,
                 .pennation = 0.05f};
  return {hamstring, vastus};
}

struct Box {
  glm::vec3 low{1e9f}, high{-1e9f};
};

Box bounds(const muscle::MuscleSurfaceView& surface) {
  Box box;
  for (const muscle::SurfaceVertex& vertex : surface.vertices) {
    box.low = glm::min(box.low, vertex.position);
    box.high = glm::max(box.high, vertex.position);
  }
  return box;
}

bool finite(const muscle::MuscleSurfaceView& surface) {
  return std::all_of(surface.vertices.begin(), surface.vertices.end(), [](const muscle::SurfaceVertex& vertex) {
    return std::isfinite(vertex.position.x) && std::isfinite(vertex.position.y) && std::isfinite(vertex.position.z);
  });
}

// A muscle that is a mesh, posed by a coarse hull without the schedule.
void check_posed_mesh(ecs::World& world) {
  muscle::SurfaceMuscleDescription belly;
  belly.name = "belly";
  constexpr std::uint32_t kLayers = 6;
  for (std::uint32_t layer = 0; layer <= kLayers; ++layer) {
    const float y = 0.02f * static_cast<float>(layer);
    for (const auto& [x, z] : {std::pair(1, 1), std::pair(1, -1), std::pair(-1, -1), std::pair(-1, 1)}) {
      belly.mesh.positions.push_back({0.015f * static_cast<float>(x), y, 0.015f * static_cast<float>(z)});
    }
  }
  auto& indices = belly.mesh.indices;
  for (std::uint32_t layer = 0; layer < kLayers; ++layer) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t a = 4 * layer + i, b = 4 * layer + (i + 1) % 4;
      indices.insert(indices.end(), {a, b, b + 4, a, b + 4, a + 4});
    }
  }
  const std::uint32_t top = 4 * kLayers;
  indices.insert(indices.end(), {3, 2, 1, 3, 1, 0, top, top + 1, top + 2, top, top + 2, top + 3});
  belly.attachments = {{.bone = 0, .origin = true, .vertices = {0, 1, 2, 3}},
                       {.bone = 1, .origin = false, .vertices = {top, top + 1, top + 2, top + 3}}};
  belly.action_line = {{.bone = 0, .position = {0.0f, 0.0f, 0.0f}}, {.bone = 1, .position = {0.0f, 0.12f, 0.0f}}};
  belly.levels = {{.solver = muscle::SurfaceSolver::kCoarseHull}};
  const std::vector<glm::mat4> rest(2, glm::mat4(1.0f));
  const auto surface = muscle::build_surface_asset(belly, 2);
  const auto hull = muscle::build_progressive_hull(belly.mesh, {.vertices = 20});
  check(surface.ok() && hull.ok(), "a mesh muscle and its hull are built");
  if (!surface || !hull) return;
  const auto posed = muscle::build_hull_asset(**surface, belly, hull->mesh);
  if (!posed) std::fputs(to_text(posed.diagnostics()).c_str(), stderr);
  check(posed.ok(), "the hull is ready for its solver");
  if (!posed) return;
  const ecs::Entity character = world.create();
  world.add(character, BoneMatrices{rest, 0});
  const ecs::Entity entity = muscle::spawn_surface_muscle(world, character, *surface, rest, {});
  muscle::add_hull(world, entity, *posed);
  world.get<BoneMatrices>(character).world[1] = glm::rotate(glm::mat4(1.0f), 0.5f, {1.0f, 0.0f, 0.0f});
  check(muscle::pose_now(world, entity), "it is posed without a step");
  bool sound = true;
  for (const auto& vertex : world.get<muscle::DrawnSurface>(entity).vertices) {
    sound = sound && glm::length(vertex.position) < 0.2f;
  }
  check(sound && world.get<muscle::SurfaceState>(entity).fallbacks == 0, "its vertices are where they may be");
  muscle::despawn_surface_muscle(world, entity);
  world.destroy(character);
}

}  // namespace

int main() {
  const std::vector<glm::mat4> rest = pose_leg({0.0f, 0.9f, 0.0f}, 0.0f);

  // A mistake in the host's data comes back as text, not as a crash.
  auto broken = describe_leg();
  broken[0].section_vertices = 7;
  broken[1].attachments[2].bone = 5;
  const auto refused = muscle::build_muscle_asset(broken, rest);
  check(!refused && refused.diagnostics().errors.size() == 2, "two mistakes, two errors");

  const auto asset = muscle::build_muscle_asset(describe_leg(), rest);
  check(asset.ok(), "the leg's muscles are built");
  if (!asset) {
    std::fputs(to_text(asset.diagnostics()).c_str(), stderr);
    return failures;
  }

  ecs::World world;
  ecs::Schedule schedule;
  parallel::WorkerArena workers(2);
  muscle::prepare_muscles(world);
  muscle::add_muscle_systems(schedule);

  const ecs::Entity leg = world.create();
  world.add(leg, BoneMatrices{rest, 0});
  const ecs::Entity muscles = muscle::spawn_musculature(world, leg, *asset);
  const ecs::Entity hamstring = muscle::muscle_entity(world, muscles, "hamstring");
  const ecs::Entity vastus = muscle::muscle_entity(world, muscles, "vastus");
  schedule.run(world, workers);
  const float hamstring_rest = muscle::length_of(world, hamstring);
  const float vastus_rest = muscle::length_of(world, vastus);
  check(std::abs(hamstring_rest - glm::length(glm::vec3(0.02f, -0.43f, 0.02f))) < 1e-5f, "a straight muscle's length");

  // The host's loop, with a time scale of its own: the module knows poses, not clocks.
  float knee = 0.0f;
  for (const float time_scale : {1.0f, 0.25f, 4.0f}) {
    for (int frame = 0; frame < 60; ++frame) {
      knee = std::min(1.5f, knee + 0.01f * time_scale);
      world.get<BoneMatrices>(leg).world = pose_leg({0.0f, 0.9f, 0.0f}, knee);
      schedule.run(world, workers);
      if (!finite(muscle::surface_of(world, vastus))) check(false, "the surface stays finite");
    }
  }
  check(muscle::length_of(world, hamstring) < 0.95f * hamstring_rest, "a bent knee shortens the hamstring");
  check(muscle::length_of(world, vastus) > 1.02f * vastus_rest, "a bent knee stretches the vastus");
  const auto surface = muscle::surface_of(world, vastus);
  check(surface.vertices.size() >= 5 * 8 + 2 && !surface.strips.empty() && !surface.fans.empty(), "a surface to draw");

  // A teleport: the same pose elsewhere gives the same shape there.
  const Box before = bounds(muscle::surface_of(world, hamstring));
  BoneMatrices& bones = world.get<BoneMatrices>(leg);
  bones.world = pose_leg({100.0f, 0.9f, 0.0f}, knee);
  ++bones.teleport_count;
  schedule.run(world, workers);
  const Box after = bounds(muscle::surface_of(world, hamstring));
  check(glm::length(after.low - before.low - glm::vec3(100.0f, 0.0f, 0.0f)) < 1e-3f &&
            glm::length(after.high - before.high - glm::vec3(100.0f, 0.0f, 0.0f)) < 1e-3f,
        "a teleport moves the surface rigidly");

  // Two characters share an asset; a bad frame of one does not harm the other.
  const ecs::Entity second_leg = world.create();
  world.add(second_leg, BoneMatrices{rest, 0});
  const ecs::Entity second = muscle::spawn_musculature(world, second_leg, *asset);
  world.get<BoneMatrices>(leg).world[1][3][0] = std::nanf("");
  schedule.run(world, workers);
  check(finite(muscle::surface_of(world, vastus)), "NaN bones leave a finite surface");
  check(std::abs(muscle::length_of(world, muscle::muscle_entity(world, second, "vastus")) - vastus_rest) < 1e-6f,
        "the other character is untouched");

  muscle::detach_muscle(world, hamstring);
  schedule.run(world, workers);
  check(!world.alive(hamstring) && muscle::surface_of(world, hamstring).vertices.empty(), "a detached muscle is gone");
  check(muscle::length_of(world, muscle::muscle_entity(world, second, "vastus")) > 0.0f, "the others go on");

  muscle::despawn_musculature(world, muscles);
  check(!world.alive(vastus) && world.alive(leg), "a despawned musculature leaves the character");
  world.destroy(second_leg);
  schedule.run(world, workers);
  check(finite(muscle::surface_of(world, muscle::muscle_entity(world, second, "vastus"))),
        "a musculature whose character is gone keeps its last shape");
  muscle::despawn_musculature(world, second);
  check_posed_mesh(world);
  schedule.run(world, workers);
  check(world.entity_count() == 1, "nothing is left but the first leg");
  return failures;
}
