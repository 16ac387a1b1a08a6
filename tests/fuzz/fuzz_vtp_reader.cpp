// Any bytes as .vtp. Whatever is accepted must hold together.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "engine/content/vtp_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto result = fascicle::parse_vtp(std::string(reinterpret_cast<const char*>(data), size), "fuzz.vtp");
  if (!result) {
    if (result.diagnostics().errors.empty()) std::abort();
    return 0;
  }
  const std::size_t count = result->positions.size();
  if (!result->normals.empty() && result->normals.size() != count) std::abort();
  if (result->indices.size() % 3 != 0) std::abort();
  for (const std::uint32_t index : result->indices) {
    if (index >= count) std::abort();
  }
  for (const glm::vec3& p : result->positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
  }
  return 0;
}
