// A scene of scratch_surfaces.hpp's limb: its knee bends, and the ball on it is posed by a coarse hull.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "modules/muscle/content/scene_asset.hpp"
#include "tests/modules/muscle/content/scratch_surfaces.hpp"

namespace fascicle::cook {

// One angle of the knee (rad) a step of 1/60 s.
inline std::filesystem::path write_knee_motion(const test::ScratchFolder& folder, const std::string& name,
                                               const std::vector<double>& angles) {
  std::string text = fmt::format("knees\nversion=1\nnRows={}\nnColumns=2\ninDegrees=no\nendheader\ntime\tknee\n",
                                 angles.size());
  for (std::size_t i = 0; i < angles.size(); ++i) text += fmt::format("{}\t{}\n", static_cast<double>(i) / 60.0, angles[i]);
  return folder.write(name, text);
}

// A step an angle. The motion's ends are those of no step: a player is at its start before the first, and goes on from
// there after its end.
inline std::shared_ptr<const muscle::SceneAsset> load_posed_limb(const test::ScratchFolder& folder,
                                                                 std::vector<double> angles) {
  std::string text = test::with(std::string(test::kLimb), R"("coordinates": [])",
                                R"("coordinates": [{ "name": "knee", "kind": "rotation", "range": [-1, 1] }])");
  text = test::with(text, R"("parent_frame": { "translation": [0, -0.2, 0.15] })",
                    R"("parent_frame": { "translation": [0, -0.2, 0.15] },
        "rotations": [{ "axis": [1, 0, 0], "coordinate": "knee" }])");
  text = test::with(text, R"("driver": "calf_r")", R"("solver": "coarse_hull", "hull": { "vertices": 60 },
      "action_line": [{ "bone": "trunk", "at": [-150, 95, 10] }, { "bone": "shin_r", "at": [-150, -95, 0] }])");
  test::write_limb(folder, text);
  const std::size_t frames = angles.size();
  angles.insert(angles.begin(), 0.0);
  angles.push_back(0.0);
  write_knee_motion(folder, "knee.mot", angles);
  const auto file = folder.write("limb.scene.json", fmt::format(R"({{ "version": 1, "name": "limb", "frames": {},
    "characters": [{{ "file": "limb.character.json", "animation": {{ "motion": "knee.mot", "loop": "record" }} }}] }})",
                                                                frames));
  const auto scene = muscle::load_scene(file);
  EXPECT_TRUE(scene.ok()) << to_text(scene.diagnostics());
  return scene.ok() ? *scene : nullptr;
}

}  // namespace fascicle::cook
