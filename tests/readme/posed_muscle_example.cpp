// Calls the functions that the module's README shows: a prism of muscle gets a coarse hull and is scrubbed through poses
// in any order.
#include <cstdio>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/animation/skeleton.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/parallel/worker_arena.hpp"
#include "modules/muscle/muscle.hpp"
#include "tests/readme/prism.hpp"

bool give_hull(fascicle::ecs::World& world, fascicle::ecs::Entity muscle,
               fascicle::muscle::SurfaceMuscleDescription description);
bool bake(fascicle::ecs::World& world, fascicle::ecs::Entity character, fascicle::ecs::Entity muscle,
          const std::vector<glm::mat4>& bones, std::vector<glm::vec3>& vertices);

int main() {
  using namespace fascicle;
  const readme::Prism prism;
  muscle::SurfaceMuscleDescription description;
  description.name = "vastus";
  description.mesh = prism.mesh;
  description.attachments = {{.bone = 0, .origin = true, .vertices = prism.lower},
                             {.bone = 1, .origin = false, .vertices = prism.upper}};
  const std::vector<glm::mat4> rest(2, glm::mat4(1.0f));
  const auto asset = muscle::build_surface_asset(description, 2);
  if (!asset) return std::puts(to_text(asset.diagnostics()).c_str()), 1;

  ecs::World world;
  ecs::Schedule schedule;
  parallel::WorkerArena workers(1);
  muscle::prepare_muscles(world);
  muscle::add_muscle_systems(schedule);
  const ecs::Entity character = world.create();
  world.add(character, BoneMatrices{rest, 0});
  const ecs::Entity entity = muscle::spawn_surface_muscle(world, character, *asset, rest, {});
  if (!give_hull(world, entity, description)) return 1;

  std::vector<std::vector<glm::vec3>> shapes;
  for (const float angle : {0.1f, 0.4f, 0.0f, 0.1f}) {
    const glm::mat4 bent = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(1.0f, 0.0f, 0.0f));
    if (!bake(world, character, entity, {glm::mat4(1.0f), bent}, shapes.emplace_back())) return 1;
  }
  schedule.run(world, workers);  // nobody looks, so the finest level: dynamics go on from there
  std::printf("%zu vertices, %s when it comes back, %s\n", shapes[0].size(),
              shapes[3] == shapes[0] && shapes[1] != shapes[0] ? "the same" : "another",
              world.get<muscle::SurfaceHull>(entity).solver == muscle::SurfaceSolver::kDynamic ? "then dynamic"
                                                                                              : "then posed");
}
