#include "modules/muscle/content/hull_store.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/content/file_text.hpp"
#include "engine/content/json_reader.hpp"
#include "engine/content/quote_json.hpp"
#include "engine/math/state_hash.hpp"
#include "modules/muscle/asset/muscle_limits.hpp"

namespace fascicle::muscle {
namespace {

namespace fs = std::filesystem;

constexpr std::int32_t kStoreVersion = 1;
constexpr std::size_t kMostMuscles = 100000;
constexpr std::size_t kMostNumbers = 3'000'000;
constexpr const char* kWriteAnew = "write the file anew with fascicle-cook hull --store";

void add_mesh(const TriangleMesh& mesh, StateHash& hash) {
  hash.add(mesh.positions.size());
  hash.add(std::span(mesh.positions));
  hash.add(mesh.indices.size());
  hash.add(std::span(mesh.indices));
}

// Of all that is stored of a muscle: what somebody changed by hand no longer fits its inputs.
std::uint64_t hash_values(const StoredHull& stored) {
  StateHash hash;
  add_mesh(stored.hull.mesh, hash);
  hash.add(stored.hull.volume);
  hash.add(stored.hull.fine_volume);
  hash.add(stored.hull.distance);
  return hash.value();
}

bool read_hash(const JsonNode& node, std::uint64_t& hash, Diagnostics& diagnostics) {
  std::string text;
  if (!node.exists() || !node.read(text, diagnostics)) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (error == std::errc{} && end == text.data() + text.size() && text.size() == 16) return true;
  node.error(diagnostics, fmt::format("'{}' is no hash", text), "16 hexadecimal digits stand here");
  return false;
}

void read_mesh_of(JsonObject& object, TriangleMesh& mesh, Diagnostics& diagnostics) {
  std::vector<float> places;
  if (const JsonNode list = object.require_array("positions", 3 * kFewestHullVertices, kMostNumbers); list.exists()) {
    list.read(places, diagnostics, kPositionRange);
  }
  const JsonNode triangles = object.require_array("triangles", 12, kMostNumbers);
  for (const JsonNode corner : triangles) {
    std::uint32_t index = 0;
    if (corner.read(index, diagnostics)) mesh.indices.push_back(index);
  }
  for (std::size_t i = 0; i + 2 < places.size(); i += 3) mesh.positions.emplace_back(places[i], places[i + 1], places[i + 2]);
  if (places.empty() || mesh.indices.empty()) return;  // said already
  const std::uint32_t last = *std::ranges::max_element(mesh.indices);
  if (places.size() % 3 != 0 || mesh.indices.size() % 3 != 0 || last >= mesh.positions.size()) {
    triangles.error(diagnostics,
                    fmt::format("{} numbers of positions and {} corners up to {} are no triangles", places.size(),
                                mesh.indices.size(), last), kWriteAnew);
  }
}

void read_muscle(const JsonNode& node, HullStore& store, Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors.size();
  JsonObject object(node, diagnostics);
  std::string name;
  StoredHull stored;
  std::uint64_t values = 0;
  object.require("name", name);
  read_hash(object.require("inputs"), stored.inputs, diagnostics);
  const JsonNode stored_values = object.require("values");
  read_hash(stored_values, values, diagnostics);
  object.require("volume", stored.hull.volume, above(0));
  object.require("fine_volume", stored.hull.fine_volume, above(0));
  object.require("distance", stored.hull.distance, at_least(0));
  read_mesh_of(object, stored.hull.mesh, diagnostics);
  object.finish();
  if (diagnostics.errors.size() != errors_before) return;
  stored.hull.mesh.name = name;
  if (values != hash_values(stored)) {
    stored_values.error(diagnostics, fmt::format("the hull of '{}' is not as it was written", name), kWriteAnew);
  }
  if (!store.emplace(name, std::move(stored)).second) {
    node.error(diagnostics, fmt::format("a second muscle '{}'", name), kWriteAnew);
  }
}

}  // namespace

fs::path hull_store_of(const fs::path& character_file) {
  std::string name = character_file.filename().string();
  for (const std::string_view ending : {".json", ".character"}) {
    if (name.ends_with(ending) && name.size() > ending.size()) name.resize(name.size() - ending.size());
  }
  return character_file.parent_path() / (name + ".hulls.json");
}

std::uint64_t hull_inputs(const TriangleMesh& mesh, const HullTarget& target) {
  StateHash hash;
  hash.add(kHullVersion);
  add_mesh(mesh, hash);
  hash.add(target.vertices);
  hash.add(target.error);
  return hash.value();
}

Result<HullStore> parse_hull_store(std::string text, std::string file_name) {
  const Result<JsonDocument> document = parse_json(std::move(text), std::move(file_name));
  if (!document) return document.diagnostics();
  Diagnostics diagnostics;
  HullStore store;
  JsonObject object(document->root(), diagnostics);
  std::int32_t version = 0;
  std::string note;
  object.optional("note", note);
  if (object.require("version", version) && version != kStoreVersion) {
    object.node().error(diagnostics, fmt::format("the stored hulls have version {}", version), kWriteAnew);
    return diagnostics;
  }
  for (const JsonNode muscle : object.require_array("muscles", 0, kMostMuscles)) {
    read_muscle(muscle, store, diagnostics);
  }
  object.finish();
  if (!diagnostics.ok()) return diagnostics;
  return store;
}

Result<HullStore> read_hull_store(const fs::path& file) {
  Result<std::string> text = read_text_file(file);
  if (!text) return text.diagnostics();
  return parse_hull_store(std::move(*text), file.string());
}

std::string write_hull_store(const HullStore& store) {
  std::string out = fmt::format(
      "{{\n  \"version\": {},\n  \"note\": \"Written by fascicle-cook hull --store; where it is out of date or lost, "
      "hulls are made at load.\",\n  \"muscles\": [",
      kStoreVersion);
  const auto to = std::back_inserter(out);
  bool first = true;
  for (const auto& [name, stored] : store) {
    const ProgressiveHull& hull = stored.hull;
    fmt::format_to(to, "{}\n    {{ \"name\": {}, \"inputs\": \"{:016x}\", \"values\": \"{:016x}\",\n      \"volume\": {}, "
                       "\"fine_volume\": {}, \"distance\": {},\n      \"positions\": [", first ? "" : ",", quote_json(name),
                   stored.inputs, hash_values(stored), hull.volume, hull.fine_volume, hull.distance);
    first = false;
    for (std::size_t v = 0; v < hull.mesh.positions.size(); ++v) {
      const glm::vec3& p = hull.mesh.positions[v];
      fmt::format_to(to, "{}{}, {}, {}", v == 0 ? "" : ", ", p.x, p.y, p.z);
    }
    fmt::format_to(to, "],\n      \"triangles\": [{}] }}", fmt::join(hull.mesh.indices, ", "));
  }
  out += "\n  ]\n}\n";
  return out;
}

}  // namespace fascicle::muscle
