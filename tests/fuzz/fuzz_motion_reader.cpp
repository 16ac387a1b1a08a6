// Any bytes as a motion of a small model. Whatever is accepted must play finitely, looped or not.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "engine/animation/joint_model_reader.hpp"
#include "engine/animation/motion_reader.hpp"

namespace {

const fascicle::JointModel& model() {
  static const fascicle::JointModel leg = [] {
    const auto document = fascicle::parse_json(R"({ "bodies": [ { "name": "leg" } ],
      "coordinates": [ { "name": "tx", "kind": "translation", "range": [-9, 9] },
                       { "name": "ty", "kind": "translation", "range": [-9, 9] }, { "name": "hip", "range": [-2, 2] } ],
      "joints": [ { "name": "j", "parent": "ground", "child": "leg",
        "rotations": [ { "axis": [0, 0, 1], "coordinate": "hip" } ],
        "translations": [ { "axis": [1, 0, 0], "coordinate": "tx" }, { "axis": [0, 1, 0], "coordinate": "ty" } ] } ] })",
                                               "leg.json");
    return *fascicle::read_joint_model(document->root());
  }();
  return leg;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto motion =
      fascicle::parse_motion(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.mot", model());
  if (!motion) {
    if (motion.diagnostics().errors.empty()) std::abort();
    return 0;
  }
  std::vector<double> values(motion->coordinates);
  for (const double time : {0.0, 0.3, -7.7, 1e5}) {
    for (const bool in_place : {false, true}) {
      fascicle::sample_cycle(*motion, time, in_place, values);
      for (const double value : values) {
        if (!std::isfinite(value)) std::abort();
      }
    }
    fascicle::sample_motion(*motion, time, values);
    for (const double value : values) {
      if (!std::isfinite(value)) std::abort();
    }
  }
  return 0;
}
