// Numbers as mesh files hold them: words of text, or bytes of a type that a header names. All are handed on as double,
// which holds every float and every index that a mesh can have.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fascicle {

enum class NumberType : std::uint8_t {
  kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64
};

std::size_t byte_size(NumberType type);

// The number in the first byte_size(type) bytes at `bytes`.
double decode_number(NumberType type, std::endian order, const char* bytes);

// Reads the whole word. Returns what is wrong with it ("is not a number", "is out of range"), empty when nothing is.
// "nan" and "inf" are numbers; a number too small for double is 0.
std::string_view parse_number(std::string_view word, double& number);

// Whether a float can hold it: neither infinite nor NaN nor too large.
bool fits_float(double number);

}  // namespace fascicle
