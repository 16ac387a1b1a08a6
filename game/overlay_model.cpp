#include "game/overlay_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "modules/muscle/components/surface_hull.hpp"
#include "modules/muscle/components/surface_muscle.hpp"
#include "modules/muscle/muscle.hpp"

namespace fascicle::game {
namespace {

constexpr std::array<const char*, 4> kLevelNames = {"at level 0", "at level 1", "at level 2", "at coarser levels"};
constexpr float kSmoothing = 0.1f;  // weight of the newest step in a system's shown time
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<const char*, kOverlayValues> kColumnNames = {
    "length mm", "vol cm3", "vol %", "force N", "contacts", "deep mm", "vertices", "hull its", "solve us"};

OverlayItem make_item(std::string_view name) {
  OverlayItem item{.name = name};
  std::fill(std::begin(item.values), std::end(item.values), kNothing);
  return item;
}

}  // namespace

void OverlayFeed::record_step(const ecs::Schedule& schedule) {
  const auto timings = schedule.timings();
  smoothed_ms_.resize(timings.size(), 0.0f);
  for (std::size_t i = 0; i < timings.size(); ++i) {
    const float ms = static_cast<float>(timings[i].end_ns - timings[i].start_ns) * 1e-6f;
    smoothed_ms_[i] += (ms - smoothed_ms_[i]) * (smoothed_ms_[i] == 0.0f ? 1.0f : kSmoothing);
  }
}

const OverlayModel& OverlayFeed::build(Simulation& simulation, const Renderer& renderer, const DrawView& view,
                                       float frame_milliseconds, std::size_t shown, const CollisionStats& collision,
                                       const OverlayTask& task) {
  const FrameTime& time = simulation.loop().time();
  model_ = OverlayModel{};
  model_.title = title_;
  model_.subtitle = subtitle_;
  model_.frame_milliseconds = frame_milliseconds;
  model_.budget_milliseconds = 1000.0f / simulation.scene().step_hz;
  model_.frame = simulation.steps();
  model_.time = time.time;
  model_.paused = simulation.loop().paused();
  model_.time_scale = time.time_scale;
  model_.catch_up_steps = simulation.loop().clamped_steps();

  systems_.clear();
  const auto timings = simulation.schedule().timings();
  for (std::size_t i = 0; i < timings.size() && i < smoothed_ms_.size(); ++i) {
    systems_.push_back({timings[i].name, smoothed_ms_[i]});
  }
  gpu_.clear();
  for (const GpuTime& pass : renderer.gpu_times()) gpu_.push_back({pass.name, static_cast<float>(pass.milliseconds)});
  counts_.clear();
  counts_.push_back({"characters", static_cast<float>(simulation.characters().size())});
  counts_.push_back({"draw calls", static_cast<float>(renderer.stats().draw_calls)});
  const RenderStats& drawn = renderer.stats();
  counts_.push_back({"muscle vertices", static_cast<float>(drawn.strip_vertices + drawn.surface_vertices)});
  const Simulation::DetailCounts details = simulation.count_details();
  for (std::size_t level = 0; details.characters.size() > 1 && level < details.characters.size(); ++level) {
    counts_.push_back({kLevelNames[std::min(level, kLevelNames.size() - 1)],
                       static_cast<float>(details.characters[level])});
  }
  if (details.switches > 0) counts_.push_back({"level switches", static_cast<float>(details.switches)});
  counts_.push_back({"workers", static_cast<float>(simulation.workers().workers())});
  if (collision.any()) {
    counts_.push_back({"contacts", static_cast<float>(collision.last().contacts)});
    counts_.push_back({"pairs touching", static_cast<float>(collision.last().pairs)});
    counts_.push_back({"touches begun", static_cast<float>(collision.total().began)});
    counts_.push_back({"ended", static_cast<float>(collision.total().ended)});
    counts_.push_back({"fallbacks", static_cast<float>(collision.last().fallbacks)});
    counts_.push_back({"overflows", static_cast<float>(collision.last().overflows)});
    counts_.push_back({"deepest left, um", 1e6f * collision.last().left});
  }

  switches_.clear();
  for (const ViewSwitch& s : kViewSwitches) switches_.push_back({s.name, view.*s.field, s.shortcut});
  sliders_[0] = {"skin opacity", view.skin_opacity, 0.0f, 1.0f};

  read_costs(simulation);
  list_items(simulation, shown);
  model_.item_heading = "muscle";
  choose_columns();
  model_.task = &task;
  model_.systems = systems_;
  model_.gpu = gpu_;
  model_.counts = counts_;
  model_.switches = switches_;
  model_.sliders = sliders_;
  model_.items = items_;
  model_.errors = errors_;
  model_.warnings = warnings_;
  return model_;
}

// The ledger counts from when it was turned on (--detail); its means move slowly.
void OverlayFeed::read_costs(const Simulation& simulation) {
  constexpr int kBuildsBetween = 30;
  if (builds_++ % kBuildsBetween != 0) return;
  costs_ = simulation.world().resource<CostLedger>().statistics();
  std::erase_if(costs_, [](const ItemCost& cost) {
    return cost.system != "solve_muscles" && cost.system != "solve_surface_muscles" &&
           cost.system != "pose_surface_muscles";
  });
}

float OverlayFeed::cost_of(const std::string& owner, const std::string& item) const {
  float sum = kNothing;  // of the solvers that it has had
  for (const ItemCost& cost : costs_) {
    if (cost.item != item || cost.owner != owner) continue;
    sum = (std::isnan(sum) ? 0.0f : sum) + static_cast<float>(1e3 * cost.mean_ms);
  }
  return sum;
}

void OverlayFeed::list_items(const Simulation& simulation, std::size_t shown) {
  items_.clear();
  if (shown >= simulation.characters().size()) return;
  const SpawnedCharacter& character = simulation.characters()[shown];
  const std::string owner = cost_owner(character, shown);
  list_surfaces(simulation, character, owner);  // first: they are few
  if (character.musculature != ecs::kNoEntity) list_units(simulation, character, owner);
  for (OverlayItem& item : items_) {
    const ItemState& state = item_state(std::string(item.name));
    item.visible = state.visible;
    item.highlighted = state.highlighted;
  }
}

void OverlayFeed::list_units(const Simulation& simulation, const SpawnedCharacter& character,
                             const std::string& owner) {
  const muscle::MuscleAsset& asset = *character.asset->muscles;
  const auto& measures = simulation.world().get<muscle::MuscleMeasures>(character.musculature);
  const auto& lines = simulation.world().get<muscle::ActionLines>(character.musculature);
  const auto* collision = simulation.world().try_get<muscle::MuscleCollision>(character.musculature);
  for (std::size_t m = 0; m < asset.size(); ++m) {
    OverlayItem& item = items_.emplace_back(make_item(asset.muscles[m].name));
    item.values[kLength] = measures.length[m] * 1e3f;
    item.values[kVolume] = measures.volume[m] * 1e6f;
    item.values[kForce] = measures.force[m];
    item.warning = lines.held[m] != 0;
    if (collision != nullptr && m < collision->cost.size()) {
      item.values[kContacts] = collision->cost[m];
      item.values[kDepth] = 1e3f * collision->depth[m];
    }
    item.values[kSolve] = cost_of(owner, asset.muscles[m].name);
  }
}

// One that has fallen back to where its carriers bring it is painted amber. Its length is its fibres' mean. One that
// its coarse hull poses has the iterations that this took.
void OverlayFeed::list_surfaces(const Simulation& simulation, const SpawnedCharacter& character,
                                const std::string& owner) {
  const ecs::World& world = simulation.world();
  const auto list = [&](ecs::Entity entity, const muscle::SurfaceMuscle& surface, const muscle::SurfaceState& state) {
    if (surface.character != character.entity) return;
    OverlayItem& item = items_.emplace_back(make_item(surface.asset->name));
    item.values[kVolume] = 1e6f * static_cast<float>(state.volume);
    if (surface.asset->volume > 0.0) {
      item.values[kShare] = 100.0f * static_cast<float>(state.volume / surface.asset->volume);
    }
    item.values[kVertices] = static_cast<float>(surface.asset->vertex_count);
    const auto* hull = world.try_get<muscle::SurfaceHull>(entity);
    if (hull != nullptr && hull->solver == muscle::SurfaceSolver::kCoarseHull) {
      item.values[kHull] = static_cast<float>(hull->pose.iterations);
    }
    item.warning = state.fallbacks > 0;
    if (const auto* contacts = world.try_get<muscle::SurfaceContacts>(entity)) {
      float vertices = 0.0f, depth = 0.0f;
      for (const muscle::SurfaceContact& contact : contacts->now) {
        vertices += static_cast<float>(contact.vertices);
        depth = std::max(depth, contact.depth);
      }
      item.values[kContacts] = vertices;
      item.values[kDepth] = 1e3f * depth;
    }
    if (const auto* fibres = world.try_get<muscle::FibreBundle>(entity); fibres != nullptr && !fibres->length.empty()) {
      const float sum = std::accumulate(fibres->length.begin(), fibres->length.end(), 0.0f);
      item.values[kLength] = 1e3f * sum / static_cast<float>(fibres->length.size());
    }
    item.values[kSolve] = cost_of(fmt::format("{} {}", owner, surface.asset->name), "");
  };
  world.view<const muscle::SurfaceMuscle, const muscle::SurfaceState>().each(list);
}

// Those that some item has a value for, moved together.
void OverlayFeed::choose_columns() {
  std::size_t used = 0;
  for (std::size_t column = 0; column < kColumns; ++column) {
    const bool any = std::any_of(items_.begin(), items_.end(),
                                 [&](const OverlayItem& item) { return !std::isnan(item.values[column]); });
    if (!any) continue;
    model_.value_headings[used] = kColumnNames[column];
    for (OverlayItem& item : items_) item.values[used] = item.values[column];
    ++used;
  }
}

std::string OverlayFeed::item_name(std::size_t index) const {
  return index < items_.size() ? std::string(items_[index].name) : std::string();
}

void OverlayFeed::set_messages(const Diagnostics& diagnostics) {
  clear_messages();
  for (const Diagnostic& error : diagnostics.errors) errors_.push_back(to_string(error));
  for (const Diagnostic& warning : diagnostics.warnings) warnings_.push_back(to_string(warning));
}

void OverlayFeed::clear_messages() {
  errors_.clear();
  warnings_.clear();
}

}  // namespace fascicle::game
