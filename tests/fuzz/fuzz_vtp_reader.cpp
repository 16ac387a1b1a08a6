// Any bytes as .vtp. Whatever is accepted must hold together.
#include <cstdint>
#include <string>

#include "engine/content/vtp_reader.hpp"
#include "tests/fuzz/check_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fascicle::test::check_mesh(fascicle::parse_vtp(std::string(reinterpret_cast<const char*>(data), size), "fuzz.vtp"));
  return 0;
}
