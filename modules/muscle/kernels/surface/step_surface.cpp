#include "modules/muscle/kernels/surface/step_surface.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace fascicle::muscle {
namespace {

constexpr float kLeastReach = 0.003f;     // m beyond the contact distance that a vertex may come nearer to a bone in a step
constexpr float kReachPerSpeed = 2.0f;    // of what the fastest vertex moved in the last step
constexpr std::size_t kCarriedSample = 16;  // of so many vertices one is asked how far it is carried
constexpr double kLeastVolume = 0.1, kMostVolume = 2.0;  // of that at rest
constexpr float kFurthest = 4.0f;         // of the muscle's size at rest, between two vertices: more has diverged

glm::vec3 place(const SurfacePoint& p) { return {p.x, p.y, p.z}; }

void set(SurfacePoint& p, const glm::vec3& at) {
  p.x = at.x;
  p.y = at.y;
  p.z = at.z;
}

glm::dvec3 apply(const glm::dmat4& m, const glm::dvec3& p) { return glm::dvec3(m * glm::dvec4(p, 1.0)); }

// The rows that the kernels want.
void set_rows(const glm::dmat4& moved, float* rows) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) rows[4 * row + column] = static_cast<float>(moved[column][row]);
  }
}

// Of a part of a motion, less the identity; exactly zero for what does not move.
void set_moved(const RigidMotion& motion, double begin, double end, float* rows) {
  if (motion.from == motion.to) return set_rows(glm::dmat4(0.0), rows);
  set_rows(part_of(motion, end) * glm::inverse(part_of(motion, begin)) - glm::dmat4(1.0), rows);
}

void attach(const SurfaceStep& step, SurfaceScratch& scratch, double fraction) {
  for (std::size_t i = 0; i < step.attachments.size(); ++i) {
    scratch.attached[i] = glm::mat4(part_of(step.attachments[i], fraction));
  }
  const SurfaceAsset& asset = *step.asset;
  for (const AttachedVertex& attached : asset.attached) {
    const RigidMotion& motion = step.attachments[attached.attachment];
    if (motion.from == motion.to) continue;  // it stands there already
    const glm::vec3 rest = place(asset.rest[attached.vertex]);
    set(step.points[attached.vertex], glm::vec3(scratch.attached[attached.attachment] * glm::vec4(rest, 1.0f)));
  }
}

void place_bones(const SurfaceStep& step, SurfaceScratch& scratch, double begin, double end) {
  for (std::size_t b = 0; b < step.bones.size(); ++b) {
    SurfaceBone& bone = scratch.bones[b];
    bone.field = step.fields[b];
    if (bone.field == nullptr) continue;
    const glm::dmat4 to_rest_bone(step.rest_to_bone[b]);
    const glm::dmat4 now = to_rest_bone * glm::inverse(part_of(step.bones[b], end));
    bone.to_bone = glm::mat4(now);
    bone.from_bone = glm::mat4(glm::inverse(now));
    bone.to_bone_before = glm::mat4(to_rest_bone * glm::inverse(part_of(step.bones[b], begin)));
  }
}

float speed_of_fastest(const SurfaceStep& step) {
  float fastest = 0.0f;
  for (const SurfacePoint& v : step.velocity) fastest = std::max(fastest, v.x * v.x + v.y * v.y + v.z * v.z);
  return std::sqrt(fastest);
}

// How far a vertex and a bone may come together within the step: by what the fastest vertex does, and by how far the bone
// moves where the muscle is.
float reach_of(const SurfaceStep& step, const RigidMotion& motion, const VertexBall& ball, float fastest) {
  float carried = 0.0f;
  const glm::mat4 moved = motion.to * glm::inverse(motion.from);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 side(corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f);
    const glm::vec3 at = ball.centre + ball.radius * side;
    carried = std::max(carried, glm::distance(at, glm::vec3(moved * glm::vec4(at, 1.0f))));
  }
  return step.settings.contact_distance + kLeastReach + kReachPerSpeed * fastest * step.step + carried;
}

bool is_far(const SurfaceBone& bone, const VertexBall& ball, float reach) {
  const glm::vec3 centre(bone.to_bone * glm::vec4(ball.centre, 1.0f));
  const glm::vec3 nearest = glm::clamp(centre, bone.field->lower(), bone.field->upper());
  return glm::distance(centre, nearest) > ball.radius + reach;
}

void find_near(const SurfaceStep& step, float fastest, SurfaceScratch& scratch) {
  const std::span<const SurfacePoint> vertices = step.points.first(step.asset->vertex_count);
  for (std::size_t i = 0; i < scratch.balls.size(); ++i) {
    const std::size_t first = i * kBallVertices;
    scratch.balls[i] = ball_about(vertices.subspan(first, std::min(kBallVertices, vertices.size() - first)));
  }
  const VertexBall ball = ball_about(vertices);  // most bones of a character are nowhere near it
  place_bones(step, scratch, 0.0, 0.0);
  for (std::size_t b = 0; b < step.bones.size(); ++b) {
    scratch.touches[b] = {};
    const std::size_t first = scratch.first_near[b];
    std::size_t count = 0;
    if (step.fields[b] != nullptr && step.settings.collide_with_bones) {
      const float reach = reach_of(step, step.bones[b], ball, fastest);
      if (!is_far(scratch.bones[b], ball, reach)) {
        count = find_near_bone(scratch.bones[b], scratch.balls, vertices, reach,
                               std::span(scratch.near).subspan(first));
      }
    }
    scratch.first_near[b + 1] = first + count;
  }
}

// Where the carriers bring the rest shape; exactly the rest shape where they stand at rest.
void place_carried(const SurfaceStep& step, SurfaceScratch& scratch, std::span<SurfacePoint> points) {
  for (std::size_t c = 0; c < step.carriers.size(); ++c) {
    set_rows(glm::dmat4(step.carriers[c].to) - glm::dmat4(1.0), &scratch.moved[12 * c]);
  }
  step.kernels->carry({.carry = step.asset->carry, .moved = scratch.moved, .vertex_count = step.asset->vertex_count,
                       .rest = step.asset->rest, .out = points});
}

// m: how far the carriers move any vertex in this step; of some vertices, for all are carried like their neighbours.
float furthest_carried(const SurfaceStep& step) {
  const SurfaceAsset& asset = *step.asset;
  float furthest = 0.0f;
  for (std::size_t v = 0; v < asset.carry.size(); v += kCarriedSample) {
    const glm::vec4 rest(place(asset.rest[v]), 1.0f);
    glm::vec3 moved(0.0f);
    for (std::size_t i = 0; i < 4; ++i) {
      const float weight = asset.carry[v].weight[i];
      const RigidMotion& motion = step.carriers[asset.carry[v].carrier[i]];
      if (weight > 0.0f && motion.from != motion.to) moved += weight * glm::vec3(motion.to * rest - motion.from * rest);
    }
    furthest = std::max(furthest, glm::length(moved));
  }
  return furthest;
}

bool touches_itself(const SurfaceStep& step) {
  return step.settings.collide_with_itself && step.asset->tree != nullptr;
}

PairsJob pairs_with_itself(const SurfaceStep& step, const SurfaceScratch& scratch) {
  PairsJob job;
  job.first = {.asset = step.asset, .tree = step.asset->tree.get(), .boxes = &scratch.boxes, .points = step.points,
               .clearance = {}};
  job.contact_distance = step.settings.contact_distance;
  return job;
}

// Also where a game has switched it on since the muscle was laid out.
void make_room_for_itself(const SurfaceAsset& asset, SurfaceScratch& scratch) {
  if (!scratch.boxes.normal_ranges.empty() || asset.tree == nullptr) return;
  lay_out_boxes(*asset.tree, asset, true, scratch.boxes);
  lay_out_pairs(usual_pair_capacity(asset.vertex_count), scratch.itself);
}

PredictJob predict_job(const SurfaceStep& step, SurfaceScratch& scratch) {
  const float h = step.step / static_cast<float>(step.settings.substeps);
  return {.carry = step.asset->carry, .moved = scratch.moved, .vertex_count = step.asset->vertex_count,
          .points = step.points, .before = scratch.before, .velocity = step.velocity, .h = h,
          .keep = std::exp(-step.settings.damping * h), .anchors = scratch.anchors, .pull = scratch.pull};
}

float pull_of(const SurfaceStep& step, float inverse_h2) {
  const float compliance = step.settings.anchor_compliance;
  if (!(compliance > 0.0f) || step.asset->carry.empty()) return 0.0f;
  float inverse_mass = 0.0f;
  for (const SurfacePoint& p : step.asset->rest) inverse_mass = std::max(inverse_mass, p.inverse_mass);
  return inverse_mass / (inverse_mass + compliance * inverse_h2);
}

}  // namespace

glm::dmat4 part_of(const RigidMotion& motion, double fraction) {
  if (fraction >= 1.0 || motion.from == motion.to) return glm::dmat4(motion.to);
  if (fraction <= 0.0) return glm::dmat4(motion.from);
  const glm::dmat3 from(motion.from), to(motion.to);
  const glm::dquat turn = glm::normalize(glm::quat_cast(to * glm::inverse(from)));
  glm::dmat4 result(glm::mat3_cast(glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), turn, fraction)) * from);
  result[3] = glm::mix(glm::dvec4(motion.from[3]), glm::dvec4(motion.to[3]), fraction);
  return result;
}

void lay_out(const SurfaceAsset& asset, SurfaceScratch& scratch) {
  scratch.before.assign(asset.vertex_count, SurfacePoint{});
  scratch.gradient.assign(asset.vertex_count, SurfacePoint{});
  scratch.anchors.assign(asset.vertex_count, SurfacePoint{});
  scratch.near.assign(asset.vertex_count * asset.bones.size(), 0);
  scratch.first_near.assign(asset.bones.size() + 1, 0);
  scratch.balls.assign((asset.vertex_count + kBallVertices - 1) / kBallVertices, VertexBall{});
  scratch.attached.assign(asset.attachments.size(), glm::mat4(1.0f));
  scratch.moved.assign(12 * asset.carriers.size(), 0.0f);
  scratch.touches.assign(asset.bones.size(), BoneTouch{});
  scratch.bones.assign(asset.bones.size(), SurfaceBone{});
  if (asset.settings.collide_with_itself) make_room_for_itself(asset, scratch);
}

void begin_step(const SurfaceStep& step, SurfaceScratch& scratch) {
  const float h = step.step / static_cast<float>(step.settings.substeps);
  scratch.pull = pull_of(step, 1.0f / (h * h));
  scratch.six_volumes = step.asset->kernel_volume;
  if (scratch.pull > 0.0f) place_carried(step, scratch, scratch.anchors);
  const float fastest = speed_of_fastest(step);
  find_near(step, fastest, scratch);
  scratch.nearer = fastest * step.step + furthest_carried(step);
  scratch.boxes.placed = false;
  if (!touches_itself(step)) return;
  make_room_for_itself(*step.asset, scratch);
  keep_pairs(pairs_with_itself(step, scratch), scratch.nearer, scratch.boxes, nullptr, scratch.itself);
}

void move_and_constrain(const SurfaceStep& step, std::uint32_t substep, SurfaceScratch& scratch) {
  const SurfaceAsset& asset = *step.asset;
  const SurfaceSettings& settings = step.settings;
  const float h = step.step / static_cast<float>(settings.substeps);
  const float inverse_h2 = 1.0f / (h * h);
  const double begin = static_cast<double>(substep) / settings.substeps;
  const double end = static_cast<double>(substep + 1) / settings.substeps;
  for (std::size_t c = 0; c < step.carriers.size(); ++c) {
    set_moved(step.carriers[c], begin, end, &scratch.moved[12 * c]);
  }
  step.kernels->predict(predict_job(step, scratch));
  attach(step, scratch, end);
  step.kernels->project_hinges({.packs = asset.packs, .points = step.points, .inverse_h2 = inverse_h2});
  scratch.six_volumes = step.kernels->project_volume(
      {.triangles = asset.triangles, .vertex_count = asset.vertex_count, .points = step.points,
       .gradient = scratch.gradient, .rest = asset.kernel_volume,
       .compliance = 36.0f * settings.volume_compliance * inverse_h2, .rings = &asset.rings});
  if (touches_itself(step)) project_pairs(pairs_with_itself(step, scratch), scratch.itself);
}

void finish_substep(const SurfaceStep& step, std::uint32_t substep, SurfaceScratch& scratch) {
  const SurfaceSettings& settings = step.settings;
  place_bones(step, scratch, static_cast<double>(substep) / settings.substeps,
              static_cast<double>(substep + 1) / settings.substeps);
  for (std::size_t b = 0; b < step.bones.size(); ++b) {
    const auto near = std::span(scratch.near).subspan(scratch.first_near[b],
                                                      scratch.first_near[b + 1] - scratch.first_near[b]);
    if (near.empty()) continue;
    push_from_bone(scratch.bones[b], near, scratch.before, settings.contact_distance, settings.friction, step.points,
                   scratch.touches[b]);
  }
  step.kernels->take_velocities(predict_job(step, scratch));
}

double end_step(const SurfaceStep& step, SurfaceScratch& scratch) {
  const SurfaceSettings& settings = step.settings;
  // Once a step: what rings does so for longer than that.
  if (settings.viscosity > 0.0f) {
    step.kernels->fade_differences({.packs = step.asset->packs, .points = step.points, .velocity = step.velocity,
                                    .share = 1.0f - std::exp(-settings.viscosity * step.step)});
  }
  return scratch.six_volumes / 6.0;
}

double step_surface(const SurfaceStep& step, SurfaceScratch& scratch) {
  begin_step(step, scratch);
  for (std::uint32_t substep = 0; substep < step.settings.substeps; ++substep) {
    move_and_constrain(step, substep, scratch);
    finish_substep(step, substep, scratch);
  }
  return end_step(step, scratch);
}

double carry_rest_shape(const SurfaceStep& step, SurfaceScratch& scratch) {
  place_carried(step, scratch, step.points);
  forget_pairs(scratch.itself);
  ++scratch.restarts;
  for (const AttachedVertex& attached : step.asset->attached) {
    const glm::mat4& to = step.attachments[attached.attachment].to;
    const glm::dvec3 rest(place(step.asset->rest[attached.vertex]));
    set(step.points[attached.vertex], glm::vec3(apply(glm::dmat4(to), rest)));
  }
  std::fill(step.velocity.begin(), step.velocity.end(), SurfacePoint{});
  return step.kernels->measure_volume({.triangles = step.asset->triangles, .vertex_count = step.asset->vertex_count,
                                       .points = step.points, .gradient = scratch.gradient,
                                       .rings = &step.asset->rings}) / 6.0;
}

bool is_sound(const SurfaceAsset& asset, std::span<const SurfacePoint> points, double volume) {
  if (!(volume > kLeastVolume * asset.volume && volume < kMostVolume * asset.volume)) return false;
  const glm::vec3 first = place(points[0]);
  for (std::uint32_t v = 0; v < asset.vertex_count; ++v) {
    if (!(glm::distance(place(points[v]), first) <= kFurthest * asset.size)) return false;
  }
  return std::isfinite(first.x + first.y + first.z);
}

}  // namespace fascicle::muscle
