#include "engine/ecs/schedule.hpp"

#include <algorithm>
#include <cassert>

#include "engine/ecs/monotonic_clock.hpp"
#include "engine/ecs/schedule_frame.hpp"
#include "engine/parallel/task_set.hpp"

namespace fascicle::ecs {


Schedule::Schedule() : frame_(std::make_unique<Frame>()) {}
Schedule::~Schedule() = default;
Schedule::Schedule(Schedule&&) noexcept = default;
Schedule& Schedule::operator=(Schedule&&) noexcept = default;

void Schedule::add_barrier() { frame_->stage_open = false; }

SystemId Schedule::add_system(std::string name, Access access, std::unique_ptr<System> system) {
  std::vector<std::unique_ptr<Node>>& nodes = frame_->nodes;
  if (!frame_->stage_open) frame_->stages.emplace_back();
  frame_->stage_open = true;
  Stage& stage = frame_->stages.back();

  const std::size_t id = nodes.size();
  auto node = std::make_unique<Node>();
  node->name = std::move(name);
  node->access = std::move(access);
  node->system = std::move(system);
  node->stage = static_cast<int>(frame_->stages.size()) - 1;
  if (node->access.commands()) node->commands = std::make_unique<Commands>(static_cast<std::uint32_t>(id));

  // Latest first: a conflict with a system that one already found waits for adds nothing.
  node->comes_after.assign(id, false);
  for (auto earlier = stage.systems.rbegin(); earlier != stage.systems.rend(); ++earlier) {
    if (node->comes_after[*earlier]) continue;
    std::vector<std::string_view> types = find_conflicts(nodes[*earlier]->access, node->access);
    if (types.empty()) continue;
    node->comes_after[*earlier] = true;
    for (std::size_t i = 0; i < *earlier; ++i) {
      if (nodes[*earlier]->comes_after[i]) node->comes_after[i] = true;
    }
    node->waits_for.insert(node->waits_for.begin(), {*earlier, std::move(types)});
    nodes[*earlier]->successors.push_back(id);
  }
  stage.systems.push_back(id);
  if (node->waits_for.empty()) stage.roots.push_back(id);
  if (node->commands) stage.commands.push_back(id);
  nodes.push_back(std::move(node));

  frame_->timings.clear();
  for (const std::unique_ptr<Node>& each : nodes) frame_->timings.push_back({each->name, 0, 0, 0, each->stage});
  for (std::size_t i = 0; i < frame_->stages.size(); ++i) {
    if (!frame_->stages[i].commands.empty()) {
      frame_->timings.push_back({"apply commands", 0, 0, 0, static_cast<int>(i)});
    }
  }
  return {static_cast<std::uint32_t>(id)};
}

// Runs the systems of a frame; lives on the caller's stack for one run.
class ScheduleRun {
 public:
  ScheduleRun(Schedule::Frame& frame, World& world, int workers)
      : frame_(frame), world_(world), workers_(workers), barrier_row_(frame.nodes.size()) {}

  void run() {
    for (std::size_t i = 0; i < frame_.stages.size(); ++i) {
      const Stage& stage = frame_.stages[i];
      prepare(stage);
      world_.lock_structure(true);
      if (workers_ == 1 || stage.systems.size() == 1) {
        run_in_order(stage);
      } else {
        run_in_parallel(stage);
      }
      world_.lock_structure(false);
      if (const std::exception_ptr failure = end_of(stage)) {
        leave_out_after(i);
        std::rethrow_exception(failure);
      }
      apply_commands(stage);
    }
  }

 private:
  using Node = Schedule::Node;

  void prepare(const Stage& stage) {
    for (const std::size_t id : stage.systems) {
      Node::State& state = frame_.nodes[id]->state;
      state.pending.store(static_cast<int>(frame_.nodes[id]->waits_for.size()), std::memory_order_relaxed);
      state.left_out.store(false, std::memory_order_relaxed);
    }
  }

  // Runs one system unless one it waits for failed; returns the time at its end.
  std::int64_t run_system(std::size_t id, std::int64_t start_ns, int worker) {
    Node& node = *frame_.nodes[id];
    SystemTiming& timing = frame_.timings[id];
    timing.start_ns = timing.end_ns = start_ns;
    timing.worker = worker;
    bool failed = node.state.left_out.load(std::memory_order_relaxed);
    if (!failed) {
      try {
        SystemContext context{world_, node.commands ? *node.commands : no_commands_, node.name};
        node.system->run(context);
      } catch (...) {
        node.state.failure = std::current_exception();
        failed = true;
      }
      timing.end_ns = monotonic_ns();
    }
    if (failed) {
      for (const std::size_t next : node.successors) {
        frame_.nodes[next]->state.left_out.store(true, std::memory_order_relaxed);
      }
    }
    return timing.end_ns;
  }

  // The end of one system is the start of the next: one reading of the clock each.
  void run_in_order(const Stage& stage) {
    const int worker = parallel::current_worker();
    std::int64_t now = monotonic_ns();
    for (const std::size_t id : stage.systems) now = run_system(id, now, worker);
  }

  void run_in_parallel(const Stage& stage) {
    parallel::TaskSet tasks;
    tasks_ = &tasks;
    running_.store(static_cast<int>(stage.systems.size()), std::memory_order_release);
    for (std::size_t i = 1; i < stage.roots.size(); ++i) start(stage.roots[i]);
    run_from(stage.roots[0]);
    tasks.wait();
    // Every system's last act on running_ is a release: with this, all they wrote is visible here.
    [[maybe_unused]] const int running = running_.load(std::memory_order_acquire);
    assert(running == 0);
  }

  void start(std::size_t id) {
    tasks_->start([](void* run, std::size_t index) { static_cast<ScheduleRun*>(run)->run_from(index); }, this, id);
  }

  // Runs a system that is ready, then the first of those it makes ready, and so on; starts the others.
  void run_from(std::size_t id) {
    // What the caller did before the stage, and what the systems did that this one waited for.
    (void)running_.load(std::memory_order_acquire);
    (void)frame_.nodes[id]->state.pending.load(std::memory_order_acquire);
    const int worker = parallel::current_worker();
    constexpr std::size_t kNone = ~std::size_t{0};
    while (id != kNone) {
      run_system(id, monotonic_ns(), worker);
      std::size_t next = kNone;
      for (const std::size_t successor : frame_.nodes[id]->successors) {
        // Release what this system wrote; acquire what the others did that the successor waited for.
        if (frame_.nodes[successor]->state.pending.fetch_sub(1, std::memory_order_acq_rel) != 1) continue;
        if (next == kNone) {
          next = successor;
        } else {
          start(successor);
        }
      }
      running_.fetch_sub(1, std::memory_order_acq_rel);
      id = next;
    }
  }

  // The failure to rethrow, if any; then the commands of the stage are dropped.
  std::exception_ptr end_of(const Stage& stage) {
    std::exception_ptr first;
    for (const std::size_t id : stage.systems) {
      std::exception_ptr failure = std::exchange(frame_.nodes[id]->state.failure, nullptr);
      if (failure && !first) first = std::move(failure);
    }
    if (first) {
      for (const std::size_t id : stage.commands) frame_.nodes[id]->commands->clear();
    }
    return first;
  }

  void leave_out_after(std::size_t failed_stage) {
    const std::int64_t now = monotonic_ns();
    for (SystemTiming& timing : frame_.timings) {
      const bool barrier = &timing >= frame_.timings.data() + frame_.nodes.size();
      const int failed = static_cast<int>(failed_stage);
      if (timing.stage > failed || (barrier && timing.stage == failed)) {
        timing.start_ns = timing.end_ns = now;
      }
    }
  }

  void apply_commands(const Stage& stage) {
    if (stage.commands.empty()) return;
    SystemTiming& timing = frame_.timings[barrier_row_++];
    timing.worker = parallel::current_worker();
    timing.start_ns = timing.end_ns = monotonic_ns();
    try {
      for (const std::size_t id : stage.commands) frame_.nodes[id]->commands->apply(world_);
    } catch (...) {
      for (const std::size_t id : stage.commands) frame_.nodes[id]->commands->clear();
      throw;
    }
    timing.end_ns = monotonic_ns();
  }

  Schedule::Frame& frame_;
  World& world_;
  int workers_;
  std::size_t barrier_row_;  // timing row of the next stage with commands
  Commands no_commands_;     // for systems that take none
  parallel::TaskSet* tasks_ = nullptr;
  // Systems of the stage that have not ended. Its stores and loads also repeat, where the thread sanitizer can see it,
  // the order oneTBB gives between the caller and the workers.
  std::atomic<int> running_ = 0;
};

void Schedule::run(World& world, parallel::WorkerArena& arena) {
  arena.execute([&] { ScheduleRun(*frame_, world, arena.workers()).run(); });
}

std::size_t Schedule::size() const { return frame_->nodes.size(); }

std::string_view Schedule::name(SystemId id) const { return frame_->nodes[id.value]->name; }

int Schedule::stage(SystemId id) const { return frame_->nodes[id.value]->stage; }

std::vector<SystemId> Schedule::waits_for(SystemId id) const {
  std::vector<SystemId> result;
  for (const Dependency& dependency : frame_->nodes[id.value]->waits_for) {
    result.push_back({static_cast<std::uint32_t>(dependency.earlier)});
  }
  return result;
}

std::span<const SystemTiming> Schedule::timings() const { return frame_->timings; }

}  // namespace fascicle::ecs
