#include "engine/content/ply_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/content/file_text.hpp"
#include "engine/content/mesh_faces.hpp"
#include "engine/content/mesh_source.hpp"

namespace fascicle {
namespace {

std::optional<NumberType> find_type(std::string_view name) {
  static constexpr std::pair<std::string_view, NumberType> kTypes[] = {
      {"char", NumberType::kInt8},      {"int8", NumberType::kInt8},       {"uchar", NumberType::kUint8},
      {"uint8", NumberType::kUint8},    {"short", NumberType::kInt16},     {"int16", NumberType::kInt16},
      {"ushort", NumberType::kUint16},  {"uint16", NumberType::kUint16},   {"int", NumberType::kInt32},
      {"int32", NumberType::kInt32},    {"uint", NumberType::kUint32},     {"uint32", NumberType::kUint32},
      {"float", NumberType::kFloat32},  {"float32", NumberType::kFloat32}, {"double", NumberType::kFloat64},
      {"float64", NumberType::kFloat64}};
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  return std::nullopt;
}

struct Property {
  std::string name;
  NumberType type = NumberType::kInt8;
  std::optional<NumberType> count;  // of a list: the type of its length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::size_t offset = 0;  // of its count, for errors
  std::vector<Property> properties;
};

class PlyParser {
 public:
  explicit PlyParser(MeshSource& source) : source_(source) {}

  TriangleMesh parse() {
    if (!read_header()) return {};
    source_.set_encoding(encoding_);
    for (const Element& element : elements_) {
      if (!read_element(element)) break;
    }
    return std::move(mesh_);
  }

 private:
  // --- header ---
  bool read_header() {
    if (source_.word() != "ply") return fail("the file does not begin with 'ply'", "save it as .ply");
    source_.line();
    bool has_format = false;
    while (true) {
      const std::string_view keyword = source_.word();
      if (keyword.empty()) {
        source_.error_at_end("'end_header'");
        return false;
      }
      if (keyword == "end_header") break;
      if (keyword == "format") {
        if (!read_format()) return false;
        has_format = true;
      } else if (keyword == "element") {
        if (!read_element_line()) return false;
      } else if (keyword == "property") {
        if (!read_property_line()) return false;
      } else if (keyword != "comment" && keyword != "obj_info") {
        return fail(fmt::format("{} in the header", quote_word(keyword)), "expected format, element or property");
      }
      source_.line();
    }
    source_.line();
    return has_format || fail("no format", "add 'format ascii 1.0' after the first line");
  }

  bool fail(std::string cause, std::string remedy) {
    source_.error(std::move(cause), std::move(remedy));
    return false;
  }

  bool read_format() {
    const std::string_view name = source_.word_of_line();
    if (name == "ascii") {
      encoding_ = MeshEncoding::kText;
    } else if (name == "binary_little_endian") {
      encoding_ = MeshEncoding::kLittleEndian;
    } else if (name == "binary_big_endian") {
      encoding_ = MeshEncoding::kBigEndian;
    } else {
      return fail(fmt::format("format {}", quote_word(name)), "use ascii, binary_little_endian or binary_big_endian");
    }
    return true;
  }

  bool read_element_line() {
    Element element;
    element.name = source_.word_of_line();
    if (!source_.read_count("elements", element.count)) return false;
    if (std::ranges::find(elements_, element.name, &Element::name) != elements_.end())
      return fail(fmt::format("element {} for the second time", quote_word(element.name)), "keep one");
    element.offset = source_.offset();
    elements_.push_back(std::move(element));
    return true;
  }

  bool read_property_line() {
    if (elements_.empty()) return fail("a property before any element", "an element line comes first");
    Property property;
    std::string_view type = source_.word_of_line();
    const bool is_list = type == "list";
    if (is_list) {
      const std::string_view count = source_.word_of_line();
      property.count = find_type(count);
      if (!property.count || *property.count >= NumberType::kFloat32)
        return fail(fmt::format("{} is no type of a list's length", quote_word(count)), "write uchar or int");
      type = source_.word_of_line();
    }
    const std::optional<NumberType> found = find_type(type);
    if (!found) return fail(fmt::format("{} is no type of numbers", quote_word(type)), "write float, int or uchar");
    property.type = *found;
    property.name = source_.word_of_line();
    elements_.back().properties.push_back(std::move(property));
    return true;
  }

  // --- body ---
  bool read_element(const Element& element) {
    std::size_t least = 0;
    for (const Property& property : element.properties)
      least += source_.least_size(property.count ? *property.count : property.type);
    if (least == 0) return true;  // nothing stands for it in the file
    if (!source_.can_hold(element.count, least, fmt::format("elements '{}'", element.name))) return false;
    if (element.name == "vertex") return read_vertices(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        const bool is_face =
            element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
        if (!(is_face || element.name == "tristrips" ? read_cell(property, is_face) : skip(property))) return false;
      }
    }
    return true;
  }

  bool read_vertices(const Element& element) {
    std::vector<int> axis_of;  // of each property; -1: none
    int found = 0;
    for (const Property& property : element.properties) {
      const std::size_t axis = std::string_view("xyz").find(property.name);
      const bool is_axis = property.name.size() == 1 && axis != std::string_view::npos && !property.count;
      axis_of.push_back(is_axis ? static_cast<int>(axis) : -1);
      if (is_axis) found |= 1 << axis;
    }
    if (found != 7) {
      source_.error_at(element.offset, "vertices without x, y and z", "add 'property float x' and so on");
      return false;
    }
    mesh_.positions.resize(element.count);
    for (glm::vec3& p : mesh_.positions) {
      for (std::size_t k = 0; k < axis_of.size(); ++k) {
        if (axis_of[k] < 0) {
          if (!skip(element.properties[k])) return false;
          continue;
        }
        if (!source_.read_coordinate(element.properties[k].type, p[axis_of[k]])) return false;
      }
    }
    return source_.reads_on();
  }

  // The length of a list; false when it isn't one that the file can hold.
  bool read_length(const Property& property, std::uint64_t& length) {
    double number = 0.0;
    if (!source_.read(*property.count, number)) return false;
    if (!(number >= 0.0 && number == std::floor(number) && number < 4294967295.0))
      return fail(fmt::format("{} as the length of a list", number), "write a whole number");
    length = static_cast<std::uint64_t>(number);
    return source_.can_hold(length, source_.least_size(property.type), "numbers of a list");
  }

  bool skip(const Property& property) {
    std::uint64_t length = 1;
    if (property.count && !read_length(property, length)) return false;
    return source_.skip(property.type, length);
  }

  // A polygon, or strips between which -1 stands.
  bool read_cell(const Property& property, bool is_face) {
    std::uint64_t length = 0;
    if (!property.count) return fail(fmt::format("'{}' is no list", property.name), "declare it as a list");
    if (!read_length(property, length)) return false;
    corners_.clear();
    for (std::uint64_t i = 0; i < length; ++i) {
      double number = 0.0;
      if (!source_.read(property.type, number)) return false;
      if (!is_face && number == -1.0) {
        add_strip(corners_, mesh_.indices);
        corners_.clear();
        continue;
      }
      corners_.push_back(source_.to_index(number, mesh_.positions.size(), "vertices"));
    }
    is_face ? add_polygon(corners_, mesh_.indices) : add_strip(corners_, mesh_.indices);
    return source_.reads_on();
  }

  MeshSource& source_;
  MeshEncoding encoding_ = MeshEncoding::kText;
  std::vector<Element> elements_;
  TriangleMesh mesh_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<TriangleMesh> parse_ply(std::string bytes, std::string file_name) {
  MeshSource source(std::move(bytes), std::move(file_name));
  TriangleMesh mesh = PlyParser(source).parse();
  return source.finish(std::move(mesh));
}

Result<TriangleMesh> read_ply(const std::filesystem::path& file) {
  Result<std::string> bytes = read_text_file(file);
  if (!bytes) return std::move(bytes.diagnostics());
  return parse_ply(std::move(*bytes), file.string());
}

}  // namespace fascicle
