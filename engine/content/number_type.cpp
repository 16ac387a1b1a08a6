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
  switch (type) {
    case NumberType::kInt8:
    case NumberType::kUint8: return 1;
    case NumberType::kInt16:
    case NumberType::kUint16: return 2;
    case NumberType::kInt32:
    case NumberType::kUint32:
    case NumberType::kFloat32: return 4;
    case NumberType::kInt64:
    case NumberType::kUint64:
    case NumberType::kFloat64: return 8;
  }
  return 0;
}

double decode_number(NumberType type, std::endian order, const char* bytes) {
  switch (type) {
    case NumberType::kInt8: return decode<std::int8_t>(order, bytes);
    case NumberType::kUint8: return decode<std::uint8_t>(order, bytes);
    case NumberType::kInt16: return decode<std::int16_t>(order, bytes);
    case NumberType::kUint16: return decode<std::uint16_t>(order, bytes);
    case NumberType::kInt32: return decode<std::int32_t>(order, bytes);
    case NumberType::kUint32: return decode<std::uint32_t>(order, bytes);
    case NumberType::kInt64: return decode<std::int64_t>(order, bytes);
    case NumberType::kUint64: return decode<std::uint64_t>(order, bytes);
    case NumberType::kFloat32: return decode<float>(order, bytes);
    case NumberType::kFloat64: return decode<double>(order, bytes);
  }
  return 0.0;
}

std::string_view parse_number(std::string_view word, double& number) {
  number = 0.0;
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [rest, code] = std::from_chars(word.data(), end, number);
  if (rest != end || code == std::errc::invalid_argument) return "is not a number";
  if (code != std::errc::result_out_of_range) return {};
  const std::size_t exponent = word.find_first_of("eE");
  const bool tiny = exponent != std::string_view::npos && word.substr(exponent + 1).starts_with('-');
  number = 0.0;
  return tiny ? std::string_view{} : "is out of range";
}

bool fits_float(double number) { return std::abs(number) <= std::numeric_limits<float>::max(); }

}  // namespace fascicle
