#include "modules/muscle/import/osim_frames.hpp"

#include <cmath>

#include <fmt/format.h>

#include "engine/content/closest_name.hpp"

namespace fascicle::muscle {
namespace {

// Angles of a rotation matrix as body-fixed x, y, z; the inverse of `rotation_from_xyz`.
glm::dvec3 xyz_from_rotation(const glm::dmat3& r) {
  const double sin_y = r[2][0];
  const double cos_y = std::hypot(r[0][0], r[1][0]);
  const double y = std::atan2(sin_y, cos_y);
  if (cos_y < 1e-12) return {std::atan2(r[0][1], r[1][1]), y, 0.0};
  return {std::atan2(-r[2][1], r[2][2]), y, std::atan2(-r[1][0], r[0][0])};
}

constexpr int kDeepestFrames = 64;

std::string last_part(const std::string& path) { return path.substr(path.rfind('/') + 1); }

}  // namespace

std::string absolute_path(const std::string& path, const std::string& owner) {
  const std::string full = !path.empty() && path.front() == '/' ? path : owner + "/" + path;
  std::vector<std::string> parts;
  std::size_t at = 0;
  while (at < full.size()) {
    const std::size_t end = std::min(full.find('/', at), full.size());
    const std::string part = full.substr(at, end - at);
    if (part == "..") {
      if (!parts.empty()) parts.pop_back();
    } else if (!part.empty() && part != ".") {
      parts.push_back(part);
    }
    at = end + 1;
  }
  std::string result;
  for (const std::string& part : parts) result += "/" + part;
  return result;
}

OsimFrames::OsimFrames(XmlFields& fields, pugi::xml_node model) : fields_(fields) {
  const pugi::xml_node ground = model.child("Ground");
  const std::string ground_name = name_of(ground);
  bodies_.push_back(ground_name.empty() ? "ground" : ground_name);
  body_nodes_.push_back(ground ? ground : model);
  body_paths_["/" + bodies_[0]] = 0;
  collect_offsets(ground.child("components"), "/" + bodies_[0]);
  for (const pugi::xml_node node : elements(model.child("BodySet").child("objects"))) {
    if (std::string_view(node.name()) != "Body") {
      fields_.error(node, fmt::format("a {} in the set of bodies", node.name()), "only Body belongs here");
      continue;
    }
    const std::string name = name_of(node);
    const std::string path = "/bodyset/" + name;
    if (name.empty() || body_paths_.count(path) != 0 || name == bodies_[0]) {
      fields_.error(node, name.empty() ? "a body without a name" : fmt::format("the body '{}' is there already", name),
                    "give each body its own name");
      continue;
    }
    body_paths_[path] = static_cast<std::int32_t>(bodies_.size());
    bodies_.push_back(name);
    body_nodes_.push_back(node);
    collect_offsets(node.child("components"), path);
  }
  for (const pugi::xml_node joint : elements(model.child("JointSet").child("objects"))) {
    collect_offsets(joint.child("frames"), "/jointset/" + name_of(joint));
  }
  collect_offsets(model.child("ComponentSet").child("objects"), "/componentset");
  collect_offsets(model.child("components"), "");
}

void OsimFrames::collect_offsets(pugi::xml_node parent, const std::string& path) {
  for (const pugi::xml_node node : elements(parent)) {
    if (std::string_view(node.name()) != "PhysicalOffsetFrame") continue;
    const std::string name = path + "/" + name_of(node);
    if (!offsets_.emplace(name, Offset{node, false, std::nullopt}).second) {
      fields_.error(node, fmt::format("the frame '{}' is there already", name),
                    "give each frame of a component its own name");
      continue;
    }
    if (path.size() < 1000) collect_offsets(node.child("components"), name);
  }
}

std::string OsimFrames::find_path(const std::string& text, const std::string& owner) const {
  // Early files of version 4 give paths relative to the owner's parent, or a body's bare name.
  const std::string parent = owner.substr(0, owner.rfind('/'));
  for (const std::string& path : {absolute_path(text, owner), absolute_path(text, parent),
                                  fmt::format("/bodyset/{}", last_part(text)), fmt::format("/{}", last_part(text))}) {
    if (body_paths_.count(path) != 0 || offsets_.count(path) != 0) return path;
  }
  return {};
}

std::optional<OsimFrame> OsimFrames::resolve(pugi::xml_node socket, const std::string& owner) {
  const std::string text =
      split_words(socket.child_value()).empty() ? std::string() : split_words(socket.child_value())[0];
  const std::string path = text.empty() ? std::string() : find_path(text, owner);
  if (path.empty()) {
    fields_.error(socket, text.empty() ? "it names no frame" : fmt::format("there is no frame '{}'", text),
                  suggest_name(last_part(text), bodies_, "bodies"));
    return std::nullopt;
  }
  return frame_at(path);
}

std::optional<OsimFrame> OsimFrames::find(const std::string& path) {
  if (body_paths_.count(path) == 0 && offsets_.count(path) == 0) return std::nullopt;
  return frame_at(path);
}

std::optional<OsimFrame> OsimFrames::frame_at(const std::string& path) {
  if (const auto body = body_paths_.find(path); body != body_paths_.end()) return OsimFrame{body->second, {}, {}, {}};
  Offset& offset = offsets_.at(path);
  if (offset.frame) return offset.frame;
  if (offset.visiting || depth_ >= kDeepestFrames) {
    fields_.error(offset.node, offset.visiting ? fmt::format("the frame '{}' is fixed to itself, in a circle", path)
                                               : fmt::format("more than {} frames stand on each other", kDeepestFrames),
                  "let its socket_parent lead to a body or the ground");
    return std::nullopt;
  }
  offset.visiting = true;
  OsimFrame frame;
  bool right = fields_.vector(offset.node, "translation", frame.translation);
  right = fields_.vector(offset.node, "orientation", frame.orientation) && right;
  const pugi::xml_node socket = offset.node.child("socket_parent");
  if (!socket) {
    fields_.error(offset.node, "an offset frame without socket_parent", "name the body that it is fixed to");
    return std::nullopt;
  }
  ++depth_;
  const std::optional<OsimFrame> base = resolve(socket, path);
  --depth_;
  if (!right || !base) return std::nullopt;  // still `visiting`: a later use of it is reported as well
  offset.visiting = false;
  frame.body = base->body;
  frame.transform = {rotation_from_xyz(frame.orientation), frame.translation};
  const bool on_body = base->translation == glm::dvec3(0.0) && base->orientation == glm::dvec3(0.0);
  if (!on_body) {
    frame.transform = base->transform * frame.transform;
    frame.translation = frame.transform.translation;
    frame.orientation = xyz_from_rotation(frame.transform.rotation);
  }
  offset.frame = frame;
  return frame;
}

}  // namespace fascicle::muscle
