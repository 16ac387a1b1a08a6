#include "modules/muscle/measure/penetration_meter.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "engine/geometry/finite.hpp"
#include "engine/parallel/for_range.hpp"
#include "modules/muscle/measure/sample_surface.hpp"

namespace fascicle::muscle {
namespace {

TriangleMesh resting_mesh(const MuscleAsset& asset, std::uint32_t muscle) {
  TriangleMesh mesh;
  const MuscleLayout& layout = asset.muscles[muscle];
  mesh.indices = surface_triangles(asset, muscle);
  // The tree's shape follows the rest line: rows about it are enough to tell which triangles lie together.
  const Circle& circle = asset.circles[layout.circle];
  for (std::uint32_t row = 0; row < layout.row_count; ++row) {
    const std::uint32_t section = std::min(row, layout.section_count - 1), slot = asset.slot(muscle, section);
    const glm::vec3 u(asset.rest_ux[slot], asset.rest_uy[slot], asset.rest_uz[slot]);
    const glm::vec3 v(asset.rest_vx[slot], asset.rest_vy[slot], asset.rest_vz[slot]);
    for (std::uint32_t i = 0; i < layout.section_vertices; ++i) {
      const float radius = asset.rest_radii[asset.radius(muscle, section) + i];
      mesh.positions.push_back(rest_point(asset, muscle, section) +
                               radius * (circle.cosines[i] * u + circle.sines[i] * v));
    }
  }
  mesh.positions.push_back(rest_point(asset, muscle, 0));
  mesh.positions.push_back(rest_point(asset, muscle, layout.section_count - 1));
  return mesh;
}

Box box_of(const SurfacePatch& patch) {
  Box box = empty_box();
  for (const glm::vec3& corner : patch.corners) box.add(corner);
  return box;
}

Box moved(const Box& box, const glm::dmat4& by) {
  Box result = empty_box();
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 corner((i & 1) != 0 ? box.upper.x : box.lower.x, (i & 2) != 0 ? box.upper.y : box.lower.y,
                            (i & 4) != 0 ? box.upper.z : box.lower.z, 1.0);
    result.add(glm::vec3(by * corner));
  }
  return result;
}

bool is_usable(const glm::mat4& matrix) {
  for (int i = 0; i < 4; ++i) {
    if (!is_finite(glm::vec3(matrix[i]))) return false;
  }
  return true;
}

// Of pairs with one key the deepest, by rising keys.
template <class Key>
void keep_deepest(std::vector<PairDepth>& pairs, Key key) {
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const PairDepth& a, const PairDepth& b) { return key(a) < key(b); });
  std::vector<PairDepth> kept;
  for (const PairDepth& pair : pairs) {
    if (kept.empty() || key(kept.back()) != key(pair)) {
      kept.push_back(pair);
    } else if (pair.depth > kept.back().depth) {
      kept.back() = pair;
    }
  }
  pairs = std::move(kept);
}

}  // namespace

// One muscle's points against all that its box meets.
struct PenetrationMeter::Task {
  struct Bone {
    const BoneSolid* solid = nullptr;
    glm::dmat4 to_bone{1.0};
    PairDepth deepest;
  };
  struct Other {
    const Solid* solid = nullptr;
    PairDepth deepest;
  };

  std::vector<Bone> bones;
  std::vector<Other> others;
  std::vector<SampledPoint> points;
  std::uint32_t count = 0;

  void measure_bones(const Box& box) {
    for (Bone& bone : bones) {
      if (!moved(box, bone.to_bone).meets(bone.solid->box())) continue;
      for (const SampledPoint& point : points) {
        const glm::vec3 local(bone.to_bone * glm::dvec4(point.position, 1.0));
        const double deepest = static_cast<double>(bone.deepest.depth);
        note(bone.deepest, bone.solid->depth_beyond(local, deepest), point);
      }
    }
  }

  void measure_others(const Box& box) {
    for (Other& other : others) {
      if (!box.meets(other.solid->box) ||
          std::none_of(other.solid->bands.begin(), other.solid->bands.end(),
                       [&](const Box& band) { return band.meets(box); })) {
        continue;
      }
      for (const SampledPoint& point : points) {
        if (!other.solid->box.contains(point.position) || other.solid->tree.windings(point.position) < 1) continue;
        const double deepest = static_cast<double>(other.deepest.depth);
        note(other.deepest, other.solid->tree.distance_beyond(point.position, deepest), point);
      }
    }
  }

  static void note(PairDepth& deepest, double depth, const SampledPoint& point) {
    if (!(static_cast<float>(depth) > deepest.depth)) return;
    deepest.depth = static_cast<float>(depth);
    deepest.position = point.position;
    deepest.place = point.place;
  }
};

PenetrationMeter::PenetrationMeter(std::shared_ptr<const MuscleAsset> asset, std::shared_ptr<const BoneSolids> bones,
                                   float spacing)
    : asset_(std::move(asset)), bones_(std::move(bones)), spacing_(spacing) {
  solids_.reserve(asset_->size());
  for (std::uint32_t m = 0; m < asset_->size(); ++m) {
    const MuscleLayout& layout = asset_->muscles[m];
    Solid solid{SolidTree(resting_mesh(*asset_, m)), {}, {}, {}, empty_box()};
    solid.positions.resize(layout.vertex_count);
    solid.bands.resize(layout.row_count - 1);
    solids_.push_back(std::move(solid));
  }
}

void PenetrationMeter::move(std::uint32_t muscle, const MuscleSurfaces& surfaces, const Tendons& tendons) {
  Solid& solid = solids_[muscle];
  const MuscleLayout& layout = asset_->muscles[muscle];
  solid.usable = true;
  solid.box = empty_box();
  for (std::uint32_t v = 0; v < layout.vertex_count; ++v) {
    solid.positions[v] = surfaces.vertices[layout.first_vertex + v].position;
    solid.usable = solid.usable && is_finite(solid.positions[v]);
    solid.box.add(solid.positions[v]);
  }
  // A detached muscle is a point.
  solid.usable = solid.usable && solid.box.lower != solid.box.upper;
  if (!solid.usable) return;
  solid.tree.move(solid.positions);
  find_row_places(*asset_, tendons, muscle, solid.row_places);
  for (std::uint32_t row = 0; row + 1 < layout.row_count; ++row) {
    solid.bands[row] = empty_box();
    for (std::uint32_t i = 0; i < 2 * layout.section_vertices; ++i) {
      solid.bands[row].add(solid.positions[row * layout.section_vertices + i]);
    }
  }
}

Penetration PenetrationMeter::measure(const MuscleSurfaces& surfaces, const Tendons& tendons,
                                      std::span<const glm::mat4> bones) {
  const auto count = static_cast<std::uint32_t>(asset_->size());
  parallel::for_range(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) move(static_cast<std::uint32_t>(m), surfaces, tendons);
  });
  std::vector<glm::dmat4> to_bones(bones.size());
  std::vector<std::uint8_t> known(bones.size());
  for (std::size_t b = 0; b < bones.size(); ++b) {
    known[b] = is_usable(bones[b]) ? 1 : 0;
    if (known[b] != 0) to_bones[b] = glm::inverse(glm::dmat4(bones[b]));
  }

  std::vector<Task> tasks(count);
  const auto measure_muscle = [&](std::uint32_t m) {
    const Solid& solid = solids_[m];
    Task& task = tasks[m];
    for (const BoneSolid& bone : *bones_) {
      const auto b = static_cast<std::size_t>(bone.bone());
      if (b >= bones.size() || known[b] == 0 || !moved(solid.box, to_bones[b]).meets(bone.box())) continue;
      task.bones.push_back({&bone, to_bones[b], {.muscle = m, .bone = bone.bone()}});
    }
    for (std::uint32_t o = 0; o < count; ++o) {
      if (o == m || !solids_[o].usable || !solids_[o].box.meets(solid.box)) continue;
      task.others.push_back({&solids_[o], {.muscle = m, .other = o}});
    }
    const MuscleSurfaceView surface = surface_of(*asset_, surfaces, m);
    const MuscleLayout& layout = asset_->muscles[m];
    const float last = static_cast<float>(layout.section_count) - 1.5f;
    for (std::uint32_t row = 0; row + 1 < layout.row_count; ++row) {
      for (std::uint32_t side = 0; side < layout.section_vertices; ++side) {
        const SurfacePatch patch = patch_of(surface, solid.row_places, row, side);
        sample_patch(patch, spacing_, 0.5f, last, task.points);
        if (task.points.empty()) continue;
        task.count += static_cast<std::uint32_t>(task.points.size());
        const Box box = box_of(patch);
        task.measure_bones(box);
        task.measure_others(box);
      }
    }
  };
  parallel::for_range(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) {
      if (solids_[m].usable) measure_muscle(static_cast<std::uint32_t>(m));
    }
  });

  Penetration result;
  for (std::uint32_t m = 0; m < count; ++m) {
    result.points += tasks[m].count;
    if (!solids_[m].usable) ++result.left_out;
    for (const Task::Bone& bone : tasks[m].bones) {
      if (bone.deepest.depth > 0.0f) result.bones.push_back(bone.deepest);
    }
    for (const Task::Other& other : tasks[m].others) {
      if (other.deepest.depth > 0.0f) result.muscles.push_back(other.deepest);
    }
  }
  // A bone may have several meshes, two muscles have two surfaces: the deeper one stands for the pair.
  keep_deepest(result.bones, [](const PairDepth& p) { return std::tuple(p.muscle, p.bone); });
  keep_deepest(result.muscles, [](const PairDepth& p) {
    return std::tuple(std::min(p.muscle, p.other), std::max(p.muscle, p.other));
  });
  return result;
}

}  // namespace fascicle::muscle
