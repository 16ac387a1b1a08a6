#include "engine/content/vtp_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>

#include <glm/geometric.hpp>
#include <pugixml.hpp>

#include "engine/content/file_text.hpp"
#include "engine/content/limit_errors.hpp"
#include "engine/content/mesh_faces.hpp"
#include "engine/content/mesh_source.hpp"
#include "engine/content/number_type.hpp"
#include "engine/content/text_position.hpp"
#include "engine/content/vtp_encoding.hpp"

namespace fascicle {
namespace {

constexpr std::size_t kMaxErrors = 20;
constexpr std::size_t kMaxGrowth = 64;  // arrays may name the same bytes over and over, or hardly any packed ones
constexpr std::size_t kMaxPoints = 0xfffffffe;

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

std::optional<NumberType> find_type(std::string_view name) {
  static constexpr std::string_view kNames[] = {"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                                "UInt32", "Int64", "UInt64", "Float32", "Float64"};
  const auto found = std::ranges::find(kNames, name);
  if (found == std::end(kNames)) return std::nullopt;
  return static_cast<NumberType>(found - std::begin(kNames));  // in the order of the types
}

class VtpParser {
 public:
  VtpParser(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {
    encoding_.max_bytes = kMaxGrowth * text_.size();
    cut_appended_data();
    lines_ = LineTable(text_);
  }

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
  // What follows the _ in <AppendedData> may be any bytes: it is kept apart, and the XML is closed without it.
  void cut_appended_data() {
    const std::size_t element = text_.find("<AppendedData");
    const std::size_t end = text_.find('>', element);
    if (element == std::string::npos || end == std::string::npos || text_[end - 1] == '/') return;
    const std::size_t mark = text_.find_first_not_of(" \n\r\t", end + 1);
    if (mark == std::string::npos || text_[mark] != '_') return;
    appended_ = text_.substr(mark + 1);
    text_.resize(end + 1);
    text_ += "</AppendedData></VTKFile>";
  }

  void read_document() {
    pugi::xml_document document;
    // Character references and line ends stay as they are, so that offsets into values are offsets into the file.
    const pugi::xml_parse_result parsed = document.load_buffer(
        text_.data(), text_.size(), pugi::parse_cdata | pugi::parse_wconv_attribute, pugi::encoding_utf8);
    if (!parsed) {
      add(diagnostics_.errors, static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)), "",
          fmt::format("not XML: {}", parsed.description()), "save it as VTK PolyData in XML (.vtp)");
      return;
    }
    const pugi::xml_node root = document.child("VTKFile");
    if (!root)
      return error(document.first_child(), -1, "no <VTKFile> element", "save it as VTK PolyData in XML (.vtp)");
    if (const std::string_view type = root.attribute("type").value(); type != "PolyData") {
      return error(root, -1, fmt::format("type is \"{}\"", type), "save it as type=\"PolyData\"");
    }
    if (!read_encoding(root)) return;
    const pugi::xml_node data = root.child("PolyData");
    if (!data) return error(root, -1, "no <PolyData> element", "add it; is the file complete?");
    if (!data.child("Piece")) return error(data, -1, "no <Piece> element", "add it; is the file complete?");
    bool all_have_normals = true;
    for (const pugi::xml_node piece : data.children("Piece")) all_have_normals = read_piece(piece) && all_have_normals;
    if (!all_have_normals) mesh_.normals.clear();
    if (diagnostics_.ok() && mesh_.indices.empty()) error(data, -1, "no polygons", "is it a surface mesh?");
  }

  bool read_encoding(pugi::xml_node root) {
    const std::string_view order = root.attribute("byte_order").value(), header = root.attribute("header_type").value();
    const std::string_view compressor = root.attribute("compressor").value();
    if (order == "BigEndian") encoding_.order = std::endian::big;
    if (header == "UInt64") encoding_.header = NumberType::kUint64;
    encoding_.compressed = compressor == "vtkZLibDataCompressor";
    appended_is_base64_ = root.child("AppendedData").attribute("encoding").value() == std::string_view("base64");
    if (compressor.empty() || encoding_.compressed) return true;
    error(root, -1, fmt::format("compressor is \"{}\"", compressor), "save it compressed with zlib, or not at all");
    return false;
  }

  // Whether the piece gives normals.
  bool read_piece(pugi::xml_node piece) {
    const std::size_t first = mesh_.positions.size();
    const pugi::xml_node points = piece.child("Points").child("DataArray");
    if (!points) {
      error(piece, -1, "no <Points> with a <DataArray>", "add the points");
      return false;
    }
    if (!read_vectors(points, mesh_.positions)) return false;
    check_count(piece, "NumberOfPoints", mesh_.positions.size() - first);
    const std::size_t count = mesh_.positions.size() - first;
    if (mesh_.positions.size() > kMaxPoints) error(points, -1, "too many points", "split the mesh");
    const bool has_normals = read_normals(piece, count);
    read_cells(piece, "Polys", "NumberOfPolys", first, count);
    read_cells(piece, "Strips", "NumberOfStrips", first, count);
    for (const char* name : {"Lines", "Verts"}) {
      const pugi::xml_node array = piece.child(name).find_child_by_attribute("DataArray", "Name", "connectivity");
      const pugi::xml_attribute given = piece.attribute(fmt::format("NumberOf{}", name).c_str());
      if (given ? given.value() != std::string_view("0") : skip_space(array.child_value()) != nullptr)
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
      const std::span<std::uint32_t> cell = std::span(points).subspan(begin, ends[i] - begin);
      for (std::uint32_t& point : cell) point += static_cast<std::uint32_t>(first);
      name[0] == 'S' ? add_strip(cell, mesh_.indices) : add_polygon(cell, mesh_.indices);
      begin = ends[i];
    }
    if (begin != points.size()) {
      error(offsets, -1, fmt::format("the last offset is {}, but connectivity has {} entries", begin, points.size()),
            "correct the last offset");
    }
  }

  // --- arrays ---
  // The text of an array, beside which VTK writes what it knows about the array in elements; nothing after an error.
  std::optional<pugi::xml_node> text_of(pugi::xml_node array) {
    pugi::xml_node text;
    for (const pugi::xml_node child : array.children()) {
      if (child.type() == pugi::node_element && child.name() == std::string_view("InformationKey")) continue;
      if (child.type() == pugi::node_element || text) {
        error(array, -1, "elements inside an array", "an array holds numbers only");
        return std::nullopt;
      }
      text = child;
    }
    return text;
  }

  static const char* skip_space(const char* at) {
    while (is_space(*at)) ++at;
    return *at == '\0' ? nullptr : at;
  }

  // Calls take(number) for each number; false after an error, which `take` may cause by returning what is wrong.
  template <class Take>
  bool read_numbers(pugi::xml_node array, std::string_view wanted, Take take) {
    const std::string_view format = array.attribute("format").value();
    if (format == "binary" || format == "appended") return read_encoded(array, wanted, take);
    if (!format.empty() && format != "ascii") {
      error(array, -1, fmt::format("format is \"{}\"", format), "save it as ascii, binary or appended");
      return false;
    }
    const std::optional<pugi::xml_node> text = text_of(array);
    if (!text) return false;
    const char* const begin = text->value();
    const std::ptrdiff_t offset = std::max<std::ptrdiff_t>(text->offset_debug(), 0);
    for (const char* at = skip_space(begin); at != nullptr;) {
      const char* end = at;
      while (*end != '\0' && !is_space(*end)) ++end;
      const std::string_view word(at, static_cast<std::size_t>(end - at));
      double number = 0.0;
      const std::string_view fault = parse_number(word, number);
      std::string cause = fault.empty() ? take(number) : fmt::format("{} {}", quote_word(word), fault);
      if (!cause.empty()) {
        error(array, offset + (at - begin), std::move(cause), fmt::format("write {}", wanted));
        return false;
      }
      at = skip_space(end);
    }
    return true;
  }

  template <class Take>
  bool read_encoded(pugi::xml_node array, std::string_view wanted, Take take) {
    const std::optional<NumberType> type = find_type(array.attribute("type").value());
    if (!type) {
      error(array, -1, fmt::format("type is \"{}\"", array.attribute("type").value()),
            "name one of VTK's types of numbers, such as Float32");
      return false;
    }
    const std::optional<pugi::xml_node> text = text_of(array);
    if (!text) return false;
    const VtpArray decoded = decode(array, *text);
    const std::size_t size = byte_size(*type), count = decoded.bytes.size() / size;
    if (!decoded.fault.empty()) {
      error(array, -1, decoded.fault, "is the file complete?");
      return false;
    }
    if (decoded.bytes.size() > encoding_.max_bytes) {
      error(array, -1, fmt::format("arrays over {} times as large as the file", kMaxGrowth), "split the mesh");
      return false;
    }
    encoding_.max_bytes -= decoded.bytes.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::string cause = take(decode_number(*type, encoding_.order, decoded.bytes.data() + i * size));
      if (cause.empty()) continue;
      error(array, -1, fmt::format("value {}: {}", i, cause), fmt::format("write {}", wanted));
      return false;
    }
    return true;
  }

  VtpArray decode(pugi::xml_node array, pugi::xml_node text) const {
    if (array.attribute("format").value() == std::string_view("binary")) {
      std::string digits = text.value();
      std::erase_if(digits, is_space);
      return decode_vtp_base64(digits, encoding_);
    }
    const std::string_view given = array.attribute("offset").value();
    std::uint64_t offset = 0;
    const auto [rest, code] = std::from_chars(given.data(), given.data() + given.size(), offset);
    if (code != std::errc() || rest != given.data() + given.size() || offset > appended_.size())
      return {{}, fmt::format("offset \"{}\" into {} bytes of AppendedData", given, appended_.size())};
    const std::string_view data = std::string_view(appended_).substr(offset);
    return appended_is_base64_ ? decode_vtp_base64(data, encoding_) : decode_vtp_raw(data, encoding_);
  }

  bool read_vectors(pugi::xml_node array, std::vector<glm::vec3>& out) {
    if (const pugi::xml_attribute components = array.attribute("NumberOfComponents");
        components && std::strcmp(components.value(), "3") != 0) {
      error(array, -1, fmt::format("NumberOfComponents is \"{}\"", components.value()), "points and normals have 3");
      return false;
    }
    glm::vec3 vector{0.0f};
    int filled = 0;
    const bool ok = read_numbers(array, "a finite number", [&](double number) -> std::string {
      if (!std::isfinite(number)) return fmt::format("{} is not finite", number);
      if (!fits_float(number)) return fmt::format("{} is out of range", number);
      vector[filled++] = static_cast<float>(number);
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
    return read_numbers(array, fmt::format("a whole number from 0 to {}", max), [&](double number) -> std::string {
      if (!(number >= 0.0 && number <= static_cast<double>(max))) return fmt::format("{} is out of range", number);
      if (number != std::floor(number)) return fmt::format("{} is not a whole number", number);
      out.push_back(static_cast<std::uint32_t>(number));
      return {};
    });
  }

  std::string text_;      // without the appended data
  std::string appended_;  // what follows the _ in <AppendedData>
  std::string file_;
  VtpEncoding encoding_;
  bool appended_is_base64_ = false;
  LineTable lines_;
  TriangleMesh mesh_;
  Diagnostics diagnostics_;
};

}  // namespace

Result<TriangleMesh> parse_vtp(std::string text, std::string file_name) {
  return VtpParser(std::move(text), std::move(file_name)).parse();
}

Result<TriangleMesh> read_vtp(const std::filesystem::path& file) {
  Result<std::string> text = read_text_file(file);
  if (!text) return std::move(text.diagnostics());
  return parse_vtp(std::move(*text), file.string());
}

}  // namespace fascicle
