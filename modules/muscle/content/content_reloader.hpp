// Live reload, loader side. A reloader watches every file that a scene is made of. When one changes it loads the
// whole scene anew on a thread of its own and hands the outcome over at the next `poll`, which a game calls between
// two frames: a new scene to swap in, or the errors to show while the last good scene keeps running.
//
// The end state depends only on what the files hold once edits have settled: a change seen during a load makes it
// load again, so that the last outcome always equals a fresh load.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "engine/content/result.hpp"
#include "modules/muscle/content/scene_asset.hpp"

namespace fascicle::muscle {

struct ReloadOutcome {
  std::shared_ptr<const SceneAsset> scene;  // null where the new content has errors
  Diagnostics diagnostics;                  // its errors, or the warnings of a good load
};

class ContentReloader {
 public:
  // `scene` is what runs now (its files are watched); null where the first load failed, so that mending the file helps.
  ContentReloader(std::filesystem::path file, std::shared_ptr<const SceneAsset> scene, LoadOptions options = {});
  ~ContentReloader();
  ContentReloader(const ContentReloader&) = delete;
  ContentReloader& operator=(const ContentReloader&) = delete;

  // Never blocks. An outcome at most once a settled change.
  std::optional<ReloadOutcome> poll();

  // Waits until every change made so far has been loaded; for tests and tools, not for frames.
  std::optional<ReloadOutcome> wait();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fascicle::muscle
