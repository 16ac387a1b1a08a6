#include "engine/content/obj_reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <vector>

#include "engine/content/file_text.hpp"
#include "engine/content/mesh_faces.hpp"
#include "engine/content/mesh_source.hpp"

namespace fascicle {
namespace {

class ObjParser {
 public:
  explicit ObjParser(MeshSource& source) : source_(source) {}

  TriangleMesh parse() {
    while (source_.remaining() > 0 && source_.reads_on()) {
      const std::string_view keyword = source_.word_of_line();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f" || keyword == "fo") {
        read_face();
      } else if (keyword == "curv" || keyword == "surf" || keyword == "curv2") {
        source_.warning("curves and curved surfaces are left out", "save the mesh as polygons");
      }
      skip_rest();
    }
    return std::move(mesh_);
  }

 private:
  // The next word of a line, which a backslash at its end carries on.
  std::string_view next_word() {
    std::string_view word = source_.word_of_line();
    while (word == "\\") {
      source_.line();
      word = source_.word_of_line();
    }
    return word;
  }
  void skip_rest() {
    while (source_.line().ends_with('\\')) {
    }
  }

  void read_vertex() {
    glm::vec3 p(0.0f);
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = next_word();
      double number = 0.0;
      if (word.empty()) {
        source_.error(fmt::format("a vertex with {} coordinates", k), "write v X Y Z");
        break;
      }
      std::string_view fault = parse_number(word, number);
      if (fault.empty() && !fits_float(number)) fault = "is not finite";
      if (!fault.empty()) source_.error(fmt::format("{} {}", quote_word(word), fault), "write v X Y Z");
      p[k] = fault.empty() ? static_cast<float>(number) : 0.0f;
    }
    mesh_.positions.push_back(p);
  }

  void read_face() {
    corners_.clear();
    bool good = true;
    for (std::string_view word = next_word(); !word.empty() && word[0] != '#'; word = next_word())
      good = read_corner(word) && good;
    if (good && corners_.size() < 3)
      source_.error(fmt::format("a face with {} corners", corners_.size()), "a face has three or more");
    if (good) add_polygon(corners_, mesh_.indices);
  }

  // V, V/T, V//N or V/T/N, of which V counts: from 1, or backwards from the latest vertex.
  bool read_corner(std::string_view word) {
    const std::string_view number = word.substr(0, word.find('/'));
    const auto count = static_cast<std::int64_t>(mesh_.positions.size());
    std::int64_t index = 0;
    const auto [rest, code] = std::from_chars(number.data(), number.data() + number.size(), index);
    if (code == std::errc::invalid_argument || rest != number.data() + number.size()) {
      source_.error(fmt::format("{} is not the number of a vertex", quote_word(word)), "write V, V/T, V//N or V/T/N");
      return false;
    }
    if (code != std::errc() || index == 0 || index > count || index < -count) {
      source_.error(fmt::format("{}, but {} vertices stand before it", quote_word(number), count),
                    "vertices count from 1, or backwards from -1");
      return false;
    }
    corners_.push_back(static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index));
    return true;
  }

  MeshSource& source_;
  TriangleMesh mesh_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<TriangleMesh> parse_obj(std::string text, std::string file_name) {
  MeshSource source(std::move(text), std::move(file_name));
  TriangleMesh mesh = ObjParser(source).parse();
  return source.finish(std::move(mesh));
}

Result<TriangleMesh> read_obj(const std::filesystem::path& file) {
  Result<std::string> text = read_text_file(file);
  if (!text) return std::move(text.diagnostics());
  return parse_obj(std::move(*text), file.string());
}

}  // namespace fascicle
