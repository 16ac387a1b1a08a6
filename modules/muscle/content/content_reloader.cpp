#include "modules/muscle/content/content_reloader.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <iterator>
#include <mutex>
#include <span>
#include <stop_token>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "engine/content/watch_files.hpp"
#include "modules/muscle/content/load_scene.hpp"

namespace fascicle::muscle {

namespace {

namespace fs = std::filesystem;

// What one load brought, with the files to watch from then on.
struct Load {
  ReloadOutcome outcome;
  std::vector<fs::path> files;
  fs::file_time_type started;
};

Load load_aside(const fs::path& file, const LoadOptions& options) {
  Load load;
  load.started = fs::file_time_type::clock::now();
  try {
    auto result = load_scene(file, options, load.files);
    if (result) load.outcome.scene = *result;
    load.outcome.diagnostics = std::move(result.diagnostics());
  } catch (const std::exception& failure) {  // out of memory, or a folder that vanished while it was read
    load.outcome.diagnostics.errors.push_back(
        {file.string(), 0, 0, {}, std::string("the load failed: ") + failure.what(), "save the file again to retry"});
    load.files.push_back(file);
  }
  return load;
}

// Whether one of `files` was written after a load began that read it; the clock of file times ticks every 10 ms at
// worst. The watcher cannot know: it sees these files for the first time.
bool any_written_since(std::span<const fs::path> files, fs::file_time_type start) {
  return std::any_of(files.begin(), files.end(), [&](const fs::path& file) {
    std::error_code error;
    const fs::file_time_type written = fs::last_write_time(file, error);
    return !error && written >= start - std::chrono::milliseconds(10);
  });
}

}  // namespace

// The caller's thread owns everything outside the mutex, the watcher too; the loader's thread only loads.
struct ContentReloader::State {
  fs::path file;
  LoadOptions options;
  FileWatcher watcher;
  std::vector<fs::path> good_files;  // of the last good load: watched on while an error hides some of them
  std::vector<fs::path> watched;
  std::vector<fs::path> changed;
  bool loading = false;  // a load was asked for and its outcome not yet taken
  bool dirty = false;    // a file changed since the last load was asked for

  std::mutex mutex;
  std::condition_variable_any wake;
  bool wanted = false;
  std::optional<Load> finished;
  std::jthread loader;  // the last member: it stops before what it uses goes

  void run(std::stop_token stop) {
    std::unique_lock lock(mutex);
    while (wake.wait(lock, stop, [this] { return wanted; })) {
      wanted = false;
      lock.unlock();
      Load load = load_aside(file, options);
      lock.lock();
      finished = std::move(load);
    }
  }

  void start_load() {
    loading = true;
    dirty = false;
    const std::lock_guard lock(mutex);
    wanted = true;
    wake.notify_one();
  }

  // Watches `files` and those of the last good load; those that are new must not have changed since `start`.
  void watch(const std::vector<fs::path>& files, fs::file_time_type start) {
    std::vector<fs::path> next = good_files;
    next.insert(next.end(), files.begin(), files.end());
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    std::vector<fs::path> fresh;
    std::set_difference(next.begin(), next.end(), watched.begin(), watched.end(), std::back_inserter(fresh));
    watched = std::move(next);
    watcher.watch(watched);
    if (any_written_since(fresh, start)) dirty = true;
  }

  // A finished load is news only where nothing changed while it ran: else it may have read old and new files.
  std::optional<ReloadOutcome> take(Load load) {
    loading = false;
    if (load.outcome.scene) good_files = load.files;
    watch(load.files, load.started);
    if (dirty) return std::nullopt;
    return std::move(load.outcome);
  }
};

ContentReloader::ContentReloader(fs::path file, std::shared_ptr<const SceneAsset> scene, LoadOptions options)
    : state_(std::make_unique<State>()) {
  state_->file = std::move(file);
  state_->options = std::move(options);
  if (scene) {
    state_->good_files = scene->files;
    state_->watch({}, scene->load_started);
  } else {
    // What the failed load looked at is not known here: load again, quietly.
    state_->watch({state_->file}, fs::file_time_type::max());
    state_->dirty = true;
  }
  state_->loader = std::jthread([state = state_.get()](std::stop_token stop) { state->run(stop); });
}

ContentReloader::~ContentReloader() = default;

std::optional<ReloadOutcome> ContentReloader::poll() {
  State& state = *state_;
  state.changed.clear();
  if (state.watcher.poll(state.changed)) state.dirty = true;
  std::optional<ReloadOutcome> outcome;
  if (state.loading) {
    std::optional<Load> finished;
    {
      const std::lock_guard lock(state.mutex);
      finished.swap(state.finished);
    }
    if (finished) outcome = state.take(std::move(*finished));
  }
  if (state.dirty && !state.loading) state.start_load();
  return outcome;
}

std::optional<ReloadOutcome> ContentReloader::wait() {
  std::optional<ReloadOutcome> last;
  // The watcher reports a change when it has looked the same in two polls.
  for (int idle = 0; idle < 3;) {
    if (std::optional<ReloadOutcome> outcome = poll()) last = std::move(outcome);
    if (state_->dirty || state_->loading) {
      idle = 0;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } else {
      ++idle;
    }
  }
  return last;
}

}  // namespace fascicle::muscle
