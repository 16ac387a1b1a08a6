// A 64-bit hash of raw bytes, for telling whether two runs reached the same state. Not for adversaries. It depends on
// bytes and their order alone, never on addresses, and mixes eight bytes a step (the multiply-rotate of xxHash).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace fascicle {

class StateHash {
 public:
  template <class T>
  void add(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_bytes(values.data(), values.size_bytes());
  }
  template <class T>
  void add(const T& value) {
    add(std::span<const T>(&value, 1));
  }

  std::uint64_t value() const {
    std::uint64_t h = state_;
    h ^= h >> 33;
    h *= 0xc2b2ae3d27d4eb4full;
    h ^= h >> 29;
    return h;
  }

 private:
  void add_bytes(const void* data, std::size_t size) {
    const unsigned char* bytes = static_cast<const unsigned char*>(data);
    for (; size >= 8; size -= 8, bytes += 8) mix(bytes, 8);
    if (size > 0) mix(bytes, size);
  }
  void mix(const unsigned char* bytes, std::size_t size) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes, size);
    word *= 0xc2b2ae3d27d4eb4full;
    word = (word << 31) | (word >> 33);
    state_ ^= word * 0x9e3779b185ebca87ull;
    state_ = ((state_ << 27) | (state_ >> 37)) * 0x9e3779b185ebca87ull + 0x85ebca77c2b2ae63ull;
  }

  std::uint64_t state_ = 0x27d4eb2f165667c5ull;
};

}  // namespace fascicle
