// Any bytes as a character file and as a scene file, through everything that the loader does short of opening other
// files: parse, migrate, read, resolve on a joint skeleton, build. Whatever is accepted must be finite and in range.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "engine/animation/joint_model.hpp"
#include "engine/animation/joint_model_reader.hpp"
#include "engine/content/json_reader.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/content/character_file.hpp"
#include "modules/muscle/content/migrate.hpp"
#include "modules/muscle/content/resolve_muscles.hpp"
#include "modules/muscle/content/scene_file.hpp"

namespace {

using namespace fascicle;
using namespace fascicle::muscle;

void require(bool condition) {
  if (!condition) std::abort();
}

Result<JsonDocument> current(const JsonDocument& document, ContentKind kind) {
  Result<JsonDocument> migrated = migrate(document, kind);
  require(migrated.ok() || !migrated.diagnostics().errors.empty());
  if (!migrated) return migrated;
  const Result<JsonDocument> again = migrate(*migrated, kind);  // a migrated file is a current one
  require(again.ok() && again->text() == migrated->text());
  return migrated;
}

void build(const CharacterFile& file, Diagnostics& diagnostics) {
  if (!file.joints.exists()) return;
  const Result<JointModel> joints = read_joint_model(file.joints);
  if (!joints) return;
  const Skeleton& skeleton = *joints->skeleton;
  // Level of detail is bounded here, for speed only.
  const LoadOptions options{.section_vertices = 6, .longitudinal_subdivision = 1};
  MuscleNames names;
  std::vector<ResolvedMuscle> resolved;
  resolve_muscles(file, skeleton, options, names, resolved, diagnostics);
  if (!diagnostics.ok() || resolved.empty()) return;
  std::vector<MuscleDescription> descriptions;
  for (ResolvedMuscle& muscle : resolved) descriptions.push_back(std::move(muscle.description));
  const auto asset = build_muscle_asset(descriptions, skeleton.rest_world);
  if (!asset) {
    require(!asset.diagnostics().errors.empty());
    return;
  }
  for (const auto* values : {&(*asset)->rest_x, &(*asset)->rest_y, &(*asset)->rest_z, &(*asset)->rest_radii}) {
    for (const float value : *values) require(std::isfinite(value));
  }
  for (const std::uint32_t index : (*asset)->strip_indices) {
    require(index == kRestartIndex || index < (*asset)->vertex_count);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Result<JsonDocument> document = parse_json(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  if (!document) return 0;
  if (const auto character = current(*document, ContentKind::kCharacter)) {
    Diagnostics diagnostics;
    const CharacterFile file = read_character_file(character->root(), {diagnostics});
    build(file, diagnostics);
  }
  if (const auto scene = current(*document, ContentKind::kScene)) {
    Diagnostics diagnostics;
    const SceneFile file = read_scene_file(scene->root(), {diagnostics});
    require(std::isfinite(file.values.step_hz) && std::isfinite(file.values.camera.distance));
  }
  return 0;
}
