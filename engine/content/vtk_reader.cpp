#include "engine/content/vtk_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "engine/content/file_text.hpp"
#include "engine/content/mesh_faces.hpp"
#include "engine/content/mesh_source.hpp"

namespace fascicle {
namespace {

std::string lower(std::string_view text) {
  std::string lowered(text);
  for (char& c : lowered) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lowered;
}

// `long` has eight bytes, as where such files are written; vtkIdType was always written as int.
std::optional<NumberType> find_type(std::string_view name) {
  static constexpr std::pair<std::string_view, NumberType> kTypes[] = {{"char", NumberType::kInt8},
                                                                       {"signed_char", NumberType::kInt8},
                                                                       {"unsigned_char", NumberType::kUint8},
                                                                       {"short", NumberType::kInt16},
                                                                       {"unsigned_short", NumberType::kUint16},
                                                                       {"int", NumberType::kInt32},
                                                                       {"unsigned_int", NumberType::kUint32},
                                                                       {"long", NumberType::kInt64},
                                                                       {"unsigned_long", NumberType::kUint64},
                                                                       {"vtktypeint64", NumberType::kInt64},
                                                                       {"vtktypeuint64", NumberType::kUint64},
                                                                       {"vtkidtype", NumberType::kInt32},
                                                                       {"float", NumberType::kFloat32},
                                                                       {"double", NumberType::kFloat64}};
  const std::string lowered = lower(name);
  for (const auto& [known, type] : kTypes) {
    if (known == lowered) return type;
  }
  return std::nullopt;
}

// Cells of one kind: the points of one after the other, and where each ends.
struct CellList {
  std::vector<std::uint32_t> points, ends;

  template <class F>
  void for_each(F f) const {
    std::size_t begin = 0;
    for (const std::uint32_t end : ends) {
      f(std::span(points).subspan(begin, end - begin));
      begin = end;
    }
  }
};

struct PolyData {
  std::vector<glm::vec3> positions;
  CellList vertices, lines, polygons, strips;
};

class VtkParser {
 public:
  explicit VtkParser(MeshSource& source) : source_(source) {}

  PolyData parse() {
    if (!read_header()) return {};
    while (source_.ok()) {
      const std::string keyword = lower(source_.word());
      if (keyword.empty() || keyword == "cell_data" || keyword == "point_data") break;  // these come last
      read_section(keyword);
    }
    return std::move(data_);
  }

 private:
  bool read_header() {
    const std::string_view first = source_.line();
    constexpr std::string_view kMagic = "# vtk datafile version ";
    if (!lower(first).starts_with(kMagic)) {
      source_.error("the first line is not '# vtk DataFile Version ...'", "save it as a legacy VTK file");
      return false;
    }
    const std::string_view version = first.substr(kMagic.size());
    std::from_chars(version.data(), version.data() + version.size(), version_);
    if (version_ < 1 || version_ > 5) {
      source_.error(fmt::format("version {}", quote_word(version)), "save it in a version from 1.0 to 5.1");
      return false;
    }
    source_.line();  // the title
    const std::string encoding = lower(source_.word());
    if (encoding != "ascii" && encoding != "binary") {
      source_.error(fmt::format("{} where the encoding should be", quote_word(encoding)), "write ASCII or BINARY");
      return false;
    }
    const std::string dataset = lower(source_.word());
    const std::string kind(dataset == "dataset" ? source_.word() : std::string_view(dataset));
    if (lower(kind) != "polydata") {
      source_.error(fmt::format("{} where DATASET POLYDATA should be", quote_word(kind)),
                    "save the surface as PolyData (in ParaView: Extract Surface)");
      return false;
    }
    if (encoding == "binary") source_.set_encoding(MeshEncoding::kBigEndian);
    is_binary_ = encoding == "binary";
    return true;
  }

  void read_section(const std::string& keyword) {
    if (keyword == "points") return read_points();
    if (keyword == "vertices") return read_cells(data_.vertices);
    if (keyword == "lines") return read_cells(data_.lines);
    if (keyword == "polygons") return read_cells(data_.polygons);
    if (keyword == "triangle_strips") return read_cells(data_.strips);
    if (keyword == "metadata") return skip_metadata();
    if (keyword == "field") return skip_field();
    source_.error(fmt::format("{} is no section of PolyData", quote_word(keyword)),
                  "expected POINTS, VERTICES, LINES, POLYGONS or TRIANGLE_STRIPS; does a count before it agree?");
  }

  // Arrays in binary begin after the line that announces them.
  void begin_array() {
    if (is_binary_) source_.line();
  }

  std::optional<NumberType> read_type() {
    const std::string_view name = source_.word_of_line();
    const std::optional<NumberType> type = find_type(name);
    if (!type) {
      source_.error(fmt::format("{} is no type of numbers that is read", quote_word(name)),
                    "write float, double, int or vtktypeint64");
    }
    return type;
  }

  void read_points() {
    std::uint64_t count = 0;
    if (!data_.positions.empty()) return source_.error("POINTS for the second time", "keep one");
    if (!source_.read_count("points", count)) return;
    if (!source_.can_hold(count, 3 * least_size(), "points")) return;
    const std::optional<NumberType> type = read_type();
    if (!type || !source_.can_hold(count, 3 * source_.least_size(*type), "points")) return;
    begin_array();
    data_.positions.resize(count);
    for (glm::vec3& p : data_.positions) {
      if (!source_.read_point(*type, p)) return;
    }
  }
  std::size_t least_size() const { return source_.least_size(NumberType::kInt8); }

  void read_cells(CellList& cells) {
    if (!cells.ends.empty()) return source_.error("cells of one kind for the second time", "keep one section of each");
    std::uint64_t count = 0, size = 0;
    if (!source_.read_count("cells", count) || !source_.can_hold(count, least_size(), "cells")) return;
    if (!source_.read_count("numbers", size) || !source_.can_hold(size, least_size(), "numbers")) return;
    return version_ < 5 ? read_counted_cells(count, size, cells) : read_offset_cells(count, size, cells);
  }

  // Up to version 4: each cell is the number of its points, then these; `size` numbers in all.
  void read_counted_cells(std::uint64_t count, std::uint64_t size, CellList& cells) {
    begin_array();
    std::uint64_t left = size;
    for (std::uint64_t i = 0; i < count; ++i) {
      std::uint32_t corners = 0;
      if (left == 0)
        return source_.error(fmt::format("{} of {} cells use up its {} numbers", i, count, size),
                             "correct the counts of the section");
      if (!source_.read_index(NumberType::kInt32, left, "numbers left in this section", corners)) return;
      for (std::uint32_t k = 0; k < corners; ++k) {
        std::uint32_t point = 0;
        if (!source_.read_index(NumberType::kInt32, data_.positions.size(), "points", point)) return;
        cells.points.push_back(point);
      }
      cells.ends.push_back(static_cast<std::uint32_t>(cells.points.size()));
      left -= corners + std::uint64_t{1};
    }
    if (left != 0)
      source_.error(fmt::format("{} cells leave {} of {} numbers over", count, left, size),
                    "correct the counts of the section");
  }

  // From version 5: where each cell begins and the last ends, then the points of all.
  void read_offset_cells(std::uint64_t offset_count, std::uint64_t size, CellList& cells) {
    if (offset_count == 0) return;
    std::vector<std::uint32_t> offsets;
    const auto read_array = [&](std::string_view name, std::uint64_t count, std::size_t below, std::string_view of_what,
                                std::vector<std::uint32_t>& numbers) {
      if (lower(source_.word()) != name) {
        source_.error(fmt::format("no {}", name), "cells of version 5 are OFFSETS, then CONNECTIVITY");
        return false;
      }
      const std::optional<NumberType> type = read_type();
      if (!type || !source_.can_hold(count, source_.least_size(*type), "numbers")) return false;
      begin_array();
      numbers.resize(count);
      return std::ranges::all_of(
          numbers, [&](std::uint32_t& number) { return source_.read_index(*type, below, of_what, number); });
    };
    if (!read_array("offsets", offset_count, size + 1, "offsets that the section allows", offsets)) return;
    if (offsets.front() != 0 || offsets.back() != size || !std::ranges::is_sorted(offsets)) {
      return source_.error(fmt::format("OFFSETS do not rise from 0 to {}", size), "correct them");
    }
    if (!read_array("connectivity", size, data_.positions.size(), "points", cells.points)) return;
    cells.ends.assign(offsets.begin() + 1, offsets.end());
  }

  // Ends with an empty line.
  void skip_metadata() {
    source_.line();
    while (source_.remaining() > 0) {
      if (source_.line().find_first_not_of(" \t") == std::string_view::npos) return;
    }
  }

  void skip_field() {
    source_.word_of_line();  // its name
    std::uint64_t arrays = 0;
    if (!source_.read_count("arrays", arrays)) return;
    for (std::uint64_t i = 0; i < arrays; ++i) {
      std::string_view name = source_.word();
      while (lower(name) == "metadata") {
        skip_metadata();
        name = source_.word();
      }
      if (name.empty()) return source_.error_at_end("an array of the field");
      std::uint64_t components = 0, tuples = 0;
      if (!source_.read_count("components", components) || !source_.read_count("tuples", tuples)) return;
      const std::optional<NumberType> type = read_type();
      if (!type) return;
      if (components != 0 && tuples > source_.remaining() / components) {
        return source_.error(fmt::format("{} times {} numbers do not fit into the file", tuples, components),
                             "correct the counts; is the file complete?");
      }
      begin_array();
      if (!source_.skip(*type, components * tuples)) return;
    }
  }

  MeshSource& source_;
  int version_ = 0;
  bool is_binary_ = false;
  PolyData data_;
};

}  // namespace

Result<TriangleMesh> parse_vtk(std::string bytes, std::string file_name) {
  MeshSource source(std::move(bytes), std::move(file_name));
  PolyData data = VtkParser(source).parse();
  TriangleMesh mesh;
  data.polygons.for_each([&](std::span<const std::uint32_t> cell) { add_polygon(cell, mesh.indices); });
  data.strips.for_each([&](std::span<const std::uint32_t> cell) { add_strip(cell, mesh.indices); });
  if (!data.lines.ends.empty()) source.warning("LINES are left out", "only polygons and strips make a surface");
  if (!data.vertices.ends.empty()) source.warning("VERTICES are left out", "only polygons and strips make a surface");
  mesh.positions = std::move(data.positions);
  return source.finish(std::move(mesh));
}

Result<PolylineSet> parse_polylines(std::string bytes, std::string file_name) {
  MeshSource source(std::move(bytes), std::move(file_name));
  PolyData data = VtkParser(source).parse();
  if (source.ok() && data.lines.ends.empty()) source.error("no LINES", "is it a file of lines?");
  if (!source.ok()) return std::move(source.diagnostics());
  if (!data.polygons.ends.empty() || !data.strips.ends.empty())
    source.warning("polygons are left out", "only LINES are read");
  return {PolylineSet{std::move(data.positions), std::move(data.lines.points), std::move(data.lines.ends)},
          std::move(source.diagnostics())};
}

Result<TriangleMesh> read_vtk(const std::filesystem::path& file) {
  Result<std::string> bytes = read_text_file(file);
  if (!bytes) return std::move(bytes.diagnostics());
  return parse_vtk(std::move(*bytes), file.string());
}

Result<PolylineSet> read_polylines(const std::filesystem::path& file) {
  Result<std::string> bytes = read_text_file(file);
  if (!bytes) return std::move(bytes.diagnostics());
  return parse_polylines(std::move(*bytes), file.string());
}

}  // namespace fascicle
