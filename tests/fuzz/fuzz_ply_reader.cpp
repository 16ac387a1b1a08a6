// Any bytes as .ply. Whatever is accepted must hold together.
#include <cstdint>
#include <string>

#include "engine/content/ply_reader.hpp"
#include "tests/fuzz/check_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fascicle::test::check_mesh(fascicle::parse_ply(std::string(reinterpret_cast<const char*>(data), size), "fuzz.ply"));
  return 0;
}
