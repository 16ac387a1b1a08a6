#include "game/overlay_model.hpp"

#include <algorithm>
#include <limits>

#include "modules/muscle/muscle.hpp"

namespace fascicle::game {
namespace {

constexpr std::array<const char*, 4> kLevelNames = {"at level 0", "at level 1", "at level 2", "at coarser levels"};
constexpr float kSmoothing = 0.1f;  // weight of the newest step in a system's shown time

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
  counts_.push_back({"muscle vertices", static_cast<float>(renderer.stats().strip_vertices)});
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
  model_.value_headings = {"length mm", "vol cm3", "force N", "", "", ""};
  if (collision.any()) {
    model_.value_headings[3] = "contacts";
    model_.value_headings[4] = "deep mm";
    if (simulation.world().resource<CostLedger>().enabled()) model_.value_headings[5] = "solve us";
  }
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
  std::erase_if(costs_, [](const ItemCost& cost) { return cost.system != "solve_muscles"; });
}

void OverlayFeed::list_items(Simulation& simulation, std::size_t shown) {
  items_.clear();
  if (shown >= simulation.characters().size()) return;
  const SpawnedCharacter& character = simulation.characters()[shown];
  if (character.musculature == ecs::kNoEntity) return;
  const muscle::MuscleAsset& asset = *character.asset->muscles;
  const auto& measures = simulation.world().get<muscle::MuscleMeasures>(character.musculature);
  const auto& lines = simulation.world().get<muscle::ActionLines>(character.musculature);
  const auto* collision = simulation.world().try_get<muscle::MuscleCollision>(character.musculature);
  const std::string owner = cost_owner(character, shown);
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t m = 0; m < asset.size(); ++m) {
    const std::string& name = asset.muscles[m].name;
    const ItemState& state = item_state(name);
    OverlayItem item{name, {measures.length[m] * 1e3f, measures.volume[m] * 1e6f, measures.force[m], kNothing, kNothing,
                            kNothing}};
    item.visible = state.visible;
    item.highlighted = state.highlighted;
    item.warning = lines.held[m] != 0;
    if (collision != nullptr && m < collision->cost.size()) {
      item.values[3] = collision->cost[m];
      item.values[4] = 1e3f * collision->depth[m];
    }
    const auto cost = std::find_if(costs_.begin(), costs_.end(), [&](const ItemCost& c) {
      return c.item == name && c.owner == owner;
    });
    if (cost != costs_.end()) item.values[5] = static_cast<float>(1e3 * cost->mean_ms);
    items_.push_back(item);
  }
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
