#include "engine/content/result.hpp"

#include <fmt/format.h>

#include <iterator>

#include "engine/content/quote_json.hpp"

namespace fascicle {
namespace {

void append_json(std::string& out, const std::vector<Diagnostic>& list) {
  out += '[';
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Diagnostic& d = list[i];
    fmt::format_to(std::back_inserter(out), R"({}{{"file":{},"line":{},"column":{},"path":{},"cause":{},"remedy":{}}})",
                   i == 0 ? "" : ",", quote_json(d.file), d.line, d.column, quote_json(d.path), quote_json(d.cause),
                   quote_json(d.remedy));
  }
  out += ']';
}

}  // namespace

std::string to_string(const Diagnostic& diagnostic) {
  std::string place = diagnostic.file;
  if (diagnostic.line > 0) {
    place += fmt::format("{}{}", place.empty() ? "" : ":", diagnostic.line);
    if (diagnostic.column > 0) place += fmt::format(":{}", diagnostic.column);
  }
  std::string text = place;
  if (!diagnostic.path.empty()) text += (text.empty() ? "" : ": ") + diagnostic.path;
  if (!diagnostic.cause.empty()) text += (text.empty() ? "" : ": ") + diagnostic.cause;
  if (!diagnostic.remedy.empty()) text += (diagnostic.cause.empty() ? ": " : "; ") + diagnostic.remedy;
  return text;
}

void Diagnostics::append(Diagnostics other) {
  const auto move_to = [](std::vector<Diagnostic>& to, std::vector<Diagnostic>& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  move_to(errors, other.errors);
  move_to(warnings, other.warnings);
}

std::string to_text(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics.errors) text += "error: " + to_string(d) + '\n';
  for (const Diagnostic& d : diagnostics.warnings) text += "warning: " + to_string(d) + '\n';
  return text;
}

std::string to_json(const Diagnostics& diagnostics) {
  std::string text = "{\"errors\":";
  append_json(text, diagnostics.errors);
  text += ",\"warnings\":";
  append_json(text, diagnostics.warnings);
  text += '}';
  return text;
}

}  // namespace fascicle
