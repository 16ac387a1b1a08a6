#include "game/tag_editor.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "engine/animation/skeleton.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"

namespace fascicle::game {
namespace {

// In the order of TagCommand.
struct CommandKey {
  const char* shortcut;
  Key key;
};
constexpr std::array<CommandKey, 6> kCommands = {{{"Enter", Key::enter},
                                                  {"Backspace", Key::backspace},
                                                  {"Y", Key::y},
                                                  {"W", Key::w},
                                                  {"O", Key::o},
                                                  {"Escape", Key::escape}}};

const char* to_text(muscle::Yields yields) {
  switch (yields) {
    case muscle::Yields::kBoth: return "both yield";
    case muscle::Yields::kFirst: return "the first yields";
    case muscle::Yields::kSecond: return "the second yields";
  }
  return "";
}

std::string to_text(const PickedPlace& place) {
  if (place.bone >= 0) return fmt::format("bone {}", place.name);
  return fmt::format("{} at {:.3f}, angle {:.2f}", place.name, static_cast<double>(place.tag.fraction),
                     static_cast<double>(place.tag.angle));
}

}  // namespace

void TagEditor::set_active(bool active) {
  active_ = active;
  message_.clear();
}

void TagEditor::pick(const PickedPlace& place) {
  message_.clear();
  if (places_.empty()) {
    if (place.bone >= 0) message_ = fmt::format("bone {}: the first place must be on a muscle", place.name);
    else places_.push_back(place);
    return;
  }
  const PickedPlace& first = places_.front();
  if (place.character != first.character) {
    message_ = "both places must be on one character";
  } else if (place.bone < 0 && place.name == first.name) {
    message_ = fmt::format("{} is the first place's muscle; choose another, or a bone", place.name);
  } else {
    places_.resize(1);
    places_.push_back(place);
  }
}

std::optional<TagCommand> TagEditor::command_of(const InputState& input) {
  for (std::size_t i = 0; i < kCommands.size(); ++i) {
    if (input.was_pressed(kCommands[i].key)) return static_cast<TagCommand>(i);
  }
  return std::nullopt;
}

void TagEditor::apply(TagCommand command) {
  switch (command) {
    case TagCommand::kForget:
      if (!places_.empty()) places_.pop_back();
      message_.clear();
      break;
    case TagCommand::kYields:
      yields_ = static_cast<muscle::Yields>((static_cast<int>(yields_) + 1) % 3);
      break;
    case TagCommand::kSweeps: sweeps_ = !sweeps_; break;
    case TagCommand::kSides: both_sides_ = !both_sides_; break;
    case TagCommand::kSave:
    case TagCommand::kLeave: break;
  }
}

std::optional<muscle::TransversalTag> TagEditor::tag() const {
  if (places_.size() < 2) return std::nullopt;
  muscle::TransversalTag tag;
  tag.first = places_[0].tag;
  tag.bone = places_[1].bone;
  if (tag.bone < 0) tag.second = places_[1].tag;
  tag.yields = tag.bone < 0 ? yields_ : muscle::Yields::kBoth;
  tag.sweeps = sweeps_;
  return tag;
}

void TagEditor::set_saved(const std::string& file) {
  places_.clear();
  message_ = fmt::format("saved to {}", file);
}

void TagEditor::rename(const std::vector<const muscle::CharacterAsset*>& characters) {
  const auto is_gone = [&](PickedPlace& place) {
    if (place.character >= characters.size()) return true;
    const muscle::CharacterAsset& asset = *characters[place.character];
    if (place.bone >= 0) {
      const std::vector<std::string>& names = asset.skeleton->names;
      const auto found = std::find(names.begin(), names.end(), place.name);
      place.bone = static_cast<std::int32_t>(found - names.begin());
      return found == names.end();
    }
    const std::int32_t muscle = asset.muscles ? find_muscle(*asset.muscles, place.name) : -1;
    place.tag.muscle = static_cast<std::uint32_t>(std::max(muscle, 0));
    return muscle < 0;
  };
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (!is_gone(places_[i])) continue;
    message_ = fmt::format("{} is no more", places_[i].name);
    places_.resize(i);  // a second place means nothing without the first
  }
}

const OverlayTask& TagEditor::task() {
  task_.lines.clear();
  task_.buttons.clear();
  task_.title = active_ ? "Transversal tag" : "";
  if (!active_) return task_;
  const char* ask[] = {"click a muscle's surface", "click another muscle's surface, or a bone"};
  for (std::size_t i = 0; i < 2; ++i) {
    task_.lines.push_back(fmt::format("{}  {}", i + 1, i < places_.size() ? to_text(places_[i]) : ask[i]));
    if (i >= places_.size()) break;
  }
  if (!message_.empty()) task_.lines.push_back(message_);
  const bool complete = places_.size() == 2;
  const bool of_bone = complete && places_[1].bone >= 0;
  const std::array<std::string, 6> names = {"Save", "Forget last", of_bone ? "the muscle yields" : to_text(yields_),
                                            sweeps_ ? "sweeps on" : "sweeps off",
                                            both_sides_ ? "both sides" : "this side", "Leave"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto command = static_cast<TagCommand>(i);
    const bool enabled = command == TagCommand::kSave     ? complete
                         : command == TagCommand::kForget ? !places_.empty()
                         : command == TagCommand::kYields ? !of_bone
                                                          : true;
    task_.buttons.push_back({names[i], kCommands[i].shortcut, enabled});
  }
  return task_;
}

}  // namespace fascicle::game
