#include "engine/content/vtp_encoding.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <vector>

#include "tests/engine/content/mesh_file_cases.hpp"

namespace fascicle {
namespace {

using test::bytes_of;
using testing::HasSubstr;

std::string base64(const std::string& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string pack(const std::string& bytes) {
  std::string packed(compressBound(static_cast<uLong>(bytes.size())), '\0');
  uLongf size = static_cast<uLongf>(packed.size());
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                     static_cast<uLong>(bytes.size())),
            Z_OK);
  return packed.substr(0, size);
}

// The header and the packed bytes, in blocks of `block` bytes.
struct Packed {
  std::vector<std::uint64_t> header;
  std::string data;

  explicit Packed(const std::string& bytes, std::size_t block) {
    header = {(bytes.size() + block - 1) / block, block, bytes.size() % block};
    for (std::size_t i = 0; i < bytes.size(); i += block) {
      const std::string packed = pack(bytes.substr(i, block));
      header.push_back(packed.size());
      data += packed;
    }
  }
  std::string header_bytes(const VtpEncoding& encoding) const {
    std::string text;
    for (const std::uint64_t number : header) {
      text += encoding.header == NumberType::kUint64
                  ? bytes_of<std::uint64_t>({number}, encoding.order)
                  : bytes_of<std::uint32_t>({static_cast<std::uint32_t>(number)}, encoding.order);
    }
    return text;
  }
};

constexpr VtpEncoding kPlain{};
constexpr VtpEncoding kPacked{std::endian::little, NumberType::kUint32, true};

TEST(VtpEncoding, BrokenArraysAreRefused) {
  const auto little = std::endian::little;
  EXPECT_EQ(decode_vtp_raw("", kPlain).fault, "the array ends before its header does");
  EXPECT_EQ(decode_vtp_raw("abc", kPlain).fault, "the array ends before its header does");
  EXPECT_EQ(decode_vtp_raw(bytes_of<std::uint32_t>({5}, little) + "four", kPlain).fault,
            "5 bytes should follow its header, but do not");
  EXPECT_EQ(decode_vtp_base64("AAA", kPlain).fault, "the array ends before its header does");
  EXPECT_EQ(decode_vtp_base64("AAAA!AAA", kPlain).fault, "the array ends before its header does");
  EXPECT_EQ(decode_vtp_base64("BAAAAA==", kPlain).fault, "4 bytes should follow its header, but do not");
  EXPECT_EQ(decode_vtp_base64("BAAAAA==AAAA", kPlain).fault, "4 bytes should follow its header, but do not");
  const VtpEncoding wide{little, NumberType::kUint64, false};
  EXPECT_THAT(decode_vtp_raw(bytes_of<std::uint64_t>({~std::uint64_t{0}}, little), wide).fault,
              HasSubstr("should follow"));
}

TEST(VtpEncoding, BrokenBlocksAreRefused) {
  const std::string text(100, 'a');
  const auto fault_of = [](const Packed& packed) {
    return decode_vtp_raw(packed.header_bytes(kPacked) + packed.data, kPacked).fault;
  };
  Packed packed(text, 64);
  EXPECT_EQ(fault_of(packed), "");
  packed.header[0] = 4000000000u;
  EXPECT_EQ(fault_of(packed), "its header tells of 4000000000 blocks, more than there can be");
  packed = Packed(text, 64);
  packed.header[1] = 4000000000u;
  EXPECT_THAT(fault_of(packed), HasSubstr("its header promises 4000000036 bytes from"));
  packed = Packed(text, 64);
  packed.header[3] += 1;
  EXPECT_THAT(fault_of(packed), HasSubstr("packed bytes should follow its header, but do not"));
  packed = Packed(text, 64);
  packed.data[0] = 'y';
  EXPECT_EQ(fault_of(packed), "block 0 of 2 cannot be unpacked");
  packed = Packed(text, 64);
  packed.header[2] = 35;  // of 36
  EXPECT_EQ(fault_of(packed), "block 1 of 2 cannot be unpacked");
  packed.header[2] = 37;
  EXPECT_EQ(fault_of(packed), "block 1 of 2 cannot be unpacked");
  EXPECT_EQ(decode_vtp_raw("abc", kPacked).fault, "the array ends before its header does");
}

TEST(VtpEncoding, BytesComeBackInEveryEncoding) {
  for (const std::size_t size : {0u, 1u, 2u, 3u, 63u, 64u, 65u, 128u, 1000u}) {
    std::string text;
    for (std::size_t i = 0; i < size; ++i) text += static_cast<char>(i * i % 251);
    for (const std::endian order : {std::endian::little, std::endian::big}) {
      for (const NumberType header : {NumberType::kUint32, NumberType::kUint64}) {
        VtpEncoding encoding{order, header, false};
        const std::string plain =
            (header == NumberType::kUint64 ? bytes_of<std::uint64_t>({size}, order)
                                           : bytes_of<std::uint32_t>({static_cast<std::uint32_t>(size)}, order)) +
            text;
        EXPECT_EQ(decode_vtp_raw(plain + "behind", encoding).bytes, text);
        EXPECT_EQ(decode_vtp_base64(base64(plain) + "behind", encoding).bytes, text);
        encoding.compressed = true;
        const Packed packed(text, 64);
        EXPECT_EQ(decode_vtp_raw(packed.header_bytes(encoding) + packed.data + "behind", encoding).bytes, text);
        EXPECT_EQ(decode_vtp_base64(base64(packed.header_bytes(encoding)) + base64(packed.data) + "!", encoding).bytes,
                  text);
      }
    }
  }
}

}  // namespace
}  // namespace fascicle
