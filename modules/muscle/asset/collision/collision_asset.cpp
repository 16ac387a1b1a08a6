#include "modules/muscle/asset/collision/collision_asset.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "modules/muscle/asset/collision/tag_angle.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/kernels/collision/keep_sides.hpp"
#include "modules/muscle/kernels/collision/place_samples.hpp"
#include "modules/muscle/kernels/collision/solve_collision.hpp"
#include "modules/muscle/kernels/inflate_section.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kBorderWidth = 0.01f;  // m: over this from a tendon's border on, a section becomes belly
constexpr float kDeepAtRest = 0.003f;   // m
constexpr float kOverlapSlack = 1.0e-4f;  // m: allowed at rest beyond what was found there

// The bone that carries most of each slot's point.
std::vector<std::uint32_t> carrying_bones(const MuscleAsset& muscles) {
  std::vector<std::uint32_t> bones(muscles.slot_count, 0);
  for (const PointBinding& point : muscles.points) {
    bones[point.slot] = point.second[3] > point.first[3] ? point.second_bone : point.first_bone;
  }
  return bones;
}

float arc_at(const MuscleAsset& muscles, std::uint32_t m, std::uint32_t k) { return muscles.rest_arc[muscles.slot(m, k)]; }

void list_sections(CollisionAsset& asset) {
  const MuscleAsset& muscles = *asset.muscles;
  const std::vector<std::uint32_t> bones = carrying_bones(muscles);
  for (std::uint32_t m = 0; m < muscles.size(); ++m) {
    const MuscleLayout& layout = muscles.muscles[m];
    const std::uint32_t last = layout.section_count - 1;
    const float length = arc_at(muscles, m, last);
    const float belly_from = layout.tendon_lengths[0], belly_to = length - layout.tendon_lengths[1];
    asset.first_section.push_back(static_cast<std::uint32_t>(asset.sections.size()));
    asset.rest_line.push_back(length);
    asset.rest_belly.push_back(std::max(belly_to - belly_from, 0.1f * length));
    for (std::uint32_t k = 0; k <= last; ++k) {
      CollisionSection section;
      section.muscle = m;
      section.section = k;
      section.slot = muscles.slot(m, k);
      section.first_radius = muscles.radius(m, k);
      section.count = layout.section_vertices;
      section.bone = bones[section.slot];
      section.end = k == 0 || k == last;
      section.via = !section.end && k % (1u << layout.subdivision) == 0;
      section.rest_area = section_area(std::span(&muscles.rest_radii[section.first_radius], section.count));
      const float arc = arc_at(muscles, m, k);
      float inside = kBorderWidth;
      if (layout.tendon_drawn[0]) inside = std::min(inside, arc - belly_from);
      if (layout.tendon_drawn[1]) inside = std::min(inside, belly_to - arc);
      section.belly = std::clamp(inside / kBorderWidth, 0.0f, 1.0f);
      asset.sections.push_back(section);
    }
  }
  asset.first_section.push_back(static_cast<std::uint32_t>(asset.sections.size()));
}

// A row's samples: the meridians, and between those that are far apart as many as keep the spacing.
void add_row(std::uint32_t section, float weight, float spacing, CollisionAsset& asset) {
  const MuscleAsset& muscles = *asset.muscles;
  const std::uint32_t m = asset.sections[section].muscle, k = asset.sections[section].section;
  const std::uint32_t count = asset.sections[section].count;
  const auto place = [&](std::uint32_t i) {
    const glm::vec3 here = rest_vertex(muscles, m, k, i);
    return weight > 0.0f ? glm::mix(here, rest_vertex(muscles, m, k + 1, i), weight) : here;
  };
  SampleRow row{section, weight, static_cast<std::uint32_t>(asset.samples.size()), 0};
  const float most = static_cast<float>(kMaxRowSamples / count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const float apart = glm::distance(place(i), place(i + 1 == count ? 0 : i + 1));
    const std::uint32_t parts = static_cast<std::uint32_t>(std::clamp(std::round(apart / spacing), 1.0f, most));
    for (std::uint32_t j = 0; j < parts; ++j) {
      asset.samples.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(65536u * j / parts)});
    }
  }
  row.sample_count = static_cast<std::uint32_t>(asset.samples.size()) - row.first_sample;
  asset.rows.push_back(row);
}

// Rows on the inner sections, and between sections as many as keep the spacing.
void list_rows(float spacing, CollisionAsset& asset) {
  const MuscleAsset& muscles = *asset.muscles;
  for (std::uint32_t m = 0; m < muscles.size(); ++m) {
    asset.first_row.push_back(static_cast<std::uint32_t>(asset.rows.size()));
    const std::uint32_t last = muscles.muscles[m].section_count - 1;
    for (std::uint32_t k = 0; k < last; ++k) {
      const std::uint32_t section = asset.first_section[m] + k;
      if (k > 0) add_row(section, 0.0f, spacing, asset);
      // Of the end segments the inner half.
      const float from = k == 0 ? 0.5f : 0.0f, to = k + 1 == last ? 0.5f : 1.0f;
      // Where the line bends, or the muscle fans out, meridians are much longer than the line.
      float length = 0.0f;
      for (std::uint32_t i = 0; i < asset.sections[section].count; ++i) {
        length = std::max(length, glm::distance(rest_vertex(muscles, m, k, i), rest_vertex(muscles, m, k + 1, i)));
      }
      length *= to - from;
      const std::uint32_t parts = static_cast<std::uint32_t>(std::clamp(std::ceil(length / spacing), 1.0f, 64.0f));
      for (std::uint32_t i = 0; i <= parts; ++i) {
        const float weight = from + (to - from) * static_cast<float>(i) / static_cast<float>(parts);
        if (weight > 0.0f && weight < 1.0f) add_row(section, weight, spacing, asset);
      }
    }
  }
  asset.first_row.push_back(static_cast<std::uint32_t>(asset.rows.size()));
}

float row_fraction(const CollisionAsset& asset, const SampleRow& row) {
  const CollisionSection& section = asset.sections[row.section];
  const float from = arc_at(*asset.muscles, section.muscle, section.section);
  const float to = arc_at(*asset.muscles, section.muscle, section.section + 1);
  return (from + row.weight * (to - from)) / asset.rest_line[section.muscle];
}

// Who may touch whom: everybody, but for what tags and ignored pairs say.
void list_pairs(const CollisionDescription& description, CollisionAsset& asset) {
  const std::size_t muscle_count = asset.muscles->size(), bone_count = asset.bones.size();
  asset.muscles_touch.assign(muscle_count * muscle_count, kTouch);
  for (std::size_t m = 0; m < muscle_count; ++m) asset.muscles_touch[m * muscle_count + m] = kNeverTouch;
  asset.row_touches_bone.assign(asset.rows.size() * bone_count, 1);
  const auto place_of = [&](std::int32_t bone) {
    return static_cast<std::size_t>(std::find(asset.bones.begin(), asset.bones.end(), bone) - asset.bones.begin());
  };
  for (std::size_t m = 0; m < muscle_count; ++m) {
    for (std::uint32_t r = asset.first_row[m]; r < asset.first_row[m + 1]; ++r) {
      const float fraction = row_fraction(asset, asset.rows[r]);
      const auto covers = [&](const BoneTag& tag) {
        return tag.muscle == m && !tag.automatic && tag.from <= fraction && fraction <= tag.to;
      };
      if (std::none_of(description.bone_tags.begin(), description.bone_tags.end(), covers)) continue;
      std::fill_n(asset.row_touches_bone.begin() + static_cast<std::ptrdiff_t>(r * bone_count), bone_count, std::uint8_t{0});
      for (const BoneTag& tag : description.bone_tags) {
        if (!covers(tag)) continue;
        for (const std::int32_t bone : tag.bones) {
          if (const std::size_t place = place_of(bone); place < bone_count) {
            asset.row_touches_bone[r * bone_count + place] = 1;
          }
        }
      }
    }
  }
  for (const IgnoredPair& pair : description.ignored) {
    if (pair.bone < 0) {
      asset.muscles_touch[pair.muscle * muscle_count + pair.other] = kNeverTouch;
      asset.muscles_touch[pair.other * muscle_count + pair.muscle] = kNeverTouch;
    } else if (const std::size_t place = place_of(pair.bone); place < bone_count) {
      for (std::uint32_t r = asset.first_row[pair.muscle]; r < asset.first_row[pair.muscle + 1]; ++r) {
        asset.row_touches_bone[r * bone_count + place] = 0;
      }
    }
  }
}

// The work's state at rest.
void load_rest(const CollisionAsset& asset, CollisionWork& work) {
  const MuscleAsset& muscles = *asset.muscles;
  work.reserve(asset);
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    const std::uint32_t slot = asset.sections[s].slot;
    work.a[s] = glm::vec3(muscles.rest_x[slot], muscles.rest_y[slot], muscles.rest_z[slot]);
    work.driven[s] = work.a[s];
    work.u[s] = glm::vec3(muscles.rest_ux[slot], muscles.rest_uy[slot], muscles.rest_uz[slot]);
    work.v[s] = glm::vec3(muscles.rest_vx[slot], muscles.rest_vy[slot], muscles.rest_vz[slot]);
    work.t[s] = glm::cross(work.u[s], work.v[s]);
    work.mobility[s] = 1.0f;
  }
  std::fill(work.absent.begin(), work.absent.end(), std::uint8_t{0});
  std::copy(muscles.rest_radii.begin(), muscles.rest_radii.end(), work.radii.begin());
  place_directions(asset, work);
}

// How deep samples are at rest: what a search without anything allowed finds.
void allow_rest_overlaps(const CollisionDescription& description, std::span<const glm::mat4> rest_bones,
                         CollisionAsset& asset) {
  const std::size_t bone_count = asset.bones.size();
  asset.row_bone_depths.assign(asset.rows.size() * bone_count, kNoDepths);
  asset.first_overlap.assign(asset.rows.size() + 1, 0);
  asset.centre_bone_depths.assign(asset.sections.size() * bone_count, 0.0f);
  for (std::size_t s = 0; s < asset.sections.size(); ++s) {
    // A centre may be where the row on its section may.
    const std::uint32_t m = asset.sections[s].muscle;
    const auto on_section = [&](const SampleRow& row) { return row.section == s && row.weight == 0.0f; };
    const auto first = asset.rows.begin() + asset.first_row[m], last = asset.rows.begin() + asset.first_row[m + 1];
    const auto row = std::find_if(first, last, on_section);
    if (row == last) continue;
    const std::size_t r = static_cast<std::size_t>(row - asset.rows.begin());
    for (std::size_t place = 0; place < bone_count; ++place) {
      if (asset.row_touches_bone[r * bone_count + place] == 0) {
        asset.centre_bone_depths[s * bone_count + place] = kNeverTouches;
      }
    }
  }
  CollisionWork work;
  load_rest(asset, work);
  work.contacts.reserve(std::size_t{16} * asset.samples.size() + 1024);
  find_contacts(asset, description.settings, rest_bones, work, true);

  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<float>> overlaps;  // by row and other muscle
  for (const Contact& contact : work.contacts) {
    const float depth = -contact.found + kOverlapSlack;
    if (depth <= 0.0f) continue;
    const std::uint32_t count = contact.row == kCentreRow ? 0 : asset.rows[contact.row].sample_count;
    if (contact.row == kCentreRow) {
      asset.centre_bone_depths[contact.section * bone_count + static_cast<std::size_t>(contact.bone)] = depth;
    } else if (contact.bone >= 0) {
      std::uint32_t& first = asset.row_bone_depths[contact.row * bone_count + static_cast<std::size_t>(contact.bone)];
      if (first == kNoDepths) {
        first = static_cast<std::uint32_t>(asset.rest_depths.size());
        asset.rest_depths.resize(first + count, 0.0f);
      }
      asset.rest_depths[first + contact.sample] = std::max(asset.rest_depths[first + contact.sample], depth);
    } else {
      std::vector<float>& depths = overlaps[{contact.row, asset.sections[contact.other_section].muscle}];
      depths.resize(count, 0.0f);
      if (depth > kDeepAtRest) {
        const std::size_t m = asset.sections[contact.section].muscle, other = asset.sections[contact.other_section].muscle;
        asset.muscles_touch[m * asset.muscles->size() + other] = kInterpenetrate;
        asset.muscles_touch[other * asset.muscles->size() + m] = kInterpenetrate;
      }
      depths[contact.sample] = std::max(depths[contact.sample], depth);
    }
  }
  for (const auto& [pair, depths] : overlaps) {
    ++asset.first_overlap[pair.first + 1];
    asset.overlaps.push_back({pair.second, static_cast<std::uint32_t>(asset.rest_depths.size())});
    asset.rest_depths.insert(asset.rest_depths.end(), depths.begin(), depths.end());
  }
  for (std::size_t r = 0; r < asset.rows.size(); ++r) asset.first_overlap[r + 1] += asset.first_overlap[r];
}

// The nearest point of a bone's surface, by walking down its field.
glm::vec3 nearest_on_bone(const BoneField& field, glm::vec3 p) {
  for (int i = 0; i < 8; ++i) {
    const FieldValue value = field.at(p);
    p -= value.distance * value.gradient;
  }
  return p;
}

// The tags at this level, and their depths at rest. Those of bones without a field are left out.
void list_transversals(const CollisionDescription& description, std::span<const std::shared_ptr<const BoneField>> fields,
                       std::span<const glm::mat4> rest_bones, CollisionAsset& asset) {
  CollisionWork work;
  load_rest(asset, work);
  for (std::uint32_t i = 0; i < description.transversals.size(); ++i) {
    const TransversalTag& tag = description.transversals[i];
    const TaggedVertex first = find_tagged_vertex(*asset.muscles, tag.first);
    Transversal transversal;
    transversal.tag = i;
    transversal.sweeps = tag.sweeps;
    transversal.section = asset.first_section[tag.first.muscle] + first.section;
    transversal.vertex = first.vertex;
    transversal.first_yields = tag.yields != Yields::kSecond || tag.bone >= 0;
    transversal.second_yields = tag.yields != Yields::kFirst;
    if (tag.bone >= 0) {
      const std::size_t bone = static_cast<std::size_t>(tag.bone);
      if (bone >= fields.size() || !fields[bone]) continue;
      transversal.bone = tag.bone;
      const std::uint32_t radius = asset.sections[transversal.section].first_radius + first.vertex;
      const glm::vec3 vertex = work.a[transversal.section] +
                               work.radii[radius] * glm::vec3(work.dir_x[radius], work.dir_y[radius], work.dir_z[radius]);
      const glm::mat4& rest = rest_bones[bone];
      transversal.point = nearest_on_bone(*fields[bone], (vertex - glm::vec3(rest[3])) * glm::mat3(rest));
    } else {
      const TaggedVertex second = find_tagged_vertex(*asset.muscles, tag.second);
      transversal.other_section = asset.first_section[tag.second.muscle] + second.section;
      transversal.other_vertex = second.vertex;
    }
    transversal.rest_depth = transversal_depth(asset, transversal, rest_bones, work);
    asset.transversals.push_back(transversal);
  }
}

}  // namespace

glm::vec3 rest_vertex(const MuscleAsset& muscles, std::uint32_t m, std::uint32_t k, std::uint32_t i) {
  const std::uint32_t slot = muscles.slot(m, k);
  const Circle& circle = muscles.circles[muscles.layouts[m].circle];
  const glm::vec3 u(muscles.rest_ux[slot], muscles.rest_uy[slot], muscles.rest_uz[slot]);
  const glm::vec3 v(muscles.rest_vx[slot], muscles.rest_vy[slot], muscles.rest_vz[slot]);
  return rest_point(muscles, m, k) +
         muscles.rest_radii[muscles.radius(m, k) + i] * (circle.cosines[i] * u + circle.sines[i] * v);
}

TaggedVertex find_tagged_vertex(const MuscleAsset& muscles, const SectionTag& tag) {
  const MuscleLayout& layout = muscles.muscles[tag.muscle];
  const std::uint32_t last = layout.section_count - 1;
  const float arc = tag.fraction * arc_at(muscles, tag.muscle, last);
  TaggedVertex found;
  found.section = last > 1 ? 1 : 0;
  for (std::uint32_t k = found.section + 1; k < last; ++k) {
    if (std::abs(arc_at(muscles, tag.muscle, k) - arc) < std::abs(arc_at(muscles, tag.muscle, found.section) - arc)) {
      found.section = k;
    }
  }
  const float count = static_cast<float>(layout.section_vertices);
  const float angle = wrap_angle(tag.angle + tag_angle_offset(muscles, tag.muscle, found.section));
  const float turns = angle / (2.0f * std::numbers::pi_v<float>);
  found.vertex = static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * count)) % layout.section_vertices;
  return found;
}

std::shared_ptr<const CollisionAsset> build_collision_asset(std::shared_ptr<const MuscleAsset> muscles,
                                                            const CollisionDescription& description,
                                                            std::span<const std::shared_ptr<const BoneField>> fields,
                                                            std::span<const glm::mat4> rest_bones) {
  auto asset = std::make_shared<CollisionAsset>();
  asset->muscles = std::move(muscles);
  for (std::size_t bone = 0; bone < fields.size(); ++bone) {
    if (!fields[bone]) continue;
    asset->bones.push_back(static_cast<std::int32_t>(bone));
    asset->fields.push_back(fields[bone]);
  }
  asset->bone_count = asset->muscles->bone_count;
  if (!asset->bones.empty()) {
    asset->bone_count = std::max(asset->bone_count, static_cast<std::uint32_t>(asset->bones.back()) + 1);
  }
  list_sections(*asset);
  list_rows(description.settings.sample_spacing, *asset);
  list_pairs(description, *asset);
  allow_rest_overlaps(description, rest_bones, *asset);
  list_transversals(description, fields, rest_bones, *asset);
  return asset;
}

std::size_t heap_bytes(const CollisionAsset& asset) {
  const auto bytes = [](const auto&... arrays) { return (std::size_t{0} + ... + (arrays.capacity() * sizeof(arrays[0]))); };
  return bytes(asset.first_section, asset.sections, asset.first_row, asset.rows, asset.samples, asset.rest_line, asset.rest_belly,
               asset.bones, asset.fields, asset.row_touches_bone, asset.row_bone_depths, asset.muscles_touch,
               asset.first_overlap, asset.overlaps, asset.rest_depths, asset.transversals);
}

}  // namespace fascicle::muscle
