// Calls the function that the module's README shows, with one contact of each kind.
#include "engine/ecs/world.hpp"
#include "modules/muscle/muscle.hpp"

void hear_contacts(const fascicle::ecs::World& world, fascicle::ecs::Entity musculature);

int main() {
  using namespace fascicle;
  ecs::World world;
  const ecs::Entity musculature = world.create();
  muscle::MuscleContacts contacts;
  contacts.began.resize(2);
  contacts.began[0].muscle = 2;
  contacts.began[0].bone = 1;
  contacts.began[0].depth = 0.0035f;
  contacts.began[1].other = 3;
  contacts.now = contacts.began;
  world.add(musculature, contacts);
  hear_contacts(world, musculature);
}
