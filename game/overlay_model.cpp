#include "game/overlay_model.hpp"

#include <algorithm>

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
                                       float frame_milliseconds, std::size_t shown) {
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

  switches_.clear();
  for (const ViewSwitch& s : kViewSwitches) switches_.push_back({s.name, view.*s.field, s.shortcut});
  sliders_[0] = {"skin opacity", view.skin_opacity, 0.0f, 1.0f};

  items_.clear();
  if (shown < simulation.characters().size()) {
    const SpawnedCharacter& character = simulation.characters()[shown];
    if (character.musculature != ecs::kNoEntity) {
      const muscle::MuscleAsset& asset = *character.asset->muscles;
      const auto& measures = simulation.world().get<muscle::MuscleMeasures>(character.musculature);
      const auto& lines = simulation.world().get<muscle::ActionLines>(character.musculature);
      for (std::size_t m = 0; m < asset.size(); ++m) {
        const ItemState& state = item_state(asset.muscles[m].name);
        items_.push_back({asset.muscles[m].name,
                          {measures.length[m] * 1e3f, measures.volume[m] * 1e6f, measures.force[m]},
                          state.visible,
                          state.highlighted,
                          lines.held[m] != 0});
      }
    }
  }
  model_.item_heading = "muscle";
  model_.value_headings[0] = "length mm";
  model_.value_headings[1] = "volume cm3";
  model_.value_headings[2] = "max force N";
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
