// Calls the function that the module's README shows: a prism of muscle between two bones, one of which moves.
#include <cstdio>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/readme/prism.hpp"

fascicle::ecs::Entity add_mesh_muscle(fascicle::ecs::World& world, fascicle::ecs::Entity character,
                                      const fascicle::TriangleMesh& mesh, const std::vector<std::uint32_t>& upper,
                                      const std::vector<std::uint32_t>& lower);

int main() {
  using namespace fascicle;
  const readme::Prism prism;

  ecs::World world;
  ecs::Schedule schedule;
  parallel::WorkerArena workers(1);
  muscle::prepare_muscles(world);
  muscle::add_muscle_systems(schedule);
  const ecs::Entity character = world.create();
  world.add(character, BoneMatrices{std::vector<glm::mat4>(2, glm::mat4(1.0f)), 0});
  const ecs::Entity added = add_mesh_muscle(world, character, prism.mesh, prism.lower, prism.upper);
  if (added == ecs::kNoEntity) return 1;
  for (int frame = 1; frame <= 60; ++frame) {
    world.get<BoneMatrices>(character).world[1] =
        glm::translate(glm::mat4(1.0f), glm::vec3(0.0f, 0.0f, 0.0003f * static_cast<float>(frame)));
    schedule.run(world, workers);
  }
  const muscle::SurfaceState& state = world.get<muscle::SurfaceState>(added);
  std::printf("%zu vertices, %.0f %% of its volume\n", world.get<muscle::DrawnSurface>(added).vertices.size(),
              100.0 * state.volume / world.get<muscle::SurfaceMuscle>(added).asset->volume);
}
