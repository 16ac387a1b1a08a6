// Any bytes as JSON: parses, then walks the tree by every kind of reading. What is asked for here is that it ends, that
// nothing is read out of bounds, and that a refusal has a message.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "engine/content/json_reader.hpp"

namespace {

void walk(fascicle::JsonNode node, fascicle::Diagnostics& diagnostics) {
  double number = 0.0;
  float single = 0.0f;
  std::int32_t integer = 0;
  std::string text;
  glm::vec3 vector(0.0f);
  glm::quat quaternion(1.0f, 0.0f, 0.0f, 0.0f);
  node.read(number, diagnostics);
  node.read(single, diagnostics, fascicle::above(0.0));
  node.read(integer, diagnostics);
  node.read(text, diagnostics);
  node.read(vector, diagnostics);
  node.read(quaternion, diagnostics);
  if (diagnostics.errors.size() > 200) diagnostics.errors.clear();
  for (const fascicle::JsonNode child : node) walk(child, diagnostics);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto result = fascicle::parse_json(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  if (!result) {
    if (result.diagnostics().errors.empty()) std::abort();
    (void)to_json(result.diagnostics());
    return 0;
  }
  if (size > 4096) return 0;  // every value is described from the start of its line: enough for small inputs
  fascicle::Diagnostics diagnostics;
  walk(result->root(), diagnostics);
  fascicle::JsonObject object(result->root(), diagnostics);
  object.optional("version");
  object.require("name");
  object.finish();
  (void)to_text(diagnostics);
  return 0;
}
