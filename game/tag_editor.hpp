// An author adds a transversal tag by clicking: the two places that were picked, how the tag will act, and what the
// overlay says of it. It knows neither window nor files: picks and keys go in, a tag comes out, the caller saves it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/render/input.hpp"
#include "engine/render/overlay.hpp"
#include "modules/muscle/asset/collision/collision_description.hpp"
#include "modules/muscle/content/character_asset.hpp"

namespace fascicle::game {

// A section's vertex, or a bone.
struct PickedPlace {
  std::size_t character = 0;  // of Simulation::characters()
  std::string name;           // the muscle's or the bone's
  std::int32_t bone = -1;     // >= 0: a bone
  muscle::SectionTag tag;     // else this place
};

enum class TagCommand { kSave, kForget, kYields, kSweeps, kSides, kLeave };

class TagEditor {
 public:
  bool active() const { return active_; }
  void set_active(bool active);

  // The first place must be on a muscle, the second on another one or on a bone; a further one replaces the second.
  void pick(const PickedPlace& place);
  const std::vector<PickedPlace>& places() const { return places_; }

  // What a key or the task's button asks for. kSave and kLeave are the caller's to do.
  static std::optional<TagCommand> command_of(const InputState& input);
  static TagCommand command_of_button(int button) { return static_cast<TagCommand>(button); }
  void apply(TagCommand command);

  // What was picked, as a tag; nothing before there are two places.
  std::optional<muscle::TransversalTag> tag() const;
  // For save_transversal: nothing, so that the tag stands for both sides, or false.
  std::optional<bool> mirror() const { return both_sides_ ? std::nullopt : std::optional<bool>(false); }

  void set_saved(const std::string& file);       // forgets the places
  void set_failed() { message_ = "not saved; the places are kept"; }
  // The characters have been loaded anew: numbers of muscles and bones may have changed, names count. Places that are
  // no more are forgotten.
  void rename(const std::vector<const muscle::CharacterAsset*>& characters);

  // For the overlay; until the next call.
  const OverlayTask& task();

 private:
  bool active_ = false;
  std::vector<PickedPlace> places_;
  muscle::Yields yields_ = muscle::Yields::kBoth;
  bool sweeps_ = false, both_sides_ = true;
  std::string message_;
  OverlayTask task_;
};

}  // namespace fascicle::game
