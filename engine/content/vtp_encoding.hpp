// How XML files of VTK hold arrays that are not text: base64 or raw bytes behind a header of sizes, whole or in blocks
// that zlib compressed.
#pragma once

#include <bit>
#include <cstddef>
#include <string>
#include <string_view>

#include "engine/content/number_type.hpp"

namespace fascicle {

struct VtpEncoding {
  std::endian order = std::endian::little;
  NumberType header = NumberType::kUint32;  // of the sizes; or kUint64
  bool compressed = false;
  std::size_t max_bytes = std::size_t{1} << 30;  // that an array may unpack to
};

struct VtpArray {
  std::string bytes;
  std::string fault;  // what is wrong; then there are no bytes
};

// The array that begins at the front of `data`; what follows it is not looked at. Sizes are believed only as far as
// `data` bears them out.
VtpArray decode_vtp_base64(std::string_view data, const VtpEncoding& encoding);
VtpArray decode_vtp_raw(std::string_view data, const VtpEncoding& encoding);

}  // namespace fascicle
