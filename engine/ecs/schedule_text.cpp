#include <fmt/format.h>

#include <algorithm>

#include "engine/ecs/schedule_frame.hpp"

namespace fascicle::ecs {

namespace {

// For a double-quoted string of the DOT language.
std::string escape_dot(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

}  // namespace

std::string Schedule::to_text() const {
  const std::vector<std::unique_ptr<Node>>& nodes = frame_->nodes;
  std::size_t name_width = 6;
  std::size_t access_width = 6;
  for (const std::unique_ptr<Node>& node : nodes) {
    name_width = std::max(name_width, node->name.size());
    access_width = std::max(access_width, ecs::to_text(node->access).size());
  }
  std::string text =
      fmt::format("{:>5}  {:>5}  {:<{}}  {:<{}}  {}\n", "order", "stage", "system", name_width, "access", access_width,
                  "waits for");
  for (std::size_t id = 0; id < nodes.size(); ++id) {
    const Node& node = *nodes[id];
    if (id > 0 && node.stage != nodes[id - 1]->stage) text += "       ----- barrier: commands are carried out\n";
    std::string waits_for;
    for (const Dependency& dependency : node.waits_for) {
      waits_for += fmt::format("{}{} ({})", waits_for.empty() ? "" : ", ", nodes[dependency.earlier]->name,
                               fmt::join(dependency.types, ", "));
    }
    text += fmt::format("{:>5}  {:>5}  {:<{}}  {:<{}}  {}\n", id, node.stage, node.name, name_width,
                        ecs::to_text(node.access), access_width, waits_for.empty() ? "-" : waits_for);
  }
  return text;
}

std::string Schedule::to_dot() const {
  const std::vector<std::unique_ptr<Node>>& nodes = frame_->nodes;
  std::string text = "digraph schedule {\n  rankdir=LR;\n  node [shape=box];\n";
  for (std::size_t stage = 0; stage < frame_->stages.size(); ++stage) {
    text += fmt::format("  subgraph cluster_{0} {{\n    label=\"stage {0}\";\n", stage);
    for (const std::size_t id : frame_->stages[stage].systems) {
      text += fmt::format("    s{} [label=\"{}\", tooltip=\"{}\"];\n", id, escape_dot(nodes[id]->name),
                          escape_dot(ecs::to_text(nodes[id]->access)));
    }
    text += "  }\n";
  }
  for (std::size_t id = 0; id < nodes.size(); ++id) {
    for (const Dependency& dependency : nodes[id]->waits_for) {
      text += fmt::format("  s{} -> s{} [label=\"{}\"];\n", dependency.earlier, id,
                          escape_dot(fmt::format("{}", fmt::join(dependency.types, ", "))));
    }
  }
  return text + "}\n";
}

}  // namespace fascicle::ecs
