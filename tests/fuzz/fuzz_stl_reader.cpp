// Any bytes as .stl. Whatever is accepted must hold together.
#include <cstdint>
#include <string>

#include "engine/content/stl_reader.hpp"
#include "tests/fuzz/check_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fascicle::test::check_mesh(fascicle::parse_stl(std::string(reinterpret_cast<const char*>(data), size), "fuzz.stl"));
  return 0;
}
