// The shape of a glTF document as a table of rules, checked before tinygltf sees it: tinygltf drops what it cannot read
// without a word, and the later stages rely on every index and number being in range.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "engine/content/closest_name.hpp"
#include "engine/content/gltf_source.hpp"

namespace fascicle::detail {
namespace {

enum class Check : std::uint8_t { kObject, kArray, kString, kBoolean, kInteger, kNumbers, kReference, kChoice };

// `pattern`: a JSON pointer in which * stands for every element or member. The last step may be absent unless
// `required`. min and max limit integers, and the number of elements of kNumbers; `names` is the section that
// references point to, or the choices separated by spaces.
struct Rule {
  std::string_view pattern;
  Check check;
  bool required = false;
  double min = 0.0;
  double max = 4294967295.0;  // all that tinygltf takes
  std::string_view names = {};
};

constexpr double kMaxInt = 2147483647.0;
constexpr double kComponentMin = 5120.0, kComponentMax = 5126.0;

constexpr auto kRules = std::to_array<Rule>({
    {"/asset", Check::kObject, true},
    {"/asset/version", Check::kString, true},
    {"/extensionsRequired", Check::kArray},
    {"/extensionsRequired/*", Check::kString, true},
    {"/buffers", Check::kArray},
    {"/buffers/*", Check::kObject},
    {"/buffers/*/byteLength", Check::kInteger, true, 1.0},
    {"/buffers/*/uri", Check::kString},
    {"/bufferViews", Check::kArray},
    {"/bufferViews/*", Check::kObject},
    {"/bufferViews/*/buffer", Check::kReference, true, 0, 0, "buffers"},
    {"/bufferViews/*/byteOffset", Check::kInteger},
    {"/bufferViews/*/byteLength", Check::kInteger, true, 1.0},
    {"/bufferViews/*/byteStride", Check::kInteger, false, 4.0, 252.0},
    {"/accessors", Check::kArray},
    {"/accessors/*", Check::kObject},
    {"/accessors/*/bufferView", Check::kReference, false, 0, 0, "bufferViews"},
    {"/accessors/*/byteOffset", Check::kInteger},
    {"/accessors/*/componentType", Check::kInteger, true, kComponentMin, kComponentMax},
    {"/accessors/*/count", Check::kInteger, true, 1.0},
    {"/accessors/*/normalized", Check::kBoolean},
    {"/accessors/*/type", Check::kChoice, true, 0, 0, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    {"/accessors/*/sparse", Check::kObject},
    {"/accessors/*/sparse/count", Check::kInteger, true, 1.0, kMaxInt},
    {"/accessors/*/sparse/indices", Check::kObject, true},
    {"/accessors/*/sparse/indices/bufferView", Check::kReference, true, 0, 0, "bufferViews"},
    {"/accessors/*/sparse/indices/byteOffset", Check::kInteger, false, 0.0, kMaxInt},
    {"/accessors/*/sparse/indices/componentType", Check::kInteger, true, kComponentMin, kComponentMax},
    {"/accessors/*/sparse/values", Check::kObject, true},
    {"/accessors/*/sparse/values/bufferView", Check::kReference, true, 0, 0, "bufferViews"},
    {"/accessors/*/sparse/values/byteOffset", Check::kInteger, false, 0.0, kMaxInt},
    {"/materials", Check::kArray},
    {"/materials/*", Check::kObject},
    {"/materials/*/pbrMetallicRoughness", Check::kObject},
    {"/materials/*/pbrMetallicRoughness/baseColorFactor", Check::kNumbers, false, 4.0, 4.0},
    {"/meshes", Check::kArray},
    {"/meshes/*", Check::kObject},
    {"/meshes/*/name", Check::kString},
    {"/meshes/*/primitives", Check::kArray, true},
    {"/meshes/*/primitives/*", Check::kObject},
    {"/meshes/*/primitives/*/attributes", Check::kObject, true},
    {"/meshes/*/primitives/*/attributes/*", Check::kReference, true, 0, 0, "accessors"},
    {"/meshes/*/primitives/*/indices", Check::kReference, false, 0, 0, "accessors"},
    {"/meshes/*/primitives/*/material", Check::kReference, false, 0, 0, "materials"},
    {"/meshes/*/primitives/*/mode", Check::kInteger, false, 0.0, 6.0},
    {"/nodes", Check::kArray},
    {"/nodes/*", Check::kObject},
    {"/nodes/*/name", Check::kString},
    {"/nodes/*/children", Check::kArray},
    {"/nodes/*/children/*", Check::kReference, true, 0, 0, "nodes"},
    {"/nodes/*/mesh", Check::kReference, false, 0, 0, "meshes"},
    {"/nodes/*/skin", Check::kReference, false, 0, 0, "skins"},
    {"/nodes/*/matrix", Check::kNumbers, false, 16.0, 16.0},
    {"/nodes/*/translation", Check::kNumbers, false, 3.0, 3.0},
    {"/nodes/*/rotation", Check::kNumbers, false, 4.0, 4.0},
    {"/nodes/*/scale", Check::kNumbers, false, 3.0, 3.0},
    {"/skins", Check::kArray},
    {"/skins/*", Check::kObject},
    {"/skins/*/name", Check::kString},
    {"/skins/*/inverseBindMatrices", Check::kReference, false, 0, 0, "accessors"},
    {"/skins/*/joints", Check::kArray, true},
    {"/skins/*/joints/*", Check::kReference, true, 0, 0, "nodes"},
    {"/animations", Check::kArray},
    {"/animations/*", Check::kObject},
    {"/animations/*/name", Check::kString},
    {"/animations/*/samplers", Check::kArray, true},
    {"/animations/*/samplers/*", Check::kObject},
    {"/animations/*/samplers/*/input", Check::kReference, true, 0, 0, "accessors"},
    {"/animations/*/samplers/*/output", Check::kReference, true, 0, 0, "accessors"},
    {"/animations/*/samplers/*/interpolation", Check::kChoice, false, 0, 0, "LINEAR STEP CUBICSPLINE"},
    {"/animations/*/channels", Check::kArray, true},
    {"/animations/*/channels/*", Check::kObject},
    {"/animations/*/channels/*/sampler", Check::kInteger, true, 0.0, kMaxInt},
    {"/animations/*/channels/*/target", Check::kObject, true},
    {"/animations/*/channels/*/target/node", Check::kReference, false, 0, 0, "nodes"},
    {"/animations/*/channels/*/target/path", Check::kString, true},
});

// Extensions that change how geometry or poses are stored, and that this reader follows; all KHR_materials_* are fine,
// too, since materials only give a colour.
constexpr auto kKnownExtensions =
    std::to_array<std::string_view>({"KHR_mesh_quantization", "KHR_texture_transform", "KHR_lights_punctual",
                                     "KHR_texture_basisu", "EXT_texture_webp", "KHR_xmp_json_ld"});

class ShapeChecker {
 public:
  explicit ShapeChecker(GltfSource& source) : source_(source), root_(source.document->root()) {}

  void check() {
    if (!root_.require_object(found_)) return finish();
    for (const Rule& rule : kRules) expand(root_, rule.pattern, rule);
    if (found_.ok()) check_versions();
    finish();
  }

 private:
  void expand(JsonNode node, std::string_view pattern, const Rule& rule) {
    if (pattern.empty()) return check_value(node, rule);
    pattern.remove_prefix(1);
    const std::string_view step = pattern.substr(0, pattern.find('/'));
    const std::string_view rest = pattern.substr(step.size());
    if (step == "*") {
      for (const JsonNode child : node) expand(child, rest, rule);
      return;
    }
    if (!node.is_object()) return;  // an error of an earlier rule
    const JsonNode child = node.member(step);
    if (child.exists()) return expand(child, rest, rule);
    if (rest.empty() && rule.required)
      node.error(found_, fmt::format("'{}' is missing", step), fmt::format("add \"{}\"", step));
  }

  void check_value(JsonNode node, const Rule& rule) {
    std::string text;
    bool boolean = false;
    switch (rule.check) {
      case Check::kObject:
        node.require_object(found_);
        break;
      case Check::kArray:
        node.require_array(found_);
        break;
      case Check::kString:
        node.read(text, found_);
        break;
      case Check::kBoolean:
        node.read(boolean, found_);
        break;
      case Check::kInteger:
        check_integer(node, rule.min, rule.max);
        break;
      case Check::kNumbers:
        check_numbers(node, rule);
        break;
      case Check::kReference:
        check_reference(node, rule.names);
        break;
      case Check::kChoice:
        check_choice(node, rule.names);
        break;
    }
  }

  bool check_integer(JsonNode node, double min, double max) {
    double number = 0.0;
    if (!node.read(number, found_)) return false;
    if (node.text().find_first_of(".eE") != std::string_view::npos) {
      node.error(found_, fmt::format("{} is not a whole number", node.text()), "write it in digits only");
      return false;
    }
    return node.read(number, found_, between(min, max));
  }

  void check_reference(JsonNode node, std::string_view section) {
    if (!check_integer(node, 0.0, kMaxInt)) return;
    std::uint32_t index = 0;
    node.read(index, found_);
    const std::size_t size = root_.member(section).size();
    if (index >= size) {
      node.error(found_, fmt::format("{} is not an index into {}", index, section),
                 fmt::format("there are {}, counted from 0", size));
    }
  }

  void check_numbers(JsonNode node, const Rule& rule) {
    std::vector<float> numbers;
    if (node.require_array(found_, static_cast<std::size_t>(rule.min), static_cast<std::size_t>(rule.max)))
      node.read(numbers, found_);
  }

  void check_choice(JsonNode node, std::string_view names) {
    std::vector<std::string_view> choices;
    while (!names.empty()) {
      choices.push_back(names.substr(0, names.find(' ')));
      names.remove_prefix(std::min(names.size(), choices.back().size() + 1));
    }
    std::size_t choice = 0;
    node.read_choice(choice, found_, choices);
  }

  void check_versions() {
    const JsonNode version = root_.member("asset").member("version");
    std::string text;
    version.read(text, found_);
    if (!text.starts_with("2.")) version.error(found_, fmt::format("glTF version '{}'", text), "export as glTF 2.0");
    for (const JsonNode extension : root_.member("extensionsRequired")) {
      extension.read(text, found_);
      if (text.starts_with("KHR_materials_") || std::ranges::find(kKnownExtensions, text) != kKnownExtensions.end())
        continue;
      extension.error(found_, fmt::format("the extension {} is not supported", text),
                      "export without it (no mesh compression)");
    }
  }

  void finish() {
    for (Diagnostic& diagnostic : found_.errors) {
      if (!source_.has_positions) diagnostic.line = diagnostic.column = 0;
    }
    source_.diagnostics.append(std::move(found_));
  }

  GltfSource& source_;
  JsonNode root_;
  Diagnostics found_;
};

}  // namespace

void check_gltf_shape(GltfSource& source) { ShapeChecker(source).check(); }

}  // namespace fascicle::detail
