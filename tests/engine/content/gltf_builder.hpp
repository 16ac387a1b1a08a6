// Small glTF documents made in code: arrays go into one buffer, sections are given as JSON text.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace fascicle::test {

inline std::string encode_base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kLetters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

class GltfBuilder {
 public:
  static constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
                       kFloat = 5126;

  // A buffer view of the numbers' bytes; its index.
  template <class T>
  int view(const std::vector<T>& numbers, int stride = 0) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const std::size_t size = numbers.size() * sizeof(T);
    views_.push_back(fmt::format(R"({{"buffer": 0, "byteOffset": {}, "byteLength": {}{}}})", bytes_.size(), size,
                                 stride > 0 ? fmt::format(R"(, "byteStride": {})", stride) : ""));
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, numbers.data(), size);
    return static_cast<int>(views_.size()) - 1;
  }

  // An accessor; `extra` is more JSON members, with a leading comma. Its index.
  int accessor(int view, int component_type, std::size_t count, std::string_view type, std::string_view extra = "") {
    accessors_.push_back(fmt::format(R"({{{}"componentType": {}, "count": {}, "type": "{}"{}}})",
                                     view >= 0 ? fmt::format(R"("bufferView": {}, )", view) : "", component_type, count,
                                     type, extra));
    return static_cast<int>(accessors_.size()) - 1;
  }
  int scalars(const std::vector<float>& numbers) { return accessor(view(numbers), kFloat, numbers.size(), "SCALAR"); }
  int vec3(const std::vector<float>& numbers) { return accessor(view(numbers), kFloat, numbers.size() / 3, "VEC3"); }
  int vec4(const std::vector<float>& numbers) { return accessor(view(numbers), kFloat, numbers.size() / 4, "VEC4"); }
  int mat4(const std::vector<float>& numbers) { return accessor(view(numbers), kFloat, numbers.size() / 16, "MAT4"); }
  int indices(const std::vector<std::uint16_t>& numbers) {
    return accessor(view(numbers), kUnsignedShort, numbers.size(), "SCALAR");
  }

  void section(std::string name, std::string json) { sections_.emplace_back(std::move(name), std::move(json)); }

  std::string gltf() const {
    return json(fmt::format(R"(, "uri": "data:application/octet-stream;base64,{}")", encode_base64(bytes_)));
  }
  std::string gltf_with_uri(const std::string& uri) const { return json(fmt::format(R"(, "uri": "{}")", uri)); }
  const std::string& bytes() const { return bytes_; }

  std::string glb() const { return pack(json(""), bytes_); }
  static std::string pack(std::string text, std::string bin) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    return "glTF" + u32(2) + u32(28 + text.size() + bin.size()) + u32(text.size()) + "JSON" + text + u32(bin.size()) +
           std::string("BIN\0", 4) + bin;
  }
  static std::string u32(std::size_t value) {
    std::string text;
    for (int shift = 0; shift < 32; shift += 8) text += static_cast<char>(value >> shift & 0xff);
    return text;
  }

 private:
  static std::string join(const std::vector<std::string>& list) {
    std::string text;
    for (const std::string& item : list) text += (text.empty() ? "  " : ",\n  ") + item;
    return text;
  }
  // One line an element, so that errors have lines to name.
  std::string json(const std::string& buffer_extra) const {
    std::string text = "{\"asset\": {\"version\": \"2.0\"}";
    if (!bytes_.empty()) text += fmt::format(",\n\"buffers\": [{{\"byteLength\": {}{}}}]", bytes_.size(), buffer_extra);
    if (!views_.empty()) text += ",\n\"bufferViews\": [\n" + join(views_) + "]";
    if (!accessors_.empty()) text += ",\n\"accessors\": [\n" + join(accessors_) + "]";
    for (const auto& [name, value] : sections_) text += fmt::format(",\n\"{}\": {}", name, value);
    return text + "\n}\n";
  }

  std::string bytes_;
  std::vector<std::string> views_, accessors_;
  std::vector<std::pair<std::string, std::string>> sections_;
};

inline std::span<const std::uint8_t> as_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace fascicle::test
