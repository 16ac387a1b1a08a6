#include "engine/content/vtp_encoding.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

namespace fascicle {
namespace {

constexpr double kMaxRatio = 1100.0;  // zlib reaches 1032

constexpr std::array<std::int8_t, 256> make_base64_values() {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  return values;
}

// The bytes of an encoded array from the front on. `take(n)` gives the next n; nothing when there are not so many, or
// when they are no base64. In base64 each take stands for itself, padded to whole groups of four digits.
class ByteStream {
 public:
  ByteStream(std::string_view data, bool is_base64) : data_(data), is_base64_(is_base64) {}

  std::optional<std::string> take(double count) {
    if (count > static_cast<double>(data_.size())) return std::nullopt;
    const double digits = is_base64_ ? 4.0 * static_cast<double>((static_cast<std::uint64_t>(count) + 2) / 3) : count;
    if (digits > static_cast<double>(data_.size())) return std::nullopt;
    const std::string_view part = data_.substr(0, static_cast<std::size_t>(digits));
    std::optional<std::string> bytes =
        is_base64_ ? decode(part, static_cast<std::size_t>(count)) : std::optional<std::string>(part);
    data_.remove_prefix(part.size());
    return bytes;
  }
  // The same without going on.
  std::optional<std::string> peek(double count) const { return ByteStream(*this).take(count); }

 private:
  static std::optional<std::string> decode(std::string_view digits, std::size_t count) {
    static constexpr std::array<std::int8_t, 256> kValues = make_base64_values();
    std::string bytes;
    bytes.reserve(count + 2);
    for (std::size_t i = 0; i < digits.size(); i += 4) {
      std::uint32_t group = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        const bool padding = digits[i + k] == '=' && i + 4 == digits.size() && k >= 2;
        const std::int8_t value = padding ? std::int8_t{0} : kValues[static_cast<unsigned char>(digits[i + k])];
        if (value < 0) return std::nullopt;
        group = group << 6 | static_cast<std::uint32_t>(value);
      }
      for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<char>(group >> shift & 0xff));
    }
    bytes.resize(count);
    return bytes;
  }

  std::string_view data_;
  bool is_base64_;
};

VtpArray fault(std::string text) { return {{}, std::move(text)}; }

VtpArray inflate_blocks(ByteStream stream, const VtpEncoding& encoding) {
  const double word = static_cast<double>(byte_size(encoding.header));
  const std::optional<std::string> first = stream.peek(word);
  if (!first) return fault("the array ends before its header does");
  const double block_count = decode_number(encoding.header, encoding.order, first->data());
  const std::optional<std::string> header = stream.take(word * (3.0 + block_count));
  if (!header) return fault(fmt::format("its header tells of {} blocks, more than there can be", block_count));
  if (block_count == 0.0) return {};
  const auto number = [&](std::size_t i) {
    return decode_number(encoding.header, encoding.order, header->data() + i * byte_size(encoding.header));
  };
  const auto blocks = static_cast<std::size_t>(block_count);
  const double block_size = number(1), last_size = number(2) > 0.0 ? number(2) : block_size;
  double packed_size = 0.0;
  for (std::size_t i = 0; i < blocks; ++i) packed_size += number(3 + i);
  const double size = (block_count - 1.0) * block_size + last_size;
  if (size > kMaxRatio * packed_size)
    return fault(fmt::format("its header promises {} bytes from {} packed ones", size, packed_size));
  if (size > static_cast<double>(encoding.max_bytes))
    return fault(fmt::format("it unpacks to {} bytes where {} are allowed", size, encoding.max_bytes));
  const std::optional<std::string> packed = stream.take(packed_size);
  if (!packed) return fault(fmt::format("{} packed bytes should follow its header, but do not", packed_size));

  VtpArray array;
  array.bytes.resize(static_cast<std::size_t>(size));
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < blocks; ++i) {
    const auto packed_block = static_cast<std::size_t>(number(3 + i));
    const auto block = static_cast<std::size_t>(i + 1 == blocks ? last_size : block_size);
    uLongf length = static_cast<uLongf>(block);
    const int code =
        uncompress(reinterpret_cast<Bytef*>(array.bytes.data() + to), &length,
                   reinterpret_cast<const Bytef*>(packed->data() + from), static_cast<uLong>(packed_block));
    if (code != Z_OK || length != block) return fault(fmt::format("block {} of {} cannot be unpacked", i, blocks));
    from += packed_block;
    to += block;
  }
  return array;
}

VtpArray decode(ByteStream stream, const VtpEncoding& encoding) {
  if (encoding.compressed) return inflate_blocks(stream, encoding);
  const double word = static_cast<double>(byte_size(encoding.header));
  const std::optional<std::string> header = stream.peek(word);
  if (!header) return fault("the array ends before its header does");
  const double size = decode_number(encoding.header, encoding.order, header->data());
  std::optional<std::string> all = stream.take(word + size);  // one run: the header is not padded by itself
  if (!all) return fault(fmt::format("{} bytes should follow its header, but do not", size));
  return {all->substr(byte_size(encoding.header)), {}};
}

}  // namespace

VtpArray decode_vtp_base64(std::string_view data, const VtpEncoding& encoding) {
  return decode(ByteStream(data, true), encoding);
}

VtpArray decode_vtp_raw(std::string_view data, const VtpEncoding& encoding) {
  return decode(ByteStream(data, false), encoding);
}

}  // namespace fascicle
