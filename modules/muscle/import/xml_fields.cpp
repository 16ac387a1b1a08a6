#include "modules/muscle/import/xml_fields.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace fascicle::muscle {
namespace {

constexpr double kLargest = 1e9;
constexpr std::string_view kSpaces = " \t\r\n\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kSpaces);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpaces) - begin + 1);
}

bool parse_number(std::string_view text, double& out) {
  if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code == std::errc::result_out_of_range && end == text.data() + text.size()) {
    value = std::strtod(std::string(text).c_str(), nullptr);  // a denormal, or beyond the range
  } else if (code != std::errc{} || end != text.data() + text.size()) {
    return false;
  }
  if (!(std::abs(value) <= kLargest)) return false;
  out = value;
  return true;
}

}  // namespace

std::string XmlFields::path(pugi::xml_node node) {
  std::string path;
  for (; node && node.type() == pugi::node_element; node = node.parent()) {
    if (std::string_view(node.name()) == "objects" || std::string_view(node.name()) == "OpenSimDocument") continue;
    std::string step = node.name();
    // A model's or a set's own name says nothing.
    if (const std::string name = name_of(node); !name.empty() && node.parent().parent().parent().parent())
      step += "[" + name + "]";
    path = path.empty() ? step : step + "/" + path;
  }
  return path;
}

TextPosition XmlFields::position(pugi::xml_node node) const {
  const std::ptrdiff_t offset = node.offset_debug();
  return offset < 0 ? TextPosition{} : lines_.position(text_, static_cast<std::size_t>(offset));
}

void XmlFields::error(pugi::xml_node node, std::string cause, std::string remedy) {
  const TextPosition at = position(node);
  diagnostics.errors.push_back({file_, at.line, at.column, path(node), std::move(cause), std::move(remedy)});
}

void XmlFields::warning(pugi::xml_node node, std::string cause, std::string remedy) {
  const TextPosition at = position(node);
  diagnostics.warnings.push_back({file_, at.line, at.column, path(node), std::move(cause), std::move(remedy)});
}

void XmlFields::error_at(std::size_t offset, std::string cause, std::string remedy) {
  const TextPosition at = lines_.position(text_, offset);
  diagnostics.errors.push_back({file_, at.line, at.column, {}, std::move(cause), std::move(remedy)});
}

bool XmlFields::numbers(pugi::xml_node parent, const char* child, std::size_t count, std::vector<double>& out) {
  const pugi::xml_node node = parent.child(child);
  if (!node) return true;
  std::vector<double> values;
  for (const std::string& word : split_words(node.child_value())) {
    double value = 0.0;
    if (!parse_number(word, value)) {
      error(node, fmt::format("'{}' is not a finite number within 1e9", word.substr(0, 40)), "write a plain number");
      return false;
    }
    values.push_back(value);
  }
  if (count != 0 && values.size() != count) {
    error(node, fmt::format("{} number{}", values.size(), values.size() == 1 ? "" : "s"),
          fmt::format("give {}", count));
    return false;
  }
  out = std::move(values);
  return true;
}

bool XmlFields::number(pugi::xml_node parent, const char* child, double& out) {
  std::vector<double> values{out};
  if (!numbers(parent, child, 1, values)) return false;
  out = values[0];
  return true;
}

bool XmlFields::number_in(pugi::xml_node parent, const char* child, double min, double max, double& out) {
  double value = out;
  if (!number(parent, child, value)) return false;
  if (value < min || value > max) {
    error(parent.child(child), fmt::format("{} is out of range", value),
          fmt::format("give a number from {} to {}", min, max));
    return false;
  }
  out = value;
  return true;
}

bool XmlFields::vector(pugi::xml_node parent, const char* child, glm::dvec3& out) {
  std::vector<double> values{out.x, out.y, out.z};
  if (!numbers(parent, child, 3, values)) return false;
  out = {values[0], values[1], values[2]};
  return true;
}

bool XmlFields::boolean(pugi::xml_node parent, const char* child, bool& out) {
  const pugi::xml_node node = parent.child(child);
  if (!node) return true;
  std::string text = child_text(parent, child);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (text == "true" || text == "1") {
    out = true;
  } else if (text == "false" || text == "0") {
    out = false;
  } else {
    error(node, fmt::format("'{}' is neither true nor false", text.substr(0, 40)), "write true or false");
    return false;
  }
  return true;
}

std::string child_text(pugi::xml_node parent, const char* child) {
  return std::string(trimmed(parent.child_value(child)));
}

std::string name_of(pugi::xml_node node) { return node.attribute("name").value(); }

std::vector<std::string> split_words(std::string_view text) {
  std::vector<std::string> words;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(kSpaces, at)) != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(kSpaces, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

std::size_t find_invalid_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned char lead = byte(i);
    const std::size_t length = lead < 0x80 ? 1 : lead >= 0xc2 && lead < 0xe0 ? 2 : lead >= 0xe0 && lead < 0xf0 ? 3
                               : lead >= 0xf0 && lead < 0xf5 ? 4 : 0;
    if (length == 0 || i + length > text.size()) return i;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(i + k) & 0xc0) != 0x80) return i;
    }
    // Overlong forms, surrogates and what lies beyond the last code point.
    if (length > 2) {
      const unsigned char second = byte(i + 1);
      if ((lead == 0xe0 && second < 0xa0) || (lead == 0xed && second > 0x9f) || (lead == 0xf0 && second < 0x90) ||
          (lead == 0xf4 && second > 0x8f)) {
        return i;
      }
    }
    i += length;
  }
  return std::string_view::npos;
}

std::vector<pugi::xml_node> elements(pugi::xml_node parent) {
  std::vector<pugi::xml_node> children;
  for (const pugi::xml_node child : parent.children()) {
    if (child.type() == pugi::node_element) children.push_back(child);
  }
  return children;
}

}  // namespace fascicle::muscle
