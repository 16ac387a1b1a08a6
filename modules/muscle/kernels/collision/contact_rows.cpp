#include "modules/muscle/kernels/collision/contact_rows.hpp"

#include <cmath>

#include <glm/geometric.hpp>

namespace fascicle::muscle {
namespace {

glm::vec3 direction(const CollisionWork& work, std::uint32_t radius) {
  return glm::vec3(work.dir_x[radius], work.dir_y[radius], work.dir_z[radius]);
}

// A radius may move where its centre may.
float radius_mobility(const CollisionWork& work, std::uint32_t section) {
  return work.mobility[section] > 0.0f ? 1.0f : 0.0f;
}

}  // namespace

glm::vec3 sample_normal(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t row,
                        std::uint32_t sample) {
  const SampleRow& r = asset.rows[row];
  const std::uint32_t section = r.weight < 0.5f ? r.section : r.section + 1;
  const SurfaceSample& s = asset.samples[r.first_sample + sample];
  const std::uint32_t count = asset.sections[section].count, first = asset.sections[section].first_radius;
  const std::uint32_t from = s.fraction > 0 ? s.vertex : (s.vertex == 0 ? count - 1 : s.vertex - 1u);
  const std::uint32_t to = s.vertex + 1u == count ? 0u : s.vertex + 1u;
  const auto vertex = [&](std::uint32_t i) {
    return glm::vec3(work.vertex_x[first + i], work.vertex_y[first + i], work.vertex_z[first + i]);
  };
  const glm::vec3 normal = glm::cross(vertex(to) - vertex(from), work.t[section]);
  const float length2 = glm::dot(normal, normal);
  return length2 > 1.0e-14f ? normal / std::sqrt(length2) : direction(work, first + s.vertex);
}

glm::vec3 sample_place(const Contact& contact, const CollisionWork& work) {
  // On a section the second half has no weight, whatever it names.
  const std::uint32_t next = contact.weight[1] > 0.0f ? contact.section + 1 : contact.section;
  glm::vec3 place = contact.weight[0] * work.a[contact.section] + contact.weight[1] * work.a[next];
  for (std::uint32_t j = 0; j < 4; ++j) {
    place += (contact.share[j] * work.radii[contact.radius[j]]) * direction(work, contact.radius[j]);
  }
  return place;
}

void turn_contact(const CollisionWork& work, const glm::vec3& normal, Contact& contact) {
  contact.normal = normal;
  for (std::uint32_t j = 0; j < 4; ++j) {
    contact.lever[j] = contact.share[j] * glm::dot(normal, direction(work, contact.radius[j]));
  }
}

bool carry_sample(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t row, std::uint32_t sample,
                  Contact& contact) {
  const SampleRow& r = asset.rows[row];
  const std::uint32_t place = r.first_sample + sample;
  contact.row = row;
  contact.sample = sample;
  contact.place = glm::vec3(work.sample_x[place], work.sample_y[place], work.sample_z[place]);
  contact.section = r.section;
  const SurfaceSample& s = asset.samples[place];
  const SampleWeights weights = sample_weights(r.weight, kSampleFraction * static_cast<float>(s.fraction));
  const std::uint32_t count = asset.sections[r.section].count;
  const std::uint32_t next = s.vertex + 1u == count ? 0u : s.vertex + 1u;
  bool moves = false;
  for (std::uint32_t k = 0; k < 2; ++k) {
    // A sample on a section names that section twice, the second time with no weight.
    const std::uint32_t section = r.section + (r.weight > 0.0f ? k : 0);
    const std::uint32_t first = asset.sections[section].first_radius;
    contact.weight[k] = weights.of[2 * k] + weights.of[2 * k + 1];
    for (std::uint32_t j = 0; j < 2; ++j) {
      const std::uint32_t radius = first + (j == 0 ? s.vertex : next);
      contact.radius[2 * k + j] = radius;
      contact.share[2 * k + j] = weights.of[2 * k + j];
      contact.lever[2 * k + j] = weights.of[2 * k + j] * glm::dot(contact.normal, direction(work, radius));
    }
    moves = moves || (contact.weight[k] > 0.0f && work.mobility[section] > 0.0f);
  }
  return moves || contact.bone < 0;
}

void carry_outline(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t section, float along,
                   std::uint32_t edge, float fraction, Contact& contact) {
  contact.other_section = section;
  contact.other_weight[0] = 1.0f - along;
  contact.other_weight[1] = along;
  const std::uint32_t count = asset.sections[section].count;
  const std::uint32_t next = edge + 1 == count ? 0 : edge + 1;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const std::uint32_t first = asset.sections[section + k].first_radius;
    for (std::uint32_t j = 0; j < 2; ++j) {
      const float weight = contact.other_weight[k] * (j == 0 ? 1.0f - fraction : fraction);
      const std::uint32_t radius = first + (j == 0 ? edge : next);
      contact.other_radius[2 * k + j] = radius;
      contact.other_lever[2 * k + j] = -weight * glm::dot(contact.normal, direction(work, radius));
    }
  }
}

bool weigh_contact(const CollisionWork& work, Contact& contact) {
  float sum = 0.0f;
  for (std::uint32_t k = 0; k < 2; ++k) {
    if (contact.weight[k] == 0.0f) continue;
    const std::uint32_t section = contact.section + k;
    sum += work.mobility[section] * contact.weight[k] * contact.weight[k];
    for (std::uint32_t j = 2 * k; j < 2 * k + 2; ++j) {
      sum += radius_mobility(work, section) * contact.lever[j] * contact.lever[j];
    }
  }
  if (contact.bone < 0) {
    for (std::uint32_t k = 0; k < 2; ++k) {
      const std::uint32_t section = contact.other_section + k;
      sum += work.mobility[section] * contact.other_weight[k] * contact.other_weight[k];
      for (std::uint32_t j = 2 * k; j < 2 * k + 2; ++j) {
        sum += radius_mobility(work, section) * contact.other_lever[j] * contact.other_lever[j];
      }
    }
  }
  if (!(sum > 1.0e-6f)) return false;
  contact.inverse_mass = 1.0f / sum;
  return true;
}

void add_contact(Contact& contact, CollisionWork& work) {
  if (!weigh_contact(work, contact)) return;
  if (work.contacts.size() == work.contacts.capacity()) {
    work.overflow = true;
    return;
  }
  work.contacts.push_back(contact);
}

}  // namespace fascicle::muscle
