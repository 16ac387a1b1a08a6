// Any bytes as legacy .vtk, for a surface and for polylines. Whatever is accepted must hold together.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "engine/content/vtk_reader.hpp"
#include "tests/fuzz/check_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  fascicle::test::check_mesh(fascicle::parse_vtk(bytes, "fuzz.vtk"));
  const auto lines = fascicle::parse_polylines(bytes, "fuzz.vtk");
  if (!lines) {
    if (lines.diagnostics().errors.empty()) std::abort();
    return 0;
  }
  if (lines->ends.empty() || lines->ends.back() != lines->points.size()) std::abort();
  if (!std::ranges::is_sorted(lines->ends)) std::abort();
  for (const std::uint32_t point : lines->points) {
    if (point >= lines->positions.size()) std::abort();
  }
  return 0;
}
