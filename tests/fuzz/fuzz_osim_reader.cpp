// Any bytes as an OpenSim model. Whatever is accepted must pose finitely, and what is made of it must read back.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "engine/animation/joint_model_reader.hpp"
#include "modules/muscle/import/import_osim.hpp"
#include "modules/muscle/import/osim_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fascicle;
  const auto model = muscle::parse_osim(std::string(reinterpret_cast<const char*>(data), size), "fuzz.osim");
  if (!model) {
    if (model.diagnostics().errors.empty()) std::abort();
    return 0;
  }
  std::vector<Trs> local(model->joints.skeleton->size());
  for (const double value : {0.0, 0.7, -1e6}) {
    const std::vector<double> values(model->joints.coordinates.size(), value);
    pose_joints(model->joints, values, local);
    for (const Trs& bone : local) {
      if (!std::isfinite(bone.translation.x + bone.translation.y + bone.translation.z)) std::abort();
      if (!(std::abs(glm::length(bone.rotation) - 1.0f) < 1e-3f)) std::abort();
    }
  }
  const auto text = muscle::import_character(*model, {});
  if (!text) {
    if (text.diagnostics().errors.empty()) std::abort();
    return 0;
  }
  const auto document = parse_json(*text, "made.character.json");
  if (!document) std::abort();
  if (!read_joint_model(document->root().member("skeleton").member("joints"))) std::abort();
  return 0;
}
