#include "modules/muscle/kernels/collision/bone_contacts.hpp"

#include <algorithm>
#include <array>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "modules/muscle/kernels/collision/contact_rows.hpp"

namespace fascicle::muscle {
namespace {

// A sample whose own surface looks along the way out of the bone, rather than against it, has come through to the far
// side: it goes back the way it came, against its own normal, not out of the back.
constexpr float kThrough = 0.3f;
constexpr float kBarely = 0.002f;  // m

// What is deep in it at rest has no side that it came from.
bool has_come_through(const FieldValue& value, float allowed, const glm::vec3& normal, const glm::vec3& outward) {
  return allowed < kBarely && value.distance + allowed < 0.0f && glm::dot(normal, outward) > kThrough;
}

bool overlap(const Bounds& a, const Bounds& b) {
  return glm::all(glm::lessThanEqual(a.lower, b.upper)) && glm::all(glm::lessThanEqual(b.lower, a.upper));
}

// The world's box of a bone's own.
Bounds bone_box(const BoneField& field, const glm::mat4& bone, float reach) {
  const glm::vec3 centre = glm::vec3(bone * glm::vec4(0.5f * (field.lower() + field.upper()), 1.0f));
  const glm::vec3 half = 0.5f * (field.upper() - field.lower());
  const glm::vec3 extent = glm::abs(glm::vec3(bone[0])) * half.x + glm::abs(glm::vec3(bone[1])) * half.y +
                           glm::abs(glm::vec3(bone[2])) * half.z + reach;
  return {centre - extent, centre + extent};
}

class BoneTest {
 public:
  BoneTest(const CollisionAsset& asset, std::size_t place, const glm::mat4& bone, float margin, float reach,
           CollisionWork& work)
      : asset_(asset), field_(*asset.fields[place]), place_(place), turn_(bone), origin_(bone[3]), margin_(margin),
        reach_(reach), work_(work) {}

  void test(std::uint32_t r) {
    const RowDisc& disc = work_.row_discs[r];
    const std::uint32_t depths = asset_.row_bone_depths[r * asset_.bones.size() + place_];
    const glm::vec3 centre = to_bone(disc.centre);
    const float reach = disc.radius + margin_ + reach_;
    if (glm::any(glm::lessThan(centre, field_.lower() - reach)) || glm::any(glm::greaterThan(centre, field_.upper() + reach)))
      return;
    if (field_.distance(centre) > reach) return;
    const SampleRow& row = asset_.rows[r];
    const std::uint32_t count = row.sample_count;
    std::array<float, kMaxRowSamples> x, y, z, distance;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t s = row.first_sample + i;
      const glm::vec3 p = to_bone(glm::vec3(work_.sample_x[s], work_.sample_y[s], work_.sample_z[s]));
      x[i] = p.x;
      y[i] = p.y;
      z[i] = p.z;
    }
    const auto part = [&](std::array<float, kMaxRowSamples>& all) { return std::span(all).first(count); };
    field_.distances(part(x), part(y), part(z), part(distance));
    for (std::uint32_t i = 0; i < count; ++i) {
      const float allowed = depths == kNoDepths ? 0.0f : asset_.rest_depths[depths + i];
      if (distance[i] + allowed - margin_ > reach_) continue;
      add(r, i, glm::vec3(x[i], y[i], z[i]), allowed);
    }
  }

 private:
  glm::vec3 to_bone(const glm::vec3& p) const { return (p - origin_) * turn_; }

  void add(std::uint32_t r, std::uint32_t i, const glm::vec3& place, float allowed) {
    const FieldValue value = field_.at(place);
    if (value.gradient == glm::vec3(0.0f)) return;
    Contact contact;
    contact.bone = static_cast<std::int32_t>(place_);
    contact.normal = turn_ * value.gradient;
    const glm::vec3 outward = sample_normal(asset_, work_, r, i);
    if (has_come_through(value, allowed, contact.normal, outward)) contact.normal = -outward;
    if (!carry_sample(asset_, work_, r, i, contact)) return;
    contact.allowed = allowed;
    contact.found = value.distance + allowed - margin_;
    contact.base = glm::dot(contact.normal, contact.place) - contact.found;
    add_contact(contact, work_);
  }

  const CollisionAsset& asset_;
  const BoneField& field_;
  std::size_t place_;
  glm::mat3 turn_;
  glm::vec3 origin_;
  float margin_, reach_;
  CollisionWork& work_;
};

// A centre in a bone would have its section grow around the bone: it has to come out as a whole.
void test_centres(const CollisionAsset& asset, std::size_t place, const glm::mat4& bone, float margin, float reach,
                  std::uint32_t m, CollisionWork& work) {
  for (std::uint32_t s = asset.first_section[m]; s < asset.first_section[m + 1]; ++s) {
    if (work.mobility[s] == 0.0f) continue;
    const float allowed = asset.centre_bone_depths[s * asset.bones.size() + place];
    if (allowed == kNeverTouches) continue;
    const FieldValue value = asset.fields[place]->at((work.a[s] - glm::vec3(bone[3])) * glm::mat3(bone));
    Contact contact;
    contact.allowed = allowed;
    contact.found = value.distance + allowed - margin;
    if (contact.found > reach || value.gradient == glm::vec3(0.0f)) continue;
    contact.bone = static_cast<std::int32_t>(place);
    contact.normal = glm::mat3(bone) * value.gradient;
    contact.place = work.a[s];
    contact.section = s;
    contact.weight[0] = 1.0f;
    std::fill_n(contact.radius, 4, asset.sections[s].first_radius);
    contact.row = kCentreRow;
    contact.base = glm::dot(contact.normal, contact.place) - contact.found;
    add_contact(contact, work);
  }
}

}  // namespace

void find_bone_contacts(const CollisionAsset& asset, std::span<const glm::mat4> bones, float margin, float reach,
                        CollisionWork& work) {
  for (std::size_t place = 0; place < asset.bones.size(); ++place) {
    const glm::mat4& bone = bones[static_cast<std::size_t>(asset.bones[place])];
    const Bounds box = bone_box(*asset.fields[place], bone, margin + reach);
    BoneTest bone_test(asset, place, bone, margin, reach, work);
    for (std::size_t m = 0; m + 1 < asset.first_row.size(); ++m) {
      if (!overlap(work.muscle_boxes[m], box)) continue;
      for (std::uint32_t r = asset.first_row[m]; r < asset.first_row[m + 1]; ++r) {
        if (asset.row_touches_bone[r * asset.bones.size() + place] == 0 || !overlap(work.row_boxes[r], box)) continue;
        bone_test.test(r);
      }
      test_centres(asset, place, bone, margin, reach, static_cast<std::uint32_t>(m), work);
    }
  }
}

void refresh_bone_contacts(const CollisionAsset& asset, std::span<const glm::mat4> bones, float margin,
                           CollisionWork& work) {
  for (Contact& contact : work.contacts) {
    if (contact.bone < 0) continue;
    const std::size_t place = static_cast<std::size_t>(contact.bone);
    const glm::mat4& bone = bones[static_cast<std::size_t>(asset.bones[place])];
    const glm::vec3 now = sample_place(contact, work);
    const FieldValue value = asset.fields[place]->at((now - glm::vec3(bone[3])) * glm::mat3(bone));
    if (value.gradient == glm::vec3(0.0f)) continue;
    glm::vec3 normal = glm::mat3(bone) * value.gradient;
    if (contact.row != kCentreRow) {
      const glm::vec3 outward = sample_normal(asset, work, contact.row, contact.sample);
      if (has_come_through(value, contact.allowed, normal, outward)) normal = -outward;
    }
    turn_contact(work, normal, contact);
    weigh_contact(work, contact);
    contact.base = glm::dot(normal, now) - (value.distance + contact.allowed - margin);
  }
}

}  // namespace fascicle::muscle
