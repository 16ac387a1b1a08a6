#include "modules/muscle/content/fit_store.hpp"

#include <array>
#include <charconv>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

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
constexpr std::size_t kMostSections = (kMostViaPoints + 1) * 64 + 1;


// --- reading ---

// Of all that is stored of a muscle: what somebody changed by hand no longer fits its inputs.
std::uint64_t hash_values(const MuscleFits& fits) {
  StateHash hash;
  for (const FittedLevel& level : fits.levels) {
    hash.add(level.section_vertices);
    hash.add(level.longitudinal_subdivision);
    const MuscleFit& fit = level.fitted.fit;
    hash.add(std::span(fit.displacements));
    hash.add(fit.displacements.size());
    hash.add(std::span(fit.radii));
    hash.add(fit.radii.size());
    for (const auto& normal : fit.end_normals) hash.add(normal.value_or(glm::vec3(0.0f)));
    for (const SectionReport& section : level.fitted.sections) {
      hash.add(std::array{section.hits, section.misses, section.matches, section.loops});
      hash.add(section.moved);
      hash.add(std::array{section.inside, section.rescued});
      hash.add(section.outcome);
    }
  }
  return hash.value();
}

bool read_hash(const JsonNode& node, std::uint64_t& hash, Diagnostics& diagnostics) {
  std::string text;
  if (!node.read(text, diagnostics)) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (error == std::errc{} && end == text.data() + text.size() && text.size() == 16) return true;
  node.error(diagnostics, fmt::format("'{}' is no hash", text), "16 hexadecimal digits stand here");
  return false;
}

std::optional<SectionReport> read_section(const JsonNode& node, Diagnostics& diagnostics) {
  SectionReport section;
  JsonObject object(node, diagnostics);
  bool sound = object.require("hits", section.hits);
  sound = object.require("misses", section.misses) && sound;
  sound = object.require("matches", section.matches) && sound;
  sound = object.require("loops", section.loops) && sound;
  sound = object.require("moved", section.moved, between(0, 1000)) && sound;
  sound = object.require("inside", section.inside) && sound;
  sound = object.require("rescued", section.rescued) && sound;
  std::size_t outcome = 0;
  sound = object.require_choice("outcome", outcome,
                                {kOutcomeNames[0], kOutcomeNames[1], kOutcomeNames[2], kOutcomeNames[3]}) &&
          sound;
  object.finish();
  section.outcome = static_cast<SectionOutcome>(outcome);
  return sound ? std::optional(section) : std::nullopt;
}

void read_end_normals(const JsonNode& list, MuscleFit& fit, Diagnostics& diagnostics) {
  if (!list.exists() || !list.require_array(diagnostics, 2, 2)) return;
  std::size_t end = 0;
  for (const JsonNode node : list) {
    glm::vec3 normal(0.0f);
    if (node.kind() != JsonKind::kNull && node.read(normal, diagnostics, between(-1.001, 1.001))) {
      fit.end_normals[end] = normal;
    }
    ++end;
  }
}

void read_level(const JsonNode& node, FittedLevel& level, Diagnostics& diagnostics) {
  JsonObject object(node, diagnostics);
  object.require("section_vertices", level.section_vertices, kSectionVerticesRange);
  object.require("longitudinal_subdivision", level.longitudinal_subdivision, kSubdivisionRange);
  std::vector<float> displacements;
  const JsonNode places = object.require_array("displacements", 0, 3 * kMostSections);
  if (places.exists()) places.read(displacements, diagnostics, kPositionRange);
  const JsonNode radii = object.require_array("radii", 0, kMostSections * kMaxSectionVertices);
  if (radii.exists()) radii.read(level.fitted.fit.radii, diagnostics, between(-kRadiusRange.max, kRadiusRange.max));
  read_end_normals(object.optional("end_normals"), level.fitted.fit, diagnostics);
  for (const JsonNode section : object.require_array("sections", 0, kMostSections)) {
    if (const auto read = read_section(section, diagnostics)) level.fitted.sections.push_back(*read);
  }
  object.finish();
  for (std::size_t i = 0; i + 2 < displacements.size(); i += 3) {
    level.fitted.fit.displacements.emplace_back(displacements[i], displacements[i + 1], displacements[i + 2]);
  }
  const std::size_t sections = displacements.size() / 3;
  if (places.exists() && radii.exists() &&
      (displacements.size() % 3 != 0 || level.fitted.fit.radii.size() != sections * level.section_vertices)) {
    node.error(diagnostics,
               fmt::format("{} displacements and {} radii don't fit {} vertices a section", displacements.size(),
                           level.fitted.fit.radii.size(), level.section_vertices),
               "write the file anew with fascicle-cook fit");
  }
}

void read_muscle(const JsonNode& node, FitStore& store, Diagnostics& diagnostics) {
  JsonObject object(node, diagnostics);
  std::string name;
  MuscleFits fits;
  object.require("name", name);
  std::uint64_t values = 0;
  if (const JsonNode hash = object.require("inputs"); hash.exists()) read_hash(hash, fits.inputs, diagnostics);
  const JsonNode stored_values = object.require("values");
  const bool has_values = stored_values.exists() && read_hash(stored_values, values, diagnostics);
  for (const JsonNode level : object.require_array("levels", 1, 8)) {
    read_level(level, fits.levels.emplace_back(), diagnostics);
  }
  // What the fit had to say is said again at each load; where, the loader knows.
  for (const JsonNode warning : object.require_array("warnings", 0, 1000)) {
    JsonObject said(warning, diagnostics);
    Diagnostic told;
    said.require("cause", told.cause);
    said.require("remedy", told.remedy);
    said.finish();
    if (!fits.levels.empty()) fits.levels.front().fitted.diagnostics.warnings.push_back(std::move(told));
  }
  object.finish();
  if (has_values && values != hash_values(fits)) {
    stored_values.error(diagnostics, fmt::format("the fit of '{}' is not as it was written", name),
                        "write the file anew with fascicle-cook fit");
  }
  if (!store.emplace(name, std::move(fits)).second) {
    node.error(diagnostics, fmt::format("a second muscle '{}'", name), "write the file anew with fascicle-cook fit");
  }
}

// --- writing ---

void append_level(const FittedLevel& level, std::string& out) {
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "\n      {{ \"section_vertices\": {}, \"longitudinal_subdivision\": {},\n        \"displacements\": [",
                 level.section_vertices, level.longitudinal_subdivision);
  const MuscleFit& fit = level.fitted.fit;
  for (std::size_t k = 0; k < fit.displacements.size(); ++k) {
    const glm::vec3& mu = fit.displacements[k];
    fmt::format_to(to, "{}{}, {}, {}", k == 0 ? "" : ", ", mu.x, mu.y, mu.z);
  }
  fmt::format_to(to, "],\n        \"radii\": [{}],", fmt::join(fit.radii, ", "));
  if (fit.end_normals[0] || fit.end_normals[1]) {
    out += "\n        \"end_normals\": [";
    for (std::size_t end = 0; end < 2; ++end) {
      const auto& normal = fit.end_normals[end];
      if (end == 1) out += ", ";
      if (normal) fmt::format_to(to, "[{}, {}, {}]", normal->x, normal->y, normal->z);
      else out += "null";
    }
    out += "],";
  }
  out += "\n        \"sections\": [";
  append_json(level.fitted.sections, out);
  out += "] }";
}

}  // namespace

void append_json(std::span<const SectionReport> sections, std::string& out) {
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const SectionReport& section = sections[k];
    fmt::format_to(std::back_inserter(out),
                   "{}\n          {{ \"hits\": {}, \"misses\": {}, \"matches\": {}, \"loops\": {}, \"moved\": {}, "
                   "\"inside\": {}, \"rescued\": {}, \"outcome\": \"{}\" }}",
                   k == 0 ? "" : ",", section.hits, section.misses, section.matches, section.loops, section.moved,
                   section.inside, section.rescued, name_of(section.outcome));
  }
}

fs::path fit_store_of(const fs::path& character_file) {
  std::string name = character_file.filename().string();
  for (const std::string_view ending : {".json", ".character"}) {
    if (name.ends_with(ending) && name.size() > ending.size()) name.resize(name.size() - ending.size());
  }
  return character_file.parent_path() / (name + ".fit.json");
}

Result<FitStore> parse_fit_store(std::string text, std::string file_name) {
  const Result<JsonDocument> document = parse_json(std::move(text), std::move(file_name));
  if (!document) return document.diagnostics();
  Diagnostics diagnostics;
  FitStore store;
  JsonObject object(document->root(), diagnostics);
  std::int32_t version = 0;
  std::string note;
  object.optional("note", note);
  if (object.require("version", version) && version != kStoreVersion) {
    object.node().error(diagnostics, fmt::format("the stored fits have version {}", version),
                        "write the file anew with fascicle-cook fit");
    return diagnostics;
  }
  for (const JsonNode muscle : object.require_array("muscles", 0, kMostMuscles)) {
    read_muscle(muscle, store, diagnostics);
  }
  object.finish();
  if (!diagnostics.ok()) return diagnostics;
  return store;
}

Result<FitStore> read_fit_store(const fs::path& file) {
  Result<std::string> text = read_text_file(file);
  if (!text) return text.diagnostics();
  return parse_fit_store(std::move(*text), file.string());
}

std::string write_fit_store(const FitStore& store) {
  std::string out = fmt::format(
      "{{\n  \"version\": {},\n  \"note\": \"Written by fascicle-cook fit; where it is out of date or lost, muscles "
      "are fitted at load.\",\n  \"muscles\": [",
      kStoreVersion);
  bool first = true;
  for (const auto& [name, fits] : store) {
    fmt::format_to(std::back_inserter(out), "{}\n    {{ \"name\": {}, \"inputs\": \"{:016x}\", \"values\": \"{:016x}\", \"levels\": [",
                   first ? "" : ",", quote_json(name), fits.inputs, hash_values(fits));
    first = false;
    for (std::size_t i = 0; i < fits.levels.size(); ++i) {
      if (i > 0) out += ",";
      append_level(fits.levels[i], out);
    }
    out += "],\n      \"warnings\": [";
    std::size_t told = 0;
    for (const FittedLevel& level : fits.levels) {
      for (const Diagnostic& warning : level.fitted.diagnostics.warnings) {
        fmt::format_to(std::back_inserter(out), "{}\n        {{ \"cause\": {}, \"remedy\": {} }}", told++ == 0 ? "" : ",",
                       quote_json(warning.cause), quote_json(warning.remedy));
      }
    }
    out += "] }";
  }
  out += "\n  ]\n}\n";
  return out;
}

}  // namespace fascicle::muscle
