#include "engine/content/vtp_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string_view>
#include <type_traits>

#include <glm/geometric.hpp>
#include <pugixml.hpp>

#include "engine/content/file_text.hpp"
#include "engine/content/limit_errors.hpp"
#include "engine/content/text_position.hpp"

namespace fascicle {
namespace {

constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{512} << 20;
constexpr std::size_t kMaxErrors = 20;
constexpr std::size_t kMaxPoints = 0xfffffffe;

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

class VtpParser {
 public:
  VtpParser(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)), lines_(text_) {}

  Result<TriangleMesh> parse() {
    read_document();
    if (!diagnostics_.ok()) return std::move(diagnostics_);
    mesh_.name = std::filesystem::path(file_).stem().string();
    return {std::move(mesh_), std::move(diagnostics_)};
  }

 private:
  // --- errors ---
  void add(std::vector<Diagnostic>& list, std::size_t offset, std::string path, std::string cause, std::string remedy) {
    if (!has_room(list, kMaxErrors, file_)) return;
    const TextPosition at = lines_.position(text_, offset);
    list.push_back({file_, at.line, at.column, std::move(path), std::move(cause), std::move(remedy)});
  }
  // `offset` into the text, or -1 for the start of the element.
  void error(pugi::xml_node node, std::ptrdiff_t offset, std::string cause, std::string remedy) {
    add(diagnostics_.errors,
        static_cast<std::size_t>(offset >= 0 ? offset : std::max<std::ptrdiff_t>(node.offset_debug(), 0)),
        path_of(node), std::move(cause), std::move(remedy));
  }
  void warning(pugi::xml_node node, std::string cause, std::string remedy) {
    add(diagnostics_.warnings, static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)),
        path_of(node), std::move(cause), std::move(remedy));
  }
  static std::string path_of(pugi::xml_node node) {
    std::string path = node.path();
    if (const pugi::xml_attribute name = node.attribute("Name")) path += fmt::format("[@Name='{}']", name.value());
    return path;
  }

  // --- structure ---
  void read_document() {
    pugi::xml_document document;
    // Character references and line ends stay as they are, so that offsets into values are offsets into the file.
    const pugi::xml_parse_result parsed = document.load_buffer(
        text_.data(), text_.size(), pugi::parse_cdata | pugi::parse_wconv_attribute, pugi::encoding_utf8);
    if (!parsed) {
      add(diagnostics_.errors, static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)), "",
          fmt::format("not XML: {}", parsed.description()), "save it as VTK PolyData in XML (.vtp), ASCII");
      return;
    }
    const pugi::xml_node root = document.child("VTKFile");
    if (!root)
      return error(document.first_child(), -1, "no <VTKFile> element", "save it as VTK PolyData in XML (.vtp), ASCII");
    if (const std::string_view type = root.attribute("type").value(); type != "PolyData") {
      return error(root, -1, fmt::format("type is \"{}\"", type), "save it as type=\"PolyData\"");
    }
    const pugi::xml_node data = root.child("PolyData");
    if (!data) return error(root, -1, "no <PolyData> element", "add it; is the file complete?");
    if (!data.child("Piece")) return error(data, -1, "no <Piece> element", "add it; is the file complete?");
    bool all_have_normals = true;
    for (const pugi::xml_node piece : data.children("Piece")) all_have_normals = read_piece(piece) && all_have_normals;
    if (!all_have_normals) mesh_.normals.clear();
    if (diagnostics_.ok() && mesh_.indices.empty()) error(data, -1, "no polygons", "is it a surface mesh?");
  }

  // Whether the piece gives normals.
  bool read_piece(pugi::xml_node piece) {
    const std::size_t first = mesh_.positions.size();
    const pugi::xml_node points = piece.child("Points").child("DataArray");
    if (!points) {
      error(piece, -1, "no <Points> with a <DataArray>", "add the points");
      return false;
    }
    if (read_vectors(points, mesh_.positions)) check_count(piece, "NumberOfPoints", mesh_.positions.size() - first);
    const std::size_t count = mesh_.positions.size() - first;
    if (mesh_.positions.size() > kMaxPoints) error(points, -1, "too many points", "split the mesh");
    const bool has_normals = read_normals(piece, count);
    read_cells(piece, "Polys", "NumberOfPolys", first, count);
    read_cells(piece, "Strips", "NumberOfStrips", first, count);
    for (const char* name : {"Lines", "Verts"}) {
      const pugi::xml_node array = piece.child(name).find_child_by_attribute("DataArray", "Name", "connectivity");
      if (skip_space(array.child_value()) != nullptr)
        warning(piece.child(name), "ignored", "only polygons and strips are read");
    }
    return has_normals;
  }

  void check_count(pugi::xml_node piece, const char* attribute, std::size_t found) {
    const pugi::xml_attribute given = piece.attribute(attribute);
    if (!given || given.value() == std::to_string(found)) return;
    error(piece, -1, fmt::format("{} is \"{}\", but {} are there", attribute, given.value(), found),
          "correct the count; is the file complete?");
  }

  bool read_normals(pugi::xml_node piece, std::size_t count) {
    const pugi::xml_node data = piece.child("PointData");
    pugi::xml_node array;
    if (const pugi::xml_attribute name = data.attribute("Normals"))
      array = data.find_child_by_attribute("DataArray", "Name", name.value());
    if (!array) array = data.find_child_by_attribute("DataArray", "Name", "Normals");
    if (!array) return false;
    const std::size_t first = mesh_.normals.size();
    if (!read_vectors(array, mesh_.normals)) return false;
    if (mesh_.normals.size() - first != count) {
      error(array, -1, fmt::format("{} normals for {} points", mesh_.normals.size() - first, count),
            "give one normal a point, or none");
      return false;
    }
    for (std::size_t i = first; i < mesh_.normals.size(); ++i) {
      const float length = glm::length(mesh_.normals[i]);
      if (!(length > 0.0f && std::isfinite(length))) {
        error(array, -1, fmt::format("normal {} has length {}", i - first, length), "give unit normals, or none");
        return false;
      }
      mesh_.normals[i] /= length;
    }
    return true;
  }

  void read_cells(pugi::xml_node piece, const char* name, const char* count_attribute, std::size_t first,
                  std::size_t point_count) {
    const pugi::xml_node cells = piece.child(name);
    const pugi::xml_node connectivity = cells.find_child_by_attribute("DataArray", "Name", "connectivity");
    const pugi::xml_node offsets = cells.find_child_by_attribute("DataArray", "Name", "offsets");
    if (!connectivity && !offsets) return check_count(piece, count_attribute, 0);
    if (!connectivity || !offsets) {
      return error(cells, -1, fmt::format("no DataArray \"{}\"", connectivity ? "offsets" : "connectivity"), "add it");
    }
    std::vector<std::uint32_t> points, ends;
    const bool ok = read_integers(connectivity, point_count == 0 ? 0 : point_count - 1, points);
    if (!(read_integers(offsets, kMaxPoints, ends) && ok)) return;
    check_count(piece, count_attribute, ends.size());
    std::size_t begin = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (ends[i] < begin || ends[i] > points.size()) {
        return error(
            offsets, -1,
            fmt::format("offset {} is {}, after {} with {} entries in connectivity", i, ends[i], begin, points.size()),
            "offsets rise and end with the number of entries");
      }
      add_cell(std::span(points).subspan(begin, ends[i] - begin), first, name[0] == 'S');
      begin = ends[i];
    }
    if (begin != points.size()) {
      error(offsets, -1, fmt::format("the last offset is {}, but connectivity has {} entries", begin, points.size()),
            "correct the last offset");
    }
  }

  void add_cell(std::span<const std::uint32_t> points, std::size_t first, bool strip) {
    for (std::size_t k = 2; k < points.size(); ++k) {
      const bool odd = strip && k % 2 == 1;
      const std::uint32_t a = strip ? points[k - 2] : points[0], b = points[k - 1], c = points[k];
      if (a == b || b == c || c == a) continue;  // strips turn corners by such triangles
      for (const std::uint32_t p : {odd ? b : a, odd ? a : b, c})
        mesh_.indices.push_back(static_cast<std::uint32_t>(first + p));
    }
  }

  // --- arrays ---
  // The ASCII text of an array; nullptr after an error.
  const char* text_of(pugi::xml_node array) {
    const std::string_view format = array.attribute("format").value();
    if (!format.empty() && format != "ascii") {
      error(array, -1, fmt::format("format is \"{}\"", format), "save the file as ASCII");
      return nullptr;
    }
    if (array.first_child() != array.last_child() || array.first_child().type() == pugi::node_element) {
      error(array, -1, "elements inside an array", "an array holds numbers only");
      return nullptr;
    }
    return array.child_value();
  }

  static const char* skip_space(const char* at) {
    while (is_space(*at)) ++at;
    return *at == '\0' ? nullptr : at;
  }

  // Calls take(value) for each number; false after an error, which `take` may cause by returning what is wrong.
  template <class Number, class Take>
  bool read_numbers(pugi::xml_node array, std::string_view wanted, Take take) {
    const char* const begin = text_of(array);
    if (begin == nullptr) return false;
    const std::ptrdiff_t offset = std::max<std::ptrdiff_t>(array.first_child().offset_debug(), 0);
    for (const char* at = skip_space(begin); at != nullptr;) {
      const char* end = at;
      while (*end != '\0' && !is_space(*end)) ++end;
      Number number{};
      const auto [rest, code] = std::from_chars(at, end, number);
      std::string cause;
      if (rest != end || code == std::errc::invalid_argument) {
        cause =
            fmt::format("'{}' is not {}",
                        std::string_view(at, std::min<std::size_t>(static_cast<std::size_t>(end - at), 32)), wanted);
      } else if (code == std::errc::result_out_of_range && !(std::is_floating_point_v<Number> && is_tiny(at, end))) {
        cause = fmt::format("'{}' is out of range",
                            std::string_view(at, std::min<std::size_t>(static_cast<std::size_t>(end - at), 32)));
      } else {
        cause = take(number);
      }
      if (!cause.empty()) {
        error(array, offset + (at - begin), std::move(cause), fmt::format("write {}", wanted));
        return false;
      }
      at = skip_space(end);
    }
    return true;
  }

  // A denormal number, which from_chars refuses for float, is zero to us.
  static bool is_tiny(const char* begin, const char* end) {
    double number = 1.0;
    return std::from_chars(begin, end, number).ec == std::errc() && std::abs(number) < 1.0;
  }

  bool read_vectors(pugi::xml_node array, std::vector<glm::vec3>& out) {
    if (const pugi::xml_attribute components = array.attribute("NumberOfComponents");
        components && std::strcmp(components.value(), "3") != 0) {
      error(array, -1, fmt::format("NumberOfComponents is \"{}\"", components.value()), "points and normals have 3");
      return false;
    }
    glm::vec3 vector{0.0f};
    int filled = 0;
    const bool ok = read_numbers<float>(array, "a finite number", [&](float number) -> std::string {
      if (!std::isfinite(number)) return fmt::format("{} is not finite", number);
      vector[filled++] = number;
      if (filled == 3) {
        out.push_back(vector);
        filled = 0;
      }
      return {};
    });
    if (ok && filled != 0)
      error(array, -1, "the number of values is not a multiple of 3",
            "write x, y and z for each; is the file complete?");
    return ok && filled == 0;
  }

  bool read_integers(pugi::xml_node array, std::size_t max, std::vector<std::uint32_t>& out) {
    return read_numbers<std::int64_t>(array, fmt::format("a whole number from 0 to {}", max),
                                      [&](std::int64_t number) -> std::string {
                                        if (number < 0 || static_cast<std::uint64_t>(number) > max)
                                          return fmt::format("{} is out of range", number);
                                        out.push_back(static_cast<std::uint32_t>(number));
                                        return {};
                                      });
  }

  std::string text_;
  std::string file_;
  LineTable lines_;
  TriangleMesh mesh_;
  Diagnostics diagnostics_;
};

}  // namespace

Result<TriangleMesh> parse_vtp(std::string text, std::string file_name) {
  return VtpParser(std::move(text), std::move(file_name)).parse();
}

Result<TriangleMesh> read_vtp(const std::filesystem::path& file) {
  Result<std::string> text = read_text_file(file, kMaxFileBytes);
  if (!text) return std::move(text.diagnostics());
  return parse_vtp(std::move(*text), file.string());
}

}  // namespace fascicle
