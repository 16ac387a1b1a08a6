#include "engine/content/gltf_accessors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace fascicle::detail {
namespace {

std::string accessor_path(int index) { return fmt::format("/accessors/{}", index); }

// A run of equally spaced elements inside a buffer.
struct StridedBytes {
  const std::uint8_t* data = nullptr;  // null: all zero
  std::size_t stride = 0;
};

// `count` elements of `element_size` bytes in a buffer view, or nothing after an error at `path`.
std::optional<StridedBytes> locate(GltfSource& source, int view_index, std::size_t offset, std::size_t count,
                                   std::size_t element_size, bool packed, const std::string& path) {
  const tinygltf::Model& model = source.model;
  if (view_index < 0 || static_cast<std::size_t>(view_index) >= model.bufferViews.size()) {
    source.error(path, fmt::format("no buffer view {}", view_index),
                 fmt::format("there are {}", model.bufferViews.size()));
    return std::nullopt;
  }
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(view_index)];
  const std::string view_path = fmt::format("/bufferViews/{}", view_index);
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size()) {
    source.error(view_path, fmt::format("no buffer {}", view.buffer),
                 fmt::format("there are {}", model.buffers.size()));
    return std::nullopt;
  }
  const std::vector<unsigned char>& bytes = model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteLength > bytes.size() || view.byteOffset > bytes.size() - view.byteLength) {
    source.error(view_path,
                 fmt::format("bytes {} to {} of buffer {}, which has {}", view.byteOffset,
                             static_cast<double>(view.byteOffset) + static_cast<double>(view.byteLength), view.buffer,
                             bytes.size()),
                 "correct byteOffset and byteLength; is the buffer complete?");
    return std::nullopt;
  }
  const std::size_t stride = packed || view.byteStride == 0 ? element_size : view.byteStride;
  if (stride < element_size) {
    source.error(view_path, fmt::format("byteStride {} is smaller than an element of {} bytes", stride, element_size),
                 "correct byteStride");
    return std::nullopt;
  }
  const bool fits = count == 0 || (offset <= view.byteLength && element_size <= view.byteLength - offset &&
                                   count - 1 <= (view.byteLength - offset - element_size) / stride);
  if (!fits) {
    source.error(path,
                 fmt::format("{} elements of {} bytes every {} from byte {} reach beyond buffer view {} of {} bytes",
                             count, element_size, stride, offset, view_index, view.byteLength),
                 "correct count, byteOffset or the buffer view");
    return std::nullopt;
  }
  return StridedBytes{bytes.data() + view.byteOffset + offset, stride};
}

template <class T>
T load(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);  // the file's byte order, little-endian, is that of every target
  return value;
}

float load_float(const std::uint8_t* at, int type, bool normalised) {
  const auto integer = [&](auto value, float largest) {
    const auto number = static_cast<float>(value);
    return normalised ? std::max(number / largest, -1.0f) : number;
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return integer(load<std::int8_t>(at), 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return integer(load<std::uint8_t>(at), 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return integer(load<std::int16_t>(at), 32767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return integer(load<std::uint16_t>(at), 65535.0f);
    default:
      return load<float>(at);
  }
}

std::uint32_t load_index(const std::uint8_t* at, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(at);
    default:
      return load<std::uint32_t>(at);
  }
}

// Component types as a set of bits, in the order of their numbers from 5120.
constexpr unsigned bit(int type) { return 1u << (type - TINYGLTF_COMPONENT_TYPE_BYTE); }
constexpr unsigned kFloat = bit(TINYGLTF_COMPONENT_TYPE_FLOAT);
constexpr unsigned kSmallUnsigned =
    bit(TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) | bit(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
constexpr unsigned kSmallIntegers =
    kSmallUnsigned | bit(TINYGLTF_COMPONENT_TYPE_BYTE) | bit(TINYGLTF_COMPONENT_TYPE_SHORT);
constexpr unsigned kUnsigned = kSmallUnsigned | bit(TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);

std::string_view shape_name(int components) {
  switch (components) {
    case 1:
      return "SCALAR";
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    default:
      return "MAT4";
  }
}

int components_of(int type) {
  return type > 0 ? tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)) : 0;
}

// What a reading of one accessor goes by.
struct Layout {
  const tinygltf::Accessor* accessor = nullptr;
  std::size_t component_size = 0;
  std::size_t element_size = 0;
};

std::optional<Layout> check_layout(GltfSource& source, int index, int components, unsigned types,
                                   std::string_view types_text, const std::string& use) {
  if (index < 0 || static_cast<std::size_t>(index) >= source.model.accessors.size()) {
    source.error(use, fmt::format("no accessor {}", index), fmt::format("there are {}", source.model.accessors.size()));
    return std::nullopt;
  }
  const tinygltf::Accessor& accessor = source.model.accessors[static_cast<std::size_t>(index)];
  const std::string path = accessor_path(index);
  // VEC4 and MAT2 have four components each; only vectors are asked for here, and matrices with sixteen.
  if (components_of(accessor.type) != components || accessor.type == TINYGLTF_TYPE_MAT2) {
    source.error(path, fmt::format("type is not {}, which {} needs", shape_name(components), use),
                 fmt::format("store it as {}", shape_name(components)));
    return std::nullopt;
  }
  const bool known =
      accessor.componentType >= TINYGLTF_COMPONENT_TYPE_BYTE && accessor.componentType <= TINYGLTF_COMPONENT_TYPE_FLOAT;
  if (!known || (types & bit(accessor.componentType)) == 0) {
    source.error(path, fmt::format("componentType {} cannot serve {}", accessor.componentType, use),
                 fmt::format("store it as {}", types_text));
    return std::nullopt;
  }
  if (!source.spend(accessor.count, path)) return std::nullopt;
  const auto size =
      static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)));
  return Layout{&accessor, size, size * static_cast<std::size_t>(components)};
}

// Fills out[element * components + component] by convert(pointer to the component), base values first, sparse ones over
// them. False after an error.
template <class T, class Convert>
bool read_elements(GltfSource& source, const Layout& layout, int components, const std::string& path,
                   std::vector<T>& out, Convert convert) {
  const tinygltf::Accessor& accessor = *layout.accessor;
  const auto width = static_cast<std::size_t>(components);
  std::optional<StridedBytes> base = StridedBytes{};
  if (accessor.bufferView >= 0) {
    base = locate(source, accessor.bufferView, accessor.byteOffset, accessor.count, layout.element_size, false, path);
    if (!base) return false;
  }
  out.assign(accessor.count * width, T{});
  const auto copy = [&](const std::uint8_t* from, std::size_t element) {
    for (std::size_t c = 0; c < width; ++c) out[element * width + c] = convert(from + c * layout.component_size);
  };
  if (base->data != nullptr) {
    for (std::size_t i = 0; i < accessor.count; ++i) copy(base->data + i * base->stride, i);
  }
  if (!accessor.sparse.isSparse) return true;

  const auto& sparse = accessor.sparse;
  const std::string sparse_path = path + "/sparse";
  const auto count = static_cast<std::size_t>(std::max(sparse.count, 0));
  if (count > accessor.count) {
    source.error(sparse_path, fmt::format("count {} is above the accessor's {}", count, accessor.count),
                 "correct the count");
    return false;
  }
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0) {
    source.error(sparse_path, "a negative byteOffset", "correct it");
    return false;
  }
  const int index_type = sparse.indices.componentType;
  const bool index_ok = index_type >= TINYGLTF_COMPONENT_TYPE_BYTE && index_type <= TINYGLTF_COMPONENT_TYPE_FLOAT &&
                        (kUnsigned & bit(index_type)) != 0;
  if (!index_ok) {
    source.error(sparse_path + "/indices", fmt::format("componentType {}", index_type), "use 5121, 5123 or 5125");
    return false;
  }
  const auto index_size =
      static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(index_type)));
  const auto indices = locate(source, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                              count, index_size, true, sparse_path + "/indices");
  const auto values = locate(source, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                             count, layout.element_size, true, sparse_path + "/values");
  if (!indices || !values) return false;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t element = load_index(indices->data + i * indices->stride, index_type);
    if (element >= accessor.count) {
      source.error(sparse_path + "/indices",
                   fmt::format("index {} is {}, but the accessor has {} elements", i, element, accessor.count),
                   "correct the index");
      return false;
    }
    copy(values->data + i * values->stride, element);
  }
  return true;
}

}  // namespace

std::optional<std::size_t> read_float_accessor(GltfSource& source, int index, int components, const std::string& use,
                                               std::vector<float>& out, bool any_integer) {
  const auto layout =
      check_layout(source, index, components, kFloat | kSmallIntegers, "float (5126) or normalised integers", use);
  if (!layout) return std::nullopt;
  const tinygltf::Accessor& accessor = *layout->accessor;
  const std::string path = accessor_path(index);
  const int type = accessor.componentType;
  if (type != TINYGLTF_COMPONENT_TYPE_FLOAT && !accessor.normalized && !any_integer) {
    source.error(path, fmt::format("integers that are not normalised cannot serve {}", use),
                 "store float (5126), or set normalized");
    return std::nullopt;
  }
  const auto convert = [&](const std::uint8_t* at) { return load_float(at, type, accessor.normalized); };
  if (!read_elements(source, *layout, components, path, out, convert)) return std::nullopt;
  const auto bad = std::ranges::find_if(out, [](float number) { return !std::isfinite(number); });
  if (bad != out.end()) {
    source.error(path, fmt::format("element {} holds {}", (bad - out.begin()) / components, *bad),
                 "write finite numbers");
    return std::nullopt;
  }
  return accessor.count;
}

std::optional<std::size_t> read_index_accessor(GltfSource& source, int index, int components, const std::string& use,
                                               std::vector<std::uint32_t>& out, bool allow_32_bits) {
  const auto layout = check_layout(
      source, index, components, allow_32_bits ? kUnsigned : kSmallUnsigned,
      allow_32_bits ? "unsigned byte, short or int (5121, 5123, 5125)" : "unsigned byte or short (5121, 5123)", use);
  if (!layout) return std::nullopt;
  const int type = layout->accessor->componentType;
  const auto convert = [&](const std::uint8_t* at) { return load_index(at, type); };
  if (!read_elements(source, *layout, components, accessor_path(index), out, convert)) return std::nullopt;
  return layout->accessor->count;
}

}  // namespace fascicle::detail
