#include "modules/muscle/systems/4_solve/report_contacts.hpp"

#include <algorithm>
#include <tuple>

#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/kernels/collision/solve_collision.hpp"

namespace fascicle::muscle {
namespace {

// Bones before other muscles.
std::tuple<std::uint32_t, bool, std::int32_t, std::uint32_t> order_of(const MuscleContact& contact) {
  return {contact.muscle, contact.bone < 0, contact.bone, contact.other};
}

bool comes_before(const MuscleContact& a, const MuscleContact& b) { return order_of(a) < order_of(b); }

// Those of `from` that are not in `in`; both in order.
void list_missing(const std::vector<MuscleContact>& from, const std::vector<MuscleContact>& in,
                  std::vector<MuscleContact>& missing) {
  missing.clear();
  auto other = in.begin();
  for (const MuscleContact& contact : from) {
    while (other != in.end() && comes_before(*other, contact)) ++other;
    const bool known = other != in.end() && order_of(*other) == order_of(contact);
    if (!known && missing.size() < missing.capacity()) missing.push_back(contact);
  }
}

}  // namespace

void report_contacts(const CollisionAsset& asset, const CollisionWork& work, MuscleCollision& collision,
                     MuscleContacts& contacts) {
  std::swap(contacts.now, contacts.ended);  // the last step's, until they are sorted out
  std::vector<MuscleContact>& now = contacts.now;
  now.clear();
  std::fill(collision.depth.begin(), collision.depth.end(), 0.0f);
  std::fill(collision.cost.begin(), collision.cost.end(), 0.0f);
  for (const Contact& found : work.contacts) {
    MuscleContact contact;
    contact.muscle = asset.sections[found.section].muscle;
    collision.cost[contact.muscle] += 1.0f;
    if (found.bone < 0) collision.cost[asset.sections[found.other_section].muscle] += 1.0f;
    contact.left = std::max(-contact_value(found, work), 0.0f);
    collision.depth[contact.muscle] = std::max(collision.depth[contact.muscle], contact.left);
    if (found.push <= 0.0f && found.found > 0.0f) continue;
    contact.depth = std::max(-found.found, 0.0f);
    contact.points = 1;
    contact.place = found.place;
    contact.normal = found.normal;
    if (found.bone >= 0) {
      contact.bone = asset.bones[static_cast<std::size_t>(found.bone)];
    } else {
      contact.other = asset.sections[found.other_section].muscle;
      collision.depth[contact.other] = std::max(collision.depth[contact.other], contact.left);
      if (contact.other < contact.muscle) {
        std::swap(contact.muscle, contact.other);
        contact.normal = -contact.normal;
      }
    }
    const auto place = std::lower_bound(now.begin(), now.end(), contact, comes_before);
    if (place == now.end() || order_of(*place) != order_of(contact)) {
      if (now.size() < now.capacity()) now.insert(place, contact);
      else ++collision.overflows;
      continue;
    }
    ++place->points;
    place->left = std::max(place->left, contact.left);
    if (contact.depth > place->depth) {
      place->depth = contact.depth;
      place->place = contact.place;
      place->normal = contact.normal;
    }
  }
  list_missing(now, contacts.ended, contacts.began);
  std::swap(contacts.gone, contacts.ended);
  list_missing(contacts.gone, now, contacts.ended);
  collision.contact_count = static_cast<std::uint32_t>(work.contacts.size());
  if (work.overflow) ++collision.overflows;
}

}  // namespace fascicle::muscle
