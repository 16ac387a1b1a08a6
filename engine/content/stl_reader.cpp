#include "engine/content/stl_reader.hpp"

#include <fmt/format.h>

#include <vector>

#include "engine/content/file_text.hpp"
#include "engine/content/mesh_faces.hpp"
#include "engine/content/mesh_source.hpp"

namespace fascicle {
namespace {

constexpr std::size_t kHeader = 80, kCount = 4, kFacet = 50;  // bytes

bool equal_words(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if ((word[i] | 0x20) != lower[i]) return false;
  }
  return true;
}

class StlParser {
 public:
  explicit StlParser(MeshSource& source) : source_(source) {}

  TriangleMesh parse() {
    const std::size_t size = source_.bytes().size();
    double facets = 0.0;
    if (size >= kHeader + kCount) {
      facets = decode_number(NumberType::kUint32, std::endian::little, source_.bytes().data() + kHeader);
      if (static_cast<double>(size - kHeader - kCount) == facets * kFacet) {
        read_binary();
        return std::move(mesh_);
      }
    }
    if (equal_words(source_.word(), "solid")) {
      read_text();
    } else {
      source_.set_encoding(MeshEncoding::kLittleEndian);
      if (size < kHeader + kCount) {
        source_.error_at(size, fmt::format("{} bytes are no .stl", size), "is it complete?");
      } else {
        source_.error_at(kHeader,
                         fmt::format("{} triangles take {} bytes, but the file has {}", facets,
                                     kHeader + kCount + kFacet * static_cast<std::uint64_t>(facets), size),
                         "is it complete? An ASCII file begins with 'solid'");
      }
    }
    return std::move(mesh_);
  }

 private:
  void read_binary() {
    source_.set_encoding(MeshEncoding::kLittleEndian);
    for (std::size_t facet = kHeader + kCount; facet < source_.bytes().size(); facet += kFacet) {
      source_.seek(facet + 3 * sizeof(float));  // after the normal
      for (int k = 0; k < 3; ++k) {
        glm::vec3 p;
        if (!source_.read_point(NumberType::kFloat32, p)) return;
        add_corner(p);
      }
      add_facet();
    }
  }

  void read_text() {
    source_.line();  // its name
    while (source_.reads_on()) {
      const std::string_view word = source_.word();
      if (word.empty()) return source_.error_at_end("'facet' or 'endsolid'");
      if (equal_words(word, "facet")) {
        source_.line();  // its normal
        if (!read_facet()) return;
      } else if (equal_words(word, "endsolid")) {
        source_.line();
        if (source_.word().empty()) return;
        source_.line();  // the next one's name
      } else {
        return source_.error(fmt::format("{} where 'facet' or 'endsolid' should be", quote_word(word)),
                             "see the lines before it");
      }
    }
  }

  bool read_facet() {
    if (!expect("outer") || !expect("loop")) return false;
    for (std::string_view word = source_.word(); !equal_words(word, "endloop"); word = source_.word()) {
      if (!equal_words(word, "vertex")) return expected(word, "'vertex' or 'endloop'");
      glm::vec3 p;
      if (!source_.read_point(NumberType::kFloat32, p)) return false;
      add_corner(p);
    }
    if (corners_.size() < 3) {
      source_.error(fmt::format("a facet with {} corners", corners_.size()), "a facet has three");
      corners_.clear();
    }
    add_facet();
    return expect("endfacet") && source_.reads_on();
  }

  bool expect(std::string_view wanted) {
    const std::string_view word = source_.word();
    return equal_words(word, wanted) || expected(word, fmt::format("'{}'", wanted));
  }
  bool expected(std::string_view word, const std::string& wanted) {
    if (word.empty()) {
      source_.error_at_end(wanted);
    } else {
      source_.error(fmt::format("{} where {} should be", quote_word(word), wanted), "see the lines before it");
    }
    return false;
  }

  void add_corner(const glm::vec3& p) {
    corners_.push_back(static_cast<std::uint32_t>(mesh_.positions.size()));
    mesh_.positions.push_back(p);
  }
  void add_facet() {
    add_polygon(corners_, mesh_.indices);
    corners_.clear();
  }

  MeshSource& source_;
  TriangleMesh mesh_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<TriangleMesh> parse_stl(std::string bytes, std::string file_name) {
  MeshSource source(std::move(bytes), std::move(file_name));
  TriangleMesh mesh = StlParser(source).parse();
  return source.finish(std::move(mesh));
}

Result<TriangleMesh> read_stl(const std::filesystem::path& file) {
  Result<std::string> bytes = read_text_file(file);
  if (!bytes) return std::move(bytes.diagnostics());
  return parse_stl(std::move(*bytes), file.string());
}

}  // namespace fascicle
