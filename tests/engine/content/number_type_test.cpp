#include "engine/content/number_type.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/engine/content/mesh_file_cases.hpp"

namespace fascicle {
namespace {

TEST(NumberType, WordsThatAreNoNumbers) {
  double number = 7.0;
  for (const char* word : {"", "x", "1x", "1 ", "--1", "+-1", "+", "1,5", "0x10", "1e", "."}) {
    EXPECT_EQ(parse_number(word, number), "is not a number") << word;
    EXPECT_EQ(number, 0.0);
  }
  EXPECT_EQ(parse_number("1e999", number), "is out of range");
  EXPECT_EQ(parse_number("-1e999", number), "is out of range");
  EXPECT_EQ(parse_number("1" + std::string(400, '0'), number), "is out of range");
}

TEST(NumberType, WordsThatAre) {
  const auto value_of = [](std::string_view word) {
    double number = 7.0;
    EXPECT_EQ(parse_number(word, number), "") << word;
    return number;
  };
  EXPECT_EQ(value_of("-1.5e3"), -1500.0);
  EXPECT_EQ(value_of("+2"), 2.0);
  EXPECT_EQ(value_of("1."), 1.0);
  EXPECT_EQ(value_of(".5"), 0.5);
  EXPECT_EQ(value_of("1e-999"), 0.0);
  EXPECT_EQ(value_of("1E-999"), 0.0);
  EXPECT_TRUE(std::isnan(value_of("nan")));
  EXPECT_TRUE(std::isinf(value_of("-inf")));
}

TEST(NumberType, OnlyFiniteFloatsFit) {
  EXPECT_TRUE(fits_float(std::numeric_limits<float>::max()));
  EXPECT_TRUE(fits_float(-std::numeric_limits<float>::max()));
  for (const double number : {1e39, -1e39, double{NAN}, double{INFINITY}}) EXPECT_FALSE(fits_float(number));
}

TEST(NumberType, BytesOfEachType) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const auto decode = [&](NumberType type, const std::string& bytes) {
      EXPECT_EQ(byte_size(type), bytes.size());
      return decode_number(type, order, bytes.data());
    };
    EXPECT_EQ(decode(NumberType::kInt8, test::bytes_of<std::int8_t>({-5}, order)), -5.0);
    EXPECT_EQ(decode(NumberType::kUint8, test::bytes_of<std::uint8_t>({251}, order)), 251.0);
    EXPECT_EQ(decode(NumberType::kInt16, test::bytes_of<std::int16_t>({-300}, order)), -300.0);
    EXPECT_EQ(decode(NumberType::kUint16, test::bytes_of<std::uint16_t>({65000}, order)), 65000.0);
    EXPECT_EQ(decode(NumberType::kInt32, test::bytes_of<std::int32_t>({-70000}, order)), -70000.0);
    EXPECT_EQ(decode(NumberType::kUint32, test::bytes_of<std::uint32_t>({4000000000u}, order)), 4e9);
    EXPECT_EQ(decode(NumberType::kInt64, test::bytes_of<std::int64_t>({-(std::int64_t{1} << 40)}, order)), -0x1p40);
    EXPECT_EQ(decode(NumberType::kUint64, test::bytes_of<std::uint64_t>({std::uint64_t{1} << 63}, order)), 0x1p63);
    EXPECT_EQ(decode(NumberType::kFloat32, test::bytes_of<float>({0.1f}, order)), double{0.1f});
    EXPECT_EQ(decode(NumberType::kFloat64, test::bytes_of<double>({0.1}, order)), 0.1);
  }
}

}  // namespace
}  // namespace fascicle
