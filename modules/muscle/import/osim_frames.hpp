// The frames of an OpenSim model: ground, bodies, and offset frames (of offset frames) on them, by their paths.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/animation/joint_model.hpp"
#include "modules/muscle/import/xml_fields.hpp"

namespace fascicle::muscle {

// A frame as fixed to a body (numbered in file order, 0: ground). `translation` and `orientation` are the file's own
// figures where the frame stands on the body directly; else they are worked out.
struct OsimFrame {
  std::int32_t body = 0;
  glm::dvec3 translation{0.0};
  glm::dvec3 orientation{0.0};  // rad, body-fixed x, y, z
  RigidTransform transform;     // the same, to the body's frame
};

class OsimFrames {
 public:
  // Collects every frame of the model; bodies in file order.
  OsimFrames(XmlFields& fields, pugi::xml_node model);

  const std::vector<std::string>& bodies() const { return bodies_; }  // names, 0: ground
  const std::vector<pugi::xml_node>& body_nodes() const { return body_nodes_; }

  // The frame that a socket element names, seen from the component at `owner` ("/jointset/hip_r"). Appends an error and
  // returns nothing where it names none.
  std::optional<OsimFrame> resolve(pugi::xml_node socket, const std::string& owner);
  // The frame at an absolute path; nothing where there is none, or (with an error) where it is wrong.
  std::optional<OsimFrame> find(const std::string& path);

 private:
  struct Offset {
    pugi::xml_node node;
    bool visiting = false;
    std::optional<OsimFrame> frame;
  };
  void collect_offsets(pugi::xml_node parent, const std::string& path);
  std::string find_path(const std::string& text, const std::string& owner) const;
  std::optional<OsimFrame> frame_at(const std::string& path);

  XmlFields& fields_;
  std::vector<std::string> bodies_;
  std::vector<pugi::xml_node> body_nodes_;
  std::map<std::string, std::int32_t> body_paths_;
  std::map<std::string, Offset> offsets_;
  int depth_ = 0;  // of frames on frames, while one is worked out
};

// An absolute path from one that may be relative to `owner` ("../../bodyset/pelvis").
std::string absolute_path(const std::string& path, const std::string& owner);

}  // namespace fascicle::muscle
