// XML elements read with the place of everything, for errors that name file, line, column and element path. Used by
// the readers of this folder only (it includes pugixml).
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>
#include <pugixml.hpp>

#include "engine/content/result.hpp"
#include "engine/content/text_position.hpp"

namespace fascicle::muscle {

class XmlFields {
 public:
  // `text` outlives this object and is what `document` was parsed from.
  XmlFields(std::string_view text, std::string file) : text_(text), file_(std::move(file)), lines_(text) {}

  Diagnostics diagnostics;

  void error(pugi::xml_node node, std::string cause, std::string remedy);
  void warning(pugi::xml_node node, std::string cause, std::string remedy);
  void error_at(std::size_t offset, std::string cause, std::string remedy);
  TextPosition position(pugi::xml_node node) const;

  // "Model/JointSet/CustomJoint[knee_r]/SpatialTransform": element names, with the name attribute where there is one.
  static std::string path(pugi::xml_node node);

  // Values of child elements. An absent child leaves `out` (OpenSim's default) as it is and is right; a wrong one is an
  // error. All numbers are finite and within 1e9.
  bool number(pugi::xml_node parent, const char* child, double& out);
  bool number_in(pugi::xml_node parent, const char* child, double min, double max, double& out);
  bool vector(pugi::xml_node parent, const char* child, glm::dvec3& out);
  bool boolean(pugi::xml_node parent, const char* child, bool& out);
  // Exactly `count` numbers, or any count for 0.
  bool numbers(pugi::xml_node parent, const char* child, std::size_t count, std::vector<double>& out);

 private:
  std::string_view text_;
  std::string file_;
  LineTable lines_;
};

// The text of a child element, trimmed; empty where it is absent.
std::string child_text(pugi::xml_node parent, const char* child);
std::string name_of(pugi::xml_node node);
std::vector<std::string> split_words(std::string_view text);
// Offset of the first byte that is not UTF-8 (RFC 3629), or npos. pugixml passes such bytes on as they are.
std::size_t find_invalid_utf8(std::string_view text);
// The elements among a node's children.
std::vector<pugi::xml_node> elements(pugi::xml_node parent);

}  // namespace fascicle::muscle
