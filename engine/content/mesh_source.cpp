#include "engine/content/mesh_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "engine/content/limit_errors.hpp"
#include "engine/content/text_position.hpp"

namespace fascicle {
namespace {

constexpr std::size_t kMaxErrors = 20;
constexpr std::size_t kMaxQuoted = 32;
constexpr std::size_t kMaxPoints = 0xfffffffe;

bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || is_line_end(c); }

}  // namespace

std::string quote_word(std::string_view word) {
  std::string quoted = "'";
  for (const char c : word.substr(0, kMaxQuoted)) quoted += c >= ' ' && c <= '~' ? c : '?';
  return quoted + (word.size() > kMaxQuoted ? "...'" : "'");
}

std::string_view MeshSource::word() {
  while (at_ < bytes_.size() && is_space(bytes_[at_])) ++at_;
  return word_of_line();
}

std::string_view MeshSource::word_of_line() {
  while (at_ < bytes_.size() && is_space(bytes_[at_]) && !is_line_end(bytes_[at_])) ++at_;
  last_ = at_;
  while (at_ < bytes_.size() && !is_space(bytes_[at_])) ++at_;
  return bytes().substr(last_, at_ - last_);
}

std::string_view MeshSource::line() {
  last_ = at_;
  while (at_ < bytes_.size() && !is_line_end(bytes_[at_])) ++at_;
  const std::string_view text = bytes().substr(last_, at_ - last_);
  if (at_ + 1 < bytes_.size() && bytes_[at_] == '\r' && bytes_[at_ + 1] == '\n') ++at_;
  if (at_ < bytes_.size()) ++at_;
  return text;
}

bool MeshSource::read(NumberType type, double& number) {
  number = 0.0;
  if (encoding_ != MeshEncoding::kText) {
    last_ = at_;
    if (remaining() < byte_size(type)) {
      error_at_end("a number");
      return false;
    }
    const std::endian order = encoding_ == MeshEncoding::kLittleEndian ? std::endian::little : std::endian::big;
    number = decode_number(type, order, bytes_.data() + at_);
    at_ += byte_size(type);
    return true;
  }
  const std::string_view text = word();
  if (text.empty()) {
    error_at_end("a number");
    return false;
  }
  const std::string_view fault = parse_number(text, number);
  if (!fault.empty()) error(fmt::format("{} {}", quote_word(text), fault), "write a number");
  return reads_on();
}

bool MeshSource::read_coordinate(NumberType type, float& coordinate) {
  double number = 0.0;
  if (!read(type, number)) return false;
  if (!fits_float(number)) {
    error(fmt::format("a coordinate is {}", number), "coordinates are finite, and smaller than 1e38");
    number = 0.0;
  }
  coordinate = static_cast<float>(number);
  return reads_on();
}

bool MeshSource::read_point(NumberType type, glm::vec3& point) {
  return read_coordinate(type, point.x) && read_coordinate(type, point.y) && read_coordinate(type, point.z);
}

bool MeshSource::read_index(NumberType type, std::size_t count, std::string_view of_what, std::uint32_t& index) {
  double number = 0.0;
  if (!read(type, number)) return false;
  index = to_index(number, count, of_what);
  return reads_on();
}

std::uint32_t MeshSource::to_index(double number, std::size_t count, std::string_view of_what) {
  if (number >= 0.0 && number < static_cast<double>(count) && number == std::floor(number))
    return static_cast<std::uint32_t>(number);
  if (count == 0) {
    error(fmt::format("number {} where there are no {}", number, of_what), fmt::format("give the {} first", of_what));
  } else {
    error(fmt::format("number {} of {} {}", number, count, of_what), fmt::format("write 0 to {}", count - 1));
  }
  return 0;
}

bool MeshSource::read_count(std::string_view of_what, std::uint64_t& count) {
  const std::string_view text = word_of_line();
  const auto [rest, code] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (code == std::errc() && rest == text.data() + text.size()) return true;
  count = 0;
  error(text.empty() ? fmt::format("no number of {}", of_what)
                     : fmt::format("{} is not a number of {}", quote_word(text), of_what),
        "write a whole number");
  return false;
}

bool MeshSource::skip(NumberType type, std::uint64_t count) {
  if (!can_hold(count, least_size(type), "numbers")) return false;
  if (encoding_ != MeshEncoding::kText) {
    at_ += byte_size(type) * count;
    return true;
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!word().empty()) continue;
    error_at_end("a number");
    return false;
  }
  return true;
}

bool MeshSource::can_hold(std::uint64_t count, std::size_t size, std::string_view of_what) {
  // The last word of a text needs nothing after it.
  const std::size_t room = remaining() + (encoding_ == MeshEncoding::kText ? 1 : 0);
  if (count <= room / size && count <= kMaxPoints) return true;
  error(fmt::format("{} {} do not fit into the {} bytes that follow", count, of_what, remaining()),
        "correct the number; is the file complete?");
  return false;
}

Diagnostic MeshSource::describe(std::size_t offset, std::string cause, std::string remedy) const {
  Diagnostic diagnostic{file_, 0, 0, {}, std::move(cause), std::move(remedy)};
  if (encoding_ == MeshEncoding::kText) {
    const TextPosition at = LineTable(bytes_).position(bytes_, offset);
    diagnostic.line = at.line;
    diagnostic.column = at.column;
  } else {
    diagnostic.path = fmt::format("byte {}", offset);
  }
  return diagnostic;
}

void MeshSource::error_at(std::size_t offset, std::string cause, std::string remedy) {
  if (!has_room(diagnostics_.errors, kMaxErrors, file_)) return;
  diagnostics_.errors.push_back(describe(offset, std::move(cause), std::move(remedy)));
}

void MeshSource::error_at_end(std::string_view wanted) {
  error_at(bytes_.size(), fmt::format("the file ends where {} should be", wanted), "is it complete?");
}

void MeshSource::warning(std::string cause, std::string remedy) {
  if (!has_room(diagnostics_.warnings, kMaxErrors, file_)) return;
  diagnostics_.warnings.push_back(describe(last_, std::move(cause), std::move(remedy)));
}

bool MeshSource::reads_on() const { return diagnostics_.errors.size() <= kMaxErrors; }

Result<TriangleMesh> MeshSource::finish(TriangleMesh mesh) {
  if (ok() && mesh.indices.empty()) {
    diagnostics_.errors.push_back({file_, 0, 0, {}, "no triangles", "is it a surface mesh?"});
  }
  if (!ok()) return std::move(diagnostics_);
  mesh.name = std::filesystem::path(file_).stem().string();
  return {std::move(mesh), std::move(diagnostics_)};
}

}  // namespace fascicle
