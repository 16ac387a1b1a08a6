// Collision on one thread, over a moving gait cycle with the character's own settings:
//
//   collision_step/SCENE/LEVEL/N       a step of all muscle systems for N characters, each at its place of the cycle
//   collision_step_without/…           the same with collision off
//   collision_solve/…                  the part of it that the collision systems take
//   collision_detect/SCENE/LEVEL       finding the contacts of one character
//   collision_detect_reference/…       the same contacts without grid, boxes and fields: every sample against every
//                                      bone's nearest triangle and winding number, and every other muscle's outline
//
// LEVEL: C8 is |C| = 8, LSS 1; content is what the character's file says. The bones are posed beforehand. Times are the
// processor's. Counters, of one character: us_median of all steps, contacts in the last one, KiB of its
// components, and KiB of the CollisionAsset that all share. gait2392 needs the real data and is skipped without.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/animation/clip.hpp"
#include "engine/animation/joint_model.hpp"
#include "engine/animation/motion.hpp"
#include "engine/animation/skeleton.hpp"
#include "engine/ecs/schedule.hpp"
#include "engine/ecs/world.hpp"
#include "engine/geometry/closest_point.hpp"
#include "engine/geometry/winding_number.hpp"
#include "engine/loop/frame_time.hpp"
#include "modules/muscle/asset/collision/collision_asset.hpp"
#include "modules/muscle/components/collision_scratch.hpp"
#include "modules/muscle/components/muscle_collision.hpp"
#include "modules/muscle/content/find_content.hpp"
#include "modules/muscle/content/scene_asset.hpp"
#include "modules/muscle/kernels/collision/contact_rows.hpp"
#include "modules/muscle/kernels/collision/section_outline.hpp"
#include "modules/muscle/kernels/collision/solve_collision.hpp"
#include "modules/muscle/muscle.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

constexpr float kSpacing = 1.4f;        // m between characters
constexpr std::size_t kColumns = 16;
constexpr std::size_t kWarmSteps = 12;  // from the rest pose into the walk
constexpr std::size_t kSnapshots = 8;   // of the cycle, to find contacts in
constexpr float kReach = 0.0025f;       // m: contacts are found this far ahead

using Pose = std::vector<glm::mat4>;

struct Content {
  std::shared_ptr<const SceneAsset> scene;  // null: not to be had
  std::shared_ptr<const CharacterAsset> character;
  std::vector<Pose> poses;                  // a step apart, a whole cycle
};

std::vector<Pose> make_poses(const SceneAsset& scene) {
  const SceneCharacter& placed = scene.characters.front();
  const CharacterAsset& character = *placed.character;
  const AnimationChoice& animation = placed.animation;
  const double length = animation.clip     ? static_cast<double>(animation.clip->duration())
                        : animation.motion ? animation.motion->cycle.length()
                                           : 1.0;
  const auto count = static_cast<std::size_t>(std::max(length * static_cast<double>(scene.step_hz), 1.0));
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = length * static_cast<double>(i) / static_cast<double>(count);
    std::vector<Trs> local = character.skeleton->rest_local;
    if (animation.clip) sample_clip(*animation.clip, animation.clip->start + static_cast<float>(time), local);
    if (animation.motion) {
      std::vector<double> values = default_coordinates(*character.joints);
      sample_cycle(*animation.motion, time, true, values);
      pose_joints(*character.joints, values, local);
    }
    poses.emplace_back(local.size());
    compose(*character.skeleton, local, glm::mat4(1.0f), poses.back());
  }
  return poses;
}

// Loaded once.
const Content& find_content(const std::string& name, bool coarse) {
  static std::map<std::pair<std::string, bool>, Content> contents;
  const auto [found, added] = contents.try_emplace({name, coarse});
  Content& content = found->second;
  if (!added) return content;
  LoadOptions options;
  if (coarse) {
    options.section_vertices = 8;
    options.longitudinal_subdivision = 1;
  }
  const auto scene = load_scene(find_scene(name, find_content_folder()), options);
  if (!scene || (*scene)->characters.empty() || !(*scene)->characters.front().character->levels) return content;
  content.scene = *scene;
  content.character = content.scene->characters.front().character;
  content.poses = make_poses(*content.scene);
  return content;
}

// Characters in a world of their own, stepped on one thread.
class Crowd {
 public:
  Crowd(const Content& content, std::size_t count, bool collision) : content_(content), arena_(1) {
    world_.set_resource(FrameTime{.step = 1.0f / content.scene->step_hz});
    prepare_muscles(world_);
    add_muscle_systems(schedule_);
    const CharacterAsset& character = *content.character;
    CollisionSettings settings = character.collision.settings;
    settings.enabled = settings.enabled && collision;
    for (std::size_t i = 0; i < count; ++i) {
      characters_.push_back(world_.create());
      world_.add(characters_.back(), BoneMatrices{character.skeleton->rest_world, 0});
      musculatures_.push_back(spawn_musculature(world_, characters_.back(), character.levels));
      add_collision(world_, musculatures_.back(), character.collision_levels, settings);
    }
    for (std::size_t i = 0; i < kWarmSteps; ++i) step();
  }

  void step() {
    for (std::size_t i = 0; i < characters_.size(); ++i) {
      const glm::vec4 place(kSpacing * static_cast<float>(i % kColumns), 0.0f,
                            -kSpacing * static_cast<float>(i / kColumns), 0.0f);
      Pose& bones = world_.get<BoneMatrices>(characters_[i]).world;
      const Pose& pose = content_.poses[(step_ + 7 * i) % content_.poses.size()];
      for (std::size_t b = 0; b < bones.size(); ++b) {
        bones[b] = pose[b];
        bones[b][3] += place;
      }
    }
    const std::clock_t start = std::clock();
    schedule_.run(world_, arena_);
    took_ = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    ++step_;
  }

  double took() const { return took_; }  // s of the processor: the last step, without its poses
  // The collision systems' part of it.
  double solve_took() const {
    std::int64_t all = 1, collision = 0;  // ns
    for (const ecs::SystemTiming& timing : schedule_.timings()) {
      const bool collides = timing.name.starts_with("solve") || timing.name.starts_with("collide");
      all += timing.end_ns - timing.start_ns;
      collision += collides ? timing.end_ns - timing.start_ns : 0;
    }
    return took_ * static_cast<double>(collision) / static_cast<double>(all);
  }

  const CharacterAsset& character() const { return *content_.character; }
  const CollisionAsset& asset() const { return *character().collision_levels.front(); }
  const Pose& bones() const { return world_.get<BoneMatrices>(characters_.front()).world; }
  const MuscleCollision& collision() const { return world_.get<MuscleCollision>(musculatures_.front()); }
  const MuscleContacts& contacts() const { return world_.get<MuscleContacts>(musculatures_.front()); }
  // The scratch of the only thread, as the last step left it.
  CollisionWork copy_work() const {
    const CollisionScratch::Loan loan(world_.resource<CollisionScratch>());
    CollisionWork work = *loan;
    work.contacts.clear();
    work.contacts.reserve((*loan).contacts.capacity());  // copies have no more than they hold
    return work;
  }

 private:
  const Content& content_;
  ecs::World world_;
  ecs::Schedule schedule_;
  parallel::WorkerArena arena_;
  std::vector<ecs::Entity> characters_, musculatures_;
  std::size_t step_ = 0;
  double took_ = 0.0;
};

double median(std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double kib(std::size_t bytes) { return static_cast<double>(bytes) / 1024.0; }

enum class Part { kStep, kSolve, kWithout };

void step_crowd(benchmark::State& state, const std::string& name, bool coarse, std::size_t count, Part part) {
  const Content& content = find_content(name, coarse);
  if (!content.scene) return state.SkipWithError("its content or the real data is not there");
  Crowd crowd(content, count, part != Part::kWithout);
  std::vector<double> times;  // us, of one character
  for (auto _ : state) {
    crowd.step();
    const double seconds = part == Part::kSolve ? crowd.solve_took() : crowd.took();
    state.SetIterationTime(seconds);
    times.push_back(1e6 * seconds / static_cast<double>(count));
  }
  state.counters["us_median"] = median(times);
  if (part == Part::kWithout) return;
  std::size_t shared = 0;
  for (const auto& level : content.character->collision_levels) shared += heap_bytes(*level);
  state.counters["contacts"] = crowd.collision().contact_count;
  state.counters["KiB_state"] = kib(heap_bytes(crowd.collision()));
  state.counters["KiB_contacts"] = kib(heap_bytes(crowd.contacts()));
  state.counters["KiB_shared"] = kib(shared);
}

// What a bone's field stands for.
struct ReferenceBone {
  ClosestPoints nearest;
  WindingField winding;

  float distance(const glm::vec3& point) const {
    const float distance = nearest.at(point).distance;
    return winding.inside(glm::dvec3(point)) ? -distance : distance;
  }
};

// By place in CollisionAsset::bones.
std::vector<ReferenceBone> make_reference_bones(const CharacterAsset& character, const CollisionAsset& asset) {
  std::vector<ReferenceBone> bones;
  for (const std::int32_t bone : asset.bones) {
    TriangleMesh all;
    for (const BoneMesh& part : character.bone_meshes) {
      if (part.bone != bone) continue;
      const auto first = static_cast<std::uint32_t>(all.positions.size());
      for (const glm::vec3& p : part.mesh->positions) all.positions.emplace_back(part.transform * glm::vec4(p, 1.0f));
      for (const std::uint32_t index : part.mesh->indices) all.indices.push_back(first + index);
    }
    bones.push_back({ClosestPoints(all), WindingField(all)});
  }
  return bones;
}

float allowed_depth(const CollisionAsset& asset, std::uint32_t row, std::uint32_t sample, std::uint32_t other) {
  for (std::uint32_t o = asset.first_overlap[row]; o < asset.first_overlap[row + 1]; ++o) {
    if (asset.overlaps[o].other == other) return asset.rest_depths[asset.overlaps[o].first_depth + sample];
  }
  return 0.0f;
}

std::size_t detect_in_bones(const CollisionAsset& asset, const std::vector<ReferenceBone>& references,
                            const Pose& bones, std::uint32_t row, std::uint32_t sample, const glm::vec3& p,
                            float margin) {
  std::size_t found = 0;
  for (std::size_t place = 0; place < asset.bones.size(); ++place) {
    const std::size_t cell = row * asset.bones.size() + place;
    if (asset.row_touches_bone[cell] == 0) continue;
    const std::uint32_t depths = asset.row_bone_depths[cell];
    const float allowed = depths == kNoDepths ? 0.0f : asset.rest_depths[depths + sample];
    const glm::mat4& bone = bones[static_cast<std::size_t>(asset.bones[place])];
    const glm::vec3 local = (p - glm::vec3(bone[3])) * glm::mat3(bone);
    found += references[place].distance(local) + allowed - margin <= kReach ? 1 : 0;
  }
  return found;
}

std::size_t detect_in_muscles(const CollisionAsset& asset, const CollisionWork& work, std::uint32_t muscle,
                              std::uint32_t row, std::uint32_t sample, const glm::vec3& p, float margin) {
  std::size_t found = 0;
  const auto muscles = static_cast<std::uint32_t>(asset.first_section.size() - 1);
  for (std::uint32_t other = 0; other < muscles; ++other) {
    if (other == muscle || asset.muscles_touch[muscle * muscles + other] == 0) continue;
    for (std::uint32_t s = asset.first_section[other]; s + 1 < asset.first_section[other + 1]; ++s) {
      const float before = glm::dot(p - work.a[s], work.t[s]), behind = glm::dot(p - work.a[s + 1], work.t[s + 1]);
      if (before < 0.0f || behind >= 0.0f) continue;
      OutlineSegment outline;
      outline.count = asset.sections[s].count;
      for (std::uint32_t k = 0; k < 2; ++k) {
        const std::uint32_t first = asset.sections[s + k].first_radius;
        outline.x[k] = &work.vertex_x[first];
        outline.y[k] = &work.vertex_y[first];
        outline.z[k] = &work.vertex_z[first];
        outline.u[k] = work.u[s + k];
        outline.v[k] = work.v[s + k];
      }
      OutlinePoint point;
      const glm::vec3 outward = sample_normal(asset, work, row, sample);
      if (!find_outline_point(outline, before / (before - behind), p, outward, margin + kReach, point)) continue;
      found += point.distance + allowed_depth(asset, row, sample, other) - margin <= kReach ? 1 : 0;
    }
  }
  return found;
}

// The contacts of samples; those of centres are few, and find_contacts' alone.
std::size_t detect_by_force(const CollisionAsset& asset, const CollisionSettings& settings,
                            const std::vector<ReferenceBone>& references, const Pose& bones,
                            const CollisionWork& work) {
  std::size_t found = 0;
  for (std::uint32_t m = 0; m + 1 < asset.first_row.size(); ++m) {
    for (std::uint32_t r = asset.first_row[m]; r < asset.first_row[m + 1]; ++r) {
      for (std::uint32_t i = 0; i < asset.rows[r].sample_count; ++i) {
        const std::uint32_t s = asset.rows[r].first_sample + i;
        const glm::vec3 p(work.sample_x[s], work.sample_y[s], work.sample_z[s]);
        found += detect_in_bones(asset, references, bones, r, i, p, settings.bone_margin);
        found += detect_in_muscles(asset, work, m, r, i, p, settings.muscle_margin);
      }
    }
  }
  return found;
}

void detect(benchmark::State& state, const std::string& name, bool coarse, bool reference) {
  const Content& content = find_content(name, coarse);
  if (!content.scene) return state.SkipWithError("its content or the real data is not there");
  Crowd crowd(content, 1, true);
  struct Moment {
    CollisionWork work;
    Pose bones;
  };
  std::vector<Moment> moments;
  for (std::size_t i = 0; i < kSnapshots; ++i) {
    for (std::size_t k = 0; k < content.poses.size() / kSnapshots; ++k) crowd.step();
    moments.push_back({crowd.copy_work(), crowd.bones()});
  }
  const CollisionAsset& asset = crowd.asset();
  const CollisionSettings& settings = crowd.collision().settings;
  const std::vector<ReferenceBone> references =
      reference ? make_reference_bones(*content.character, asset) : std::vector<ReferenceBone>();
  for (Moment& moment : moments) find_contacts(asset, settings, moment.bones, moment.work);  // places all samples
  std::size_t iteration = 0;
  double contacts = 0.0;
  for (auto _ : state) {
    Moment& moment = moments[iteration++ % kSnapshots];
    if (reference) {
      contacts += static_cast<double>(detect_by_force(asset, settings, references, moment.bones, moment.work));
      continue;
    }
    find_contacts(asset, settings, moment.bones, moment.work);
    contacts += static_cast<double>(std::count_if(moment.work.contacts.begin(), moment.work.contacts.end(),
                                                  [](const Contact& contact) { return contact.row != kCentreRow; }));
  }
  state.counters["contacts"] = contacts / static_cast<double>(iteration);
  state.counters["samples"] = static_cast<double>(asset.samples.size());
}

[[maybe_unused]] const bool kRegistered = [] {
  for (const char* scene : {"walker", "gait2392"}) {
    for (const bool coarse : {true, false}) {
      const std::string what = std::string("/") + scene + (coarse ? "/C8" : "/content");
      for (const std::size_t count : {1, 4, 16, 64, 256}) {
        if (count > 1 && std::string_view(scene) != "walker") continue;
        const std::pair<Part, const char*> parts[] = {{Part::kStep, "collision_step"},
                                                      {Part::kSolve, "collision_solve"},
                                                      {Part::kWithout, "collision_step_without"}};
        for (const auto& [part, title] : parts) {
          if (part == Part::kSolve && count > 1) continue;
          benchmark::RegisterBenchmark((title + what + "/" + std::to_string(count)).c_str(), step_crowd,
                                       std::string(scene), coarse, count, part)
              ->UseManualTime()
              ->Unit(benchmark::kMillisecond);
        }
      }
      for (const bool reference : {false, true}) {
        const std::string title = reference ? "collision_detect_reference" : "collision_detect";
        auto* added =
            benchmark::RegisterBenchmark((title + what).c_str(), detect, std::string(scene), coarse, reference)
                ->Unit(benchmark::kMillisecond);
        if (reference) added->Iterations(kSnapshots);
        else added->MinTime(0.5);
      }
    }
  }
  return true;
}();

}  // namespace
