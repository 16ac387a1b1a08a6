// A mesh file's bytes, read from front to back as lines, words and numbers, in text or binary, with the place of each
// for errors. What .vtk, .obj, .ply and .stl files have in common. Nothing is read past the end, and a count that a
// header promises is held against the bytes that are left before anybody allocates for it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "engine/content/number_type.hpp"
#include "engine/content/result.hpp"
#include "engine/content/triangle_mesh.hpp"

namespace fascicle {

enum class MeshEncoding : std::uint8_t { kText, kLittleEndian, kBigEndian };

class MeshSource {
 public:
  MeshSource(std::string bytes, std::string file) : bytes_(std::move(bytes)), file_(std::move(file)) {}

  std::string_view bytes() const { return bytes_; }
  std::size_t offset() const { return at_; }
  std::size_t remaining() const { return bytes_.size() - at_; }
  void seek(std::size_t offset) { at_ = last_ = offset; }  // at most the size

  // How numbers are read, and whether errors name a line or a byte.
  void set_encoding(MeshEncoding encoding) { encoding_ = encoding; }

  // The next word, on whatever line; empty at the end of the file.
  std::string_view word();
  // The next word on this line; empty at its end.
  std::string_view word_of_line();
  // What is left of this line, without its end. Reading goes on at the next.
  std::string_view line();

  // The next number; false after an error. Errors about a value leave 0 and are no reason to stop: false means that the
  // file has ended, or that enough errors were told.
  bool read(NumberType type, double& number);
  // A finite number; three of them.
  bool read_coordinate(NumberType type, float& coordinate);
  bool read_point(NumberType type, glm::vec3& point);
  // A whole number from 0 to `count` - 1, for something of which there are `count`.
  bool read_index(NumberType type, std::size_t count, std::string_view of_what, std::uint32_t& index);
  // The same for a number that was read already: an error, and 0, where it is none of these.
  std::uint32_t to_index(double number, std::size_t count, std::string_view of_what);
  // A whole number on this line that a text header gives as a count. Always in text.
  bool read_count(std::string_view of_what, std::uint64_t& count);
  // Leaves out `count` numbers.
  bool skip(NumberType type, std::uint64_t count);
  // Whether the file can hold `count` things of at least `size` bytes from here on. If not, an error at what was read
  // last.
  bool can_hold(std::uint64_t count, std::size_t size, std::string_view of_what);
  // Bytes that a number takes at least.
  std::size_t least_size(NumberType type) const { return encoding_ == MeshEncoding::kText ? 2 : byte_size(type); }

  // Errors at the last word or number read, at its line and column or at its byte.
  void error(std::string cause, std::string remedy) { error_at(last_, std::move(cause), std::move(remedy)); }
  void error_at(std::size_t offset, std::string cause, std::string remedy);
  void error_at_end(std::string_view wanted);
  void warning(std::string cause, std::string remedy);
  bool ok() const { return diagnostics_.ok(); }
  // Whether to read on: so far no more errors than are worth telling.
  bool reads_on() const;

  // The mesh, named after the file; or what was wrong with it.
  Result<TriangleMesh> finish(TriangleMesh mesh);
  Diagnostics& diagnostics() { return diagnostics_; }

 private:
  Diagnostic describe(std::size_t offset, std::string cause, std::string remedy) const;

  std::string bytes_, file_;
  std::size_t at_ = 0;
  std::size_t last_ = 0;  // where the last word or number began
  MeshEncoding encoding_ = MeshEncoding::kText;
  Diagnostics diagnostics_;
};

// A word for a message: cut where it is long, without what cannot be printed.
std::string quote_word(std::string_view word);

}  // namespace fascicle
