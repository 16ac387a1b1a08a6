#include "engine/content/number_type.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace fascicle {
namespace {

template <class T>
double decode(std::endian order, const char* bytes) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(copy, copy + sizeof(T));
  T number;
  std::memcpy(&number, copy, sizeof(T));
  return static_cast<double>(number);
}

}  // namespace

std::size_t byte_size(NumberType type) {
  static constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};  // in the order of the types
  return kSizes[static_cast<std::size_t>(type)];
}

double decode_number(NumberType type, std::endian order, const char* bytes) {
  static constexpr double (*kDecoders[])(std::endian, const char*) = {
      decode<std::int8_t>,   decode<std::uint8_t>, decode<std::int16_t>,  decode<std::uint16_t>, decode<std::int32_t>,
      decode<std::uint32_t>, decode<std::int64_t>, decode<std::uint64_t>, decode<float>,         decode<double>};
  return kDecoders[static_cast<std::size_t>(type)](order, bytes);
}

std::string_view parse_number(std::string_view word, double& number) {
  number = 0.0;
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [rest, code] = std::from_chars(word.data(), end, number);
  if (rest != end || code == std::errc::invalid_argument) {
    number = 0.0;
    return "is not a number";
  }
  if (code != std::errc::result_out_of_range) return {};
  const std::size_t exponent = word.find_first_of("eE");
  const bool tiny = exponent != std::string_view::npos && word.substr(exponent + 1).starts_with('-');
  number = 0.0;
  return tiny ? std::string_view{} : "is out of range";
}

bool fits_float(double number) { return std::abs(number) <= std::numeric_limits<float>::max(); }

}  // namespace fascicle
