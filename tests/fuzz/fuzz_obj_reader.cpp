// Any bytes as .obj. Whatever is accepted must hold together.
#include <cstdint>
#include <string>

#include "engine/content/obj_reader.hpp"
#include "tests/fuzz/check_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fascicle::test::check_mesh(fascicle::parse_obj(std::string(reinterpret_cast<const char*>(data), size), "fuzz.obj"));
  return 0;
}
