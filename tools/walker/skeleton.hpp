// The walker's bones as a tree of frames, with gait2392's proportions in its default (anatomical) pose: at rest every
// frame is parallel to the character's, so that a rest pose is translations only.
// Joint places: S. L. Delp et al., An interactive graphics-based model of the lower extremity to study orthopaedic
// surgical procedures, IEEE Trans. Biomed. Eng. 37 (1990), as refined in the gait2392 model; tibiofemoral motion after
// G. T. Yamaguchi and F. E. Zajac, J. Biomech. 22 (1989).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace fascicle::walker {

// OpenSim has x forward, y up, z right; glTF x left, y up, z forward: a rotation (method 1.7).
inline glm::vec3 from_opensim(const glm::vec3& p) { return {-p.z, p.y, p.x}; }
// The same, of a place given in millimetres.
inline glm::vec3 from_opensim_mm(float x, float y, float z) { return 0.001f * glm::vec3(-z, y, x); }

struct Bone {
  std::string name;
  int parent = -1;
  glm::vec3 offset{0.0f};  // m, to the parent's frame at rest
  glm::vec3 place{0.0f};   // m, of the frame's origin in the character's space at rest
};

// A parent stands before its children; right bones end in _r, left ones in _l.
const std::vector<Bone>& bones();
// Index of a bone; asserts that it exists.
int find_bone(std::string_view name);
// The bone of the other side, or the same one where there is one only.
int mirrored_bone(int bone);
std::string mirrored_name(const std::string& name);

// Place of the tibia's frame in the femur's (m, glTF axes) at a knee angle (rad, flexion negative).
glm::vec3 tibia_in_femur(float knee_angle);
// Upper pole of the patella in the tibia's frame (m, glTF axes) at a knee angle: where rectus femoris inserts.
glm::vec3 patella_pole_in_tibia(float knee_angle);

// One pose: per bone the rotation and translation to its parent.
struct Pose {
  std::vector<glm::quat> rotation;
  std::vector<glm::vec3> translation;
};
Pose rest_pose();

struct Placed {
  std::vector<glm::quat> rotation;  // bone to character
  std::vector<glm::vec3> place;
};
Placed place_bones(const Pose& pose);

}  // namespace fascicle::walker
