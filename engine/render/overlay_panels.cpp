#include "engine/render/overlay_panels.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <imgui.h>

namespace fascicle {
namespace {

constexpr float kSmoothing = 0.06f;  // weight of a new value in the shown average
constexpr float kNameWidth = 180.0f;   // pixels of the item list's columns
constexpr float kValueWidth = 64.0f;
constexpr int kValueCharacters = 8;
const ImVec4 kRed(1.00f, 0.45f, 0.40f, 1.0f);
const ImVec4 kAmber(1.00f, 0.78f, 0.30f, 1.0f);
const ImVec4 kGrey(0.62f, 0.66f, 0.70f, 1.0f);

void text(std::string_view line) { ImGui::TextUnformatted(line.data(), line.data() + line.size()); }

void push_list(std::span<const OverlayTiming> timings, std::vector<TimingHistory>& histories) {
  const bool same = std::equal(timings.begin(), timings.end(), histories.begin(), histories.end(),
                               [](const OverlayTiming& timing, const TimingHistory& history) {
                                 return timing.name == history.name;
                               });
  if (!same) {
    histories.assign(timings.size(), {});
    for (std::size_t i = 0; i < timings.size(); ++i) histories[i].name = timings[i].name;
  }
  for (std::size_t i = 0; i < timings.size(); ++i) histories[i].push(timings[i].milliseconds);
}

void sparkline(const char* id, const TimingHistory& history, float high, const ImVec2& size) {
  ImGui::PlotLines(id, history.values.data(), TimingHistory::kLength, history.next, nullptr, 0.0f, high, size);
}

void lay_out_frame(const OverlayModel& model, const OverlayMemory& memory, OverlayActions& actions) {
  text(model.title);
  ImGui::PushStyleColor(ImGuiCol_Text, kGrey);
  ImGui::PushTextWrapPos(0.0f);
  text(model.subtitle);
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();

  if (ImGui::Button(model.paused ? "Resume" : "Pause", ImVec2(70.0f, 0.0f))) actions.toggle_pause = true;
  ImGui::SameLine();
  if (ImGui::Button("Step", ImVec2(50.0f, 0.0f))) actions.single_step = true;
  ImGui::SameLine();
  float scale = model.time_scale;
  ImGui::SetNextItemWidth(110.0f);
  if (ImGui::SliderFloat("speed", &scale, 0.0f, 2.0f, "%.2f")) actions.time_scale = scale;

  const float average = memory.history.frame.average;
  ImGui::Text("frame %.2f ms  %.0f Hz  step %llu  %.2f s%s", static_cast<double>(average),
              average > 0.0f ? 1000.0 / static_cast<double>(average) : 0.0,
              static_cast<unsigned long long>(model.frame), model.time, model.paused ? "  paused" : "");
  const auto& values = memory.history.frame.values;
  const float high = std::max(1.5f * model.budget_milliseconds, *std::max_element(values.begin(), values.end()));
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const ImVec2 size(ImGui::GetContentRegionAvail().x, 48.0f);
  sparkline("##frame", memory.history.frame, high, size);
  const float budget_y = corner.y + size.y * (1.0f - model.budget_milliseconds / high);
  ImGui::GetWindowDrawList()->AddLine(ImVec2(corner.x, budget_y), ImVec2(corner.x + size.x, budget_y),
                                      IM_COL32(120, 220, 120, 140));
  if (model.catch_up_steps > 0) {
    ImGui::TextColored(kAmber, "%llu steps dropped to catch up", static_cast<unsigned long long>(model.catch_up_steps));
  }
  for (std::size_t i = 0; i < model.counts.size(); ++i) {
    if (i % 2 != 0) ImGui::SameLine(0.0f, 14.0f);
    ImGui::Text("%.*s %.0f", static_cast<int>(model.counts[i].name.size()), model.counts[i].name.data(),
                static_cast<double>(model.counts[i].milliseconds));
  }
}

void lay_out_timings(const char* id, const std::vector<TimingHistory>& histories) {
  if (histories.empty()) {
    ImGui::TextColored(kGrey, "none measured");
    return;
  }
  float total = 0.0f, high = 0.0f;
  for (const TimingHistory& history : histories) {
    total += history.average;
    high = std::max(high, history.average);
  }
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg;
  if (!ImGui::BeginTable(id, 3, kFlags)) return;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn("ms", ImGuiTableColumnFlags_WidthFixed, 52.0f);
  ImGui::TableSetupColumn("history", ImGuiTableColumnFlags_WidthFixed, 96.0f);
  for (std::size_t i = 0; i < histories.size(); ++i) {
    const TimingHistory& history = histories[i];
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    text(history.name);
    ImGui::TableNextColumn();
    ImGui::Text("%6.3f", static_cast<double>(history.average));
    ImGui::TableNextColumn();
    ImGui::PushID(static_cast<int>(i));
    const float peak = *std::max_element(history.values.begin(), history.values.end());
    sparkline("##history", history, std::max({peak, 0.25f * high, 1e-4f}), ImVec2(94.0f, 13.0f));
    ImGui::PopID();
  }
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextColored(kGrey, "sum");
  ImGui::TableNextColumn();
  ImGui::TextColored(kGrey, "%6.3f", static_cast<double>(total));
  ImGui::EndTable();
}

void lay_out_switches(const OverlayModel& model, OverlayActions& actions) {
  if (ImGui::BeginTable("##switches", 2)) {
    for (std::size_t i = 0; i < model.switches.size(); ++i) {
      ImGui::TableNextColumn();
      bool on = model.switches[i].on;
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Checkbox(model.switches[i].name, &on)) actions.switched = static_cast<int>(i);
      if (model.switches[i].shortcut[0] != '\0') {
        ImGui::SameLine();
        ImGui::TextColored(kGrey, "%s", model.switches[i].shortcut);
      }
      ImGui::PopID();
    }
    ImGui::EndTable();
  }
  for (std::size_t i = 0; i < model.sliders.size(); ++i) {
    const OverlaySlider& slider = model.sliders[i];
    float value = slider.value;
    ImGui::PushID(static_cast<int>(i));
    ImGui::SetNextItemWidth(160.0f);
    if (ImGui::SliderFloat(slider.name, &value, slider.low, slider.high, "%.2f")) {
      actions.slider = static_cast<int>(i);
      actions.slider_value = value;
    }
    ImGui::PopID();
  }
}

std::size_t count_values(const OverlayModel& model) {
  std::size_t count = 0;
  const auto is_heading = [](const char* text) { return text != nullptr && text[0] != '\0'; };
  while (count < kOverlayValues && is_heading(model.value_headings[count])) ++count;
  return count;
}

bool matches(std::string_view name, std::string_view filter) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(name.begin(), name.end(), filter.begin(), filter.end(), same) != name.end();
}

void lay_out_item(const OverlayItem& item, int index, std::size_t value_columns,
                 OverlayActions& actions) {
  ImGui::PushID(index);
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  bool visible = item.visible;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(0.0f, 0.0f));
  if (ImGui::Checkbox("##visible", &visible)) actions.item_visibility = index;
  ImGui::PopStyleVar();
  ImGui::SameLine();
  if (item.warning) ImGui::PushStyleColor(ImGuiCol_Text, kAmber);
  // The name takes what is left of its column; a click on it highlights the item.
  const ImVec2 at = ImGui::GetCursorPos();
  if (ImGui::Selectable("##select", item.highlighted)) actions.item_highlighted = index;
  ImGui::SameLine();
  ImGui::SetCursorPos(at);
  text(item.name);
  if (item.warning) ImGui::PopStyleColor();
  for (std::size_t column = 0; column < value_columns; ++column) {
    ImGui::TableNextColumn();
    const float value = item.values[column];
    if (!std::isnan(value)) ImGui::Text("%*.2f", kValueCharacters, static_cast<double>(value));
  }
  ImGui::PopID();
}

void lay_out_items(const OverlayModel& model, OverlayMemory& memory, OverlayActions& actions) {
  ImGui::SetNextItemWidth(-1.0f);
  ImGui::InputTextWithHint("##filter", "filter by name", memory.filter.data(), memory.filter.size());
  const std::size_t value_columns = count_values(model);
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit;
  if (!ImGui::BeginTable("##items", 1 + static_cast<int>(value_columns), kFlags)) return;
  ImGui::TableSetupScrollFreeze(0, 1);
  ImGui::TableSetupColumn(model.item_heading, ImGuiTableColumnFlags_WidthStretch);
  for (std::size_t column = 0; column < value_columns; ++column) {
    ImGui::TableSetupColumn(model.value_headings[column], ImGuiTableColumnFlags_WidthFixed, kValueWidth);
  }
  ImGui::TableHeadersRow();
  const std::string_view filter(memory.filter.data());
  for (std::size_t i = 0; i < model.items.size(); ++i) {
    if (matches(model.items[i].name, filter)) {
      lay_out_item(model.items[i], static_cast<int>(i), value_columns, actions);
    }
  }
  ImGui::EndTable();
}

// Below everything else, right of the main panel, so that neither hides the other.
void lay_out_messages(const OverlayModel& model, float left, float width, float height, OverlayActions& actions) {
  if (model.errors.empty() && model.warnings.empty()) return;
  const float room = std::max(width - left - 10.0f, 200.0f);
  ImGui::SetNextWindowPos(ImVec2(left, height - 10.0f), ImGuiCond_Always, ImVec2(0.0f, 1.0f));
  ImGui::SetNextWindowSizeConstraints(ImVec2(std::min(room, 420.0f), 0.0f), ImVec2(room, 0.4f * height));
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
  if (ImGui::Begin("##messages", nullptr, kFlags)) {
    ImGui::PushTextWrapPos(room - 20.0f);
    const auto lines = [](std::span<const std::string> messages, const ImVec4& colour) {
      ImGui::PushStyleColor(ImGuiCol_Text, colour);
      for (const std::string& message : messages) text(message);
      ImGui::PopStyleColor();
    };
    lines(model.errors, kRed);
    lines(model.warnings, kAmber);
    ImGui::PopTextWrapPos();
    if (ImGui::SmallButton("dismiss")) actions.dismiss_messages = true;
  }
  ImGui::End();
}

// In the lower right corner, below the item list.
void lay_out_task(const OverlayTask& task, float width, float height, float margin, OverlayActions& actions) {
  ImGui::SetNextWindowPos(ImVec2(width - margin, height - margin), ImGuiCond_Always, ImVec2(1.0f, 1.0f));
  ImGui::SetNextWindowSizeConstraints(ImVec2(300.0f, 0.0f), ImVec2(std::max(0.5f * width, 300.0f), 0.36f * height));
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar |
                                      ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
  if (ImGui::Begin("##task", nullptr, kFlags)) {
    text(task.title);
    for (const std::string& line : task.lines) text(line);
    for (std::size_t i = 0; i < task.buttons.size(); ++i) {
      const OverlayButton& button = task.buttons[i];
      if (i % 2 != 0) ImGui::SameLine();
      ImGui::PushID(static_cast<int>(i));
      ImGui::BeginDisabled(!button.enabled);
      if (ImGui::Button(button.name.c_str())) actions.task_button = static_cast<int>(i);
      ImGui::EndDisabled();
      ImGui::SameLine();
      ImGui::TextColored(kGrey, "%s", button.shortcut);
      ImGui::PopID();
    }
  }
  ImGui::End();
}

}  // namespace

void TimingHistory::push(float milliseconds) {
  values[static_cast<std::size_t>(next)] = milliseconds;
  next = (next + 1) % kLength;
  average = average == 0.0f ? milliseconds : average + kSmoothing * (milliseconds - average);
}

void OverlayHistory::push(const OverlayModel& model) {
  frame.push(model.frame_milliseconds);
  push_list(model.systems, systems);
  push_list(model.gpu, gpu);
}

OverlayActions lay_out_overlay(const OverlayModel& model, float width, float height, OverlayMemory& memory) {
  OverlayActions actions;
  constexpr float kMargin = 10.0f;
  constexpr float kMainWidth = 340.0f;
  const float tallest = std::max(height - 2.0f * kMargin, 100.0f);
  constexpr ImGuiWindowFlags kPanel = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoSavedSettings;

  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin), ImGuiCond_Always);
  ImGui::SetNextWindowSizeConstraints(ImVec2(kMainWidth, 60.0f), ImVec2(kMainWidth, tallest));
  if (ImGui::Begin("##main", nullptr, kPanel | ImGuiWindowFlags_AlwaysAutoResize)) {
    lay_out_frame(model, memory, actions);
    if (!model.systems.empty() && ImGui::CollapsingHeader("Time per system, ms", ImGuiTreeNodeFlags_DefaultOpen)) {
      lay_out_timings("##systems", memory.history.systems);
    }
    if (!model.gpu.empty() && ImGui::CollapsingHeader("Graphics card, ms", ImGuiTreeNodeFlags_DefaultOpen)) {
      lay_out_timings("##gpu", memory.history.gpu);
    }
    if (!model.switches.empty() && ImGui::CollapsingHeader("Show", ImGuiTreeNodeFlags_DefaultOpen)) {
      lay_out_switches(model, actions);
    }
    if (ImGui::SmallButton("hide overlay")) actions.hide_overlay = true;
  }
  ImGui::End();

  if (!model.items.empty()) {
    const float values_width = kValueWidth * static_cast<float>(count_values(model));
    const float gaps = 2.0f * ImGui::GetStyle().CellPadding.x * static_cast<float>(count_values(model));
    const float item_width = std::max(kNameWidth + values_width + gaps + 30.0f, 460.0f);
    ImGui::SetNextWindowPos(ImVec2(width - item_width - kMargin, kMargin), ImGuiCond_Always);
    // The filter, the headings and a line an item, and a line to spare for the window's and the table's borders.
    const float lines = static_cast<float>(model.items.size()) + 2.0f;
    const float wanted = ImGui::GetFrameHeightWithSpacing() + lines * ImGui::GetFrameHeightWithSpacing();
    ImGui::SetNextWindowSize(ImVec2(item_width, std::min({wanted, 0.62f * height, tallest})), ImGuiCond_Always);
    if (ImGui::Begin("##item list", nullptr, kPanel)) lay_out_items(model, memory, actions);
    ImGui::End();
  }
  if (model.task != nullptr && !model.task->title.empty()) lay_out_task(*model.task, width, height, kMargin, actions);
  lay_out_messages(model, kMainWidth + 2.0f * kMargin, width, height, actions);
  return actions;
}

}  // namespace fascicle
