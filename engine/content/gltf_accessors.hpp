// Reading of accessors: typed, strided, sparse and normalised views of buffers, checked against the buffers' real size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/content/gltf_source.hpp"

namespace fascicle::detail {

// Each reads accessor `index` into `out`, `components` numbers an element, and returns the number of elements. On any
// fault it appends an error naming the accessor and `use`, the place that refers to it, and returns nothing.
//
// Floats: float, or integers that are normalised; where `any_integer`, also plain ones (KHR_mesh_quantization).
std::optional<std::size_t> read_float_accessor(GltfSource& source, int index, int components, const std::string& use,
                                               std::vector<float>& out, bool any_integer = false);
// Unsigned bytes, shorts, and where `allow_32_bits` ints.
std::optional<std::size_t> read_index_accessor(GltfSource& source, int index, int components, const std::string& use,
                                               std::vector<std::uint32_t>& out, bool allow_32_bits = true);

}  // namespace fascicle::detail
