#include "tools/walker/skeleton.hpp"

#include <array>
#include <cassert>
#include <cstddef>

namespace fascicle::walker {
namespace {

// A natural cubic spline, as the knee's translations are given.
template <std::size_t N>
float natural_spline(const std::array<double, N>& x, const std::array<double, N>& y, double at) {
  std::array<double, N> second{}, sweep{};
  for (std::size_t i = 1; i + 1 < N; ++i) {
    const double s = (x[i] - x[i - 1]) / (x[i + 1] - x[i - 1]);
    const double p = s * second[i - 1] + 2.0;
    second[i] = (s - 1.0) / p;
    const double bend = (y[i + 1] - y[i]) / (x[i + 1] - x[i]) - (y[i] - y[i - 1]) / (x[i] - x[i - 1]);
    sweep[i] = (6.0 * bend / (x[i + 1] - x[i - 1]) - s * sweep[i - 1]) / p;
  }
  second[N - 1] = 0.0;
  for (std::size_t i = N - 1; i-- > 0;) second[i] = i == 0 ? 0.0 : second[i] * second[i + 1] + sweep[i];
  std::size_t k = 0;
  while (k + 2 < N && at > x[k + 1]) ++k;
  const double h = x[k + 1] - x[k], a = (x[k + 1] - at) / h, b = (at - x[k]) / h;
  const double cubic = (a * a * a - a) * second[k] + (b * b * b - b) * second[k + 1];
  return static_cast<float>(a * y[k] + b * y[k + 1] + cubic * h * h / 6.0);
}

std::vector<Bone> make_bones() {
  std::vector<Bone> list;
  const auto add = [&list](const std::string& name, const std::string& parent, const glm::vec3& offset) {
    int index = -1;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i].name == parent) index = static_cast<int>(i);
    assert(parent.empty() || index >= 0);
    list.push_back({name, index, offset, index < 0 ? offset : list[static_cast<std::size_t>(index)].place + offset});
  };
  add("pelvis", "", {0.0f, 0.95f, 0.0f});
  add("torso", "pelvis", from_opensim({-0.1007f, 0.0815f, 0.0f}));
  for (const char* side : {"_r", "_l"}) {
    const float sign = side[1] == 'r' ? 1.0f : -1.0f;
    const auto place = [sign](float x, float y, float z) { return from_opensim({x, y, sign * z}); };
    const std::string s = side;
    add("femur" + s, "pelvis", place(-0.0707f, -0.0661f, 0.0835f));
    add("tibia" + s, "femur" + s, tibia_in_femur(0.0f));
    glm::vec3 pole = patella_pole_in_tibia(0.0f);
    pole.x *= sign;
    add("patella" + s, "tibia" + s, pole);
    add("talus" + s, "tibia" + s, place(0.0f, -0.43f, 0.0f));
    add("foot" + s, "talus" + s, place(-0.04877f, -0.04195f, 0.00792f));
    add("toes" + s, "foot" + s, place(0.1788f, -0.002f, 0.00108f));
  }
  return list;
}

}  // namespace

glm::vec3 tibia_in_femur(float knee_angle) {
  static constexpr std::array<double, 12> kAngleX{-2.0944,   -1.74533, -1.39626, -1.0472,  -0.698132, -0.349066,
                                                  -0.174533, 0.197344, 0.337395, 0.490178, 1.52146,   2.0944};
  static constexpr std::array<double, 12> kX{-0.0032, 0.00179,   0.00411,   0.0041,    0.00212,   -0.001,
                                             -0.0031, -0.005227, -0.005435, -0.005574, -0.005435, -0.00525};
  static constexpr std::array<double, 7> kAngleY{-2.0944, -1.22173, -0.523599, -0.349066, -0.174533, 0.159149, 2.0944};
  static constexpr std::array<double, 7> kY{-0.4226, -0.4082, -0.399, -0.3976, -0.3966, -0.395264, -0.396};
  return from_opensim({natural_spline(kAngleX, kX, knee_angle), natural_spline(kAngleY, kY, knee_angle), 0.0f});
}

glm::vec3 patella_pole_in_tibia(float knee_angle) {
  static constexpr std::array<double, 12> kAngle{-2.0944,   -1.5708,   -1.39626, -1.0472,   -0.698132, -0.526391,
                                                 -0.349066, -0.174533, 0.0,      0.0279253, 0.0872665, 0.174533};
  static constexpr std::array<double, 12> kX{0.0155805, 0.0275081, 0.0307615, 0.0365695, 0.0422074, 0.0450902,
                                             0.048391,  0.0534299, 0.0617576, 0.0633083, 0.066994,  0.0733035};
  static constexpr std::array<double, 12> kY{0.0234116, 0.0251141, 0.0253146, 0.0249184, 0.0242373, 0.0238447,
                                             0.0234197, 0.0227644, 0.020984,  0.0205225, 0.0191754, 0.0159554};
  return from_opensim({natural_spline(kAngle, kX, knee_angle), natural_spline(kAngle, kY, knee_angle), 0.0014f});
}

const std::vector<Bone>& bones() {
  static const std::vector<Bone> list = make_bones();
  return list;
}

int find_bone(std::string_view name) {
  for (std::size_t i = 0; i < bones().size(); ++i)
    if (bones()[i].name == name) return static_cast<int>(i);
  assert(false && "no such bone");
  return -1;
}

std::string mirrored_name(const std::string& name) {
  std::string other = name;
  if (other.size() > 2 && other[other.size() - 2] == '_') {
    if (other.back() == 'r')
      other.back() = 'l';
    else if (other.back() == 'l')
      other.back() = 'r';
  }
  return other;
}

int mirrored_bone(int bone) { return find_bone(mirrored_name(bones()[static_cast<std::size_t>(bone)].name)); }

Pose rest_pose() {
  Pose pose;
  for (const Bone& bone : bones()) {
    pose.rotation.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
    pose.translation.push_back(bone.offset);
  }
  return pose;
}

Placed place_bones(const Pose& pose) {
  Placed placed;
  for (std::size_t i = 0; i < bones().size(); ++i) {
    const int parent = bones()[i].parent;
    if (parent < 0) {
      placed.rotation.push_back(pose.rotation[i]);
      placed.place.push_back(pose.translation[i]);
      continue;
    }
    const auto p = static_cast<std::size_t>(parent);
    placed.rotation.push_back(placed.rotation[p] * pose.rotation[i]);
    placed.place.push_back(placed.place[p] + placed.rotation[p] * pose.translation[i]);
  }
  return placed;
}

}  // namespace fascicle::walker
