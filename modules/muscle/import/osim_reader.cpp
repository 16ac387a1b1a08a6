#include "modules/muscle/import/osim_reader.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "engine/content/closest_name.hpp"
#include "engine/content/file_text.hpp"
#include "modules/muscle/import/osim_frames.hpp"
#include "modules/muscle/import/osim_functions.hpp"
#include "modules/muscle/import/osim_joints.hpp"
#include "modules/muscle/import/xml_fields.hpp"

namespace fascicle::muscle {
namespace {

constexpr int kOldestVersion = 40000;
constexpr int kNewestVersion = 49999;

class OsimReader {
 public:
  OsimReader(std::string_view text, const std::string& file) : text_(text), fields_(text, file) { result_.file = file; }

  Result<OsimModel> read() {
    if (const std::size_t at = find_invalid_utf8(text_); at != std::string_view::npos) {
      fields_.error_at(at, fmt::format("byte 0x{:02x} is not UTF-8", static_cast<unsigned char>(text_[at])),
                       "save the file as UTF-8; is it a text file?");
      return std::move(fields_.diagnostics);
    }
    pugi::xml_document document;
    const pugi::xml_parse_result parsed =
        document.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    if (!parsed) {
      fields_.error_at(static_cast<std::size_t>(std::max<std::ptrdiff_t>(parsed.offset, 0)),
                       fmt::format("this is not XML: {}", parsed.description()), "give an OpenSim model (.osim)");
      return std::move(fields_.diagnostics);
    }
    const pugi::xml_node model = find_model(document);
    if (!model) return std::move(fields_.diagnostics);
    result_.name = name_of(model);
    result_.credits = child_text(model, "credits");

    OsimFrames frames(fields_, model);
    read_osim_joints(fields_, model, frames, result_.joints);
    read_wrap_objects(frames);
    read_geometry(frames);
    read_muscles(model, frames);
    if (!fields_.diagnostics.ok()) return std::move(fields_.diagnostics);
    renumber_bodies(frames.bodies());
    return Result<OsimModel>(std::move(result_), std::move(fields_.diagnostics));
  }

 private:
  pugi::xml_node find_model(const pugi::xml_document& document) {
    const pugi::xml_node root = document.child("OpenSimDocument");
    if (!root) {
      fields_.error(document.document_element(), "this is not an OpenSim document",
                    "give a file whose root is OpenSimDocument");
      return {};
    }
    const int version = root.attribute("Version").as_int(0);
    if (version < kOldestVersion || version > kNewestVersion) {
      fields_.error(root, fmt::format("the document has version {}", root.attribute("Version").value()),
                    "open the model in OpenSim 4 and save it again, which converts it to version 4");
      return {};
    }
    const pugi::xml_node model = root.child("Model");
    if (!model) fields_.error(root, "the document holds no Model", "give a model, not one of its parts");
    return model;
  }

  void read_wrap_objects(const OsimFrames& frames) {
    for (std::size_t b = 0; b < frames.bodies().size(); ++b) {
      for (const pugi::xml_node node : elements(frames.body_nodes()[b].child("WrapObjectSet").child("objects"))) {
        result_.wrap_objects.push_back({name_of(node), node.name(), static_cast<std::int32_t>(b)});
      }
    }
  }

  void read_geometry(OsimFrames& frames) {
    for (std::size_t b = 0; b < frames.bodies().size(); ++b) {
      const pugi::xml_node body = frames.body_nodes()[b];
      OsimFrame own;
      own.body = static_cast<std::int32_t>(b);
      read_attached(body, own);
      const std::string path = (b == 0 ? "/" : "/bodyset/") + frames.bodies()[b];
      for (const pugi::xml_node offset : elements(body.child("components"))) {
        if (std::string_view(offset.name()) != "PhysicalOffsetFrame" || !offset.child("attached_geometry")) continue;
        if (const auto frame = frames.find(path + "/" + name_of(offset))) read_attached(offset, *frame);
      }
    }
  }

  void read_attached(pugi::xml_node owner, const OsimFrame& frame) {
    std::size_t others = 0;
    for (const pugi::xml_node node : elements(owner.child("attached_geometry"))) {
      if (std::string_view(node.name()) != "Mesh") {
        ++others;
        continue;
      }
      bool visible = true;
      fields_.boolean(node.child("Appearance"), "visible", visible);
      OsimGeometry geometry;
      geometry.body = frame.body;
      geometry.file = child_text(node, "mesh_file");
      geometry.translation = frame.translation;
      geometry.orientation = frame.orientation;
      fields_.vector(node, "scale_factors", geometry.scale);
      if (geometry.file.empty()) {
        fields_.error(node, "a mesh without mesh_file", "name its file, or remove the mesh");
      } else if (visible) {
        result_.geometry.push_back(std::move(geometry));
      }
    }
    if (others > 0) {
      fields_.warning(owner,
                      fmt::format("{} piece{} of geometry that {} no mesh left out", others, others == 1 ? "" : "s",
                                  others == 1 ? "is" : "are"),
                      "give a Mesh with a .vtp file to draw it");
    }
  }

  void read_muscles(pugi::xml_node model, OsimFrames& frames) {
    const pugi::xml_node set = model.child("ForceSet");
    std::map<std::string, std::size_t> others;
    for (const pugi::xml_node node : elements(set.child("objects"))) {
      const std::string_view type = node.name();
      if (type.find("Muscle") == std::string_view::npos) {
        ++others[std::string(type)];
      } else {
        read_muscle(node, frames);
      }
    }
    for (const auto& [type, count] : others) {
      fields_.warning(set, fmt::format("{} {} left out", count, type), "only muscles are imported");
    }
    read_groups(set.child("groups"));
  }

  void read_groups(pugi::xml_node groups) {
    std::map<std::string, std::size_t> by_name;
    for (std::size_t m = 0; m < result_.muscles.size(); ++m) by_name[result_.muscles[m].name] = m;
    for (const pugi::xml_node group : elements(groups)) {
      for (const std::string& member : split_words(group.child_value("members"))) {
        const auto found = by_name.find(member);
        if (found != by_name.end()) result_.muscles[found->second].groups.push_back(name_of(group));
      }
    }
  }

  void read_muscle(pugi::xml_node node, OsimFrames& frames) {
    OsimMuscle muscle;
    muscle.name = name_of(node);
    muscle.type = node.name();
    const TextPosition at = fields_.position(node);
    muscle.line = at.line;
    muscle.column = at.column;
    if (muscle.name.empty() || !muscle_names_.insert(muscle.name).second) {
      fields_.error(node, muscle.name.empty() ? "a muscle without a name"
                                              : fmt::format("the muscle '{}' is there already", muscle.name),
                    "give each muscle its own name");
    }
    fields_.number_in(node, "max_isometric_force", 0.0, 1e9, muscle.max_isometric_force);
    fields_.number_in(node, "optimal_fiber_length", 1e-6, 1e3, muscle.optimal_fibre_length);
    fields_.number_in(node, "tendon_slack_length", 0.0, 1e3, muscle.tendon_slack_length);
    fields_.number_in(node, "pennation_angle_at_optimal", 0.0, std::numbers::pi / 2.0, muscle.pennation);

    pugi::xml_node path = node.child("GeometryPath");
    if (!path) path = node.child("path").child("GeometryPath");
    if (!path) {
      fields_.error(node, fmt::format("the muscle '{}' has no GeometryPath", muscle.name),
                    "add one with at least two points");
      return;
    }
    const std::vector<pugi::xml_node> points = elements(path.child("PathPointSet").child("objects"));
    for (const pugi::xml_node point : points) read_point(point, muscle, frames);
    if (points.size() < 2) {
      fields_.error(path, fmt::format("the path has {} point{}", points.size(), points.size() == 1 ? "" : "s"),
                    "give at least an origin and an insertion");
    }
    for (const pugi::xml_node wrap : elements(path.child("PathWrapSet").child("objects"))) read_wrap(wrap, muscle);
    result_.muscles.push_back(std::move(muscle));
  }

  void read_wrap(pugi::xml_node node, OsimMuscle& muscle) {
    const std::string name = child_text(node, "wrap_object");
    std::vector<std::string> known;
    for (const OsimWrapObject& object : result_.wrap_objects) known.push_back(object.name);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      fields_.error(node, fmt::format("there is no wrap object '{}'", name), suggest_name(name, known, "wrap objects"));
    } else {
      muscle.wraps.push_back(name);
    }
  }

  void read_point(pugi::xml_node node, OsimMuscle& muscle, OsimFrames& frames) {
    const std::string_view type = node.name();
    OsimPathPoint point;
    point.name = name_of(node);
    if (type == "PathPoint") {
      point.kind = OsimPathPoint::Kind::kFixed;
    } else if (type == "ConditionalPathPoint") {
      point.kind = OsimPathPoint::Kind::kConditional;
    } else if (type == "MovingPathPoint") {
      point.kind = OsimPathPoint::Kind::kMoving;
    } else {
      fields_.error(node, fmt::format("the path point type {} is not supported", type),
                    "use PathPoint, ConditionalPathPoint or MovingPathPoint");
      return;
    }
    const std::string owner = "/forceset/" + muscle.name + "/geometrypath/" + point.name;
    const pugi::xml_node socket = node.child("socket_parent_frame");
    if (!socket) {
      fields_.error(node, "a path point without socket_parent_frame", "name the body that it is fixed to");
      return;
    }
    const std::optional<OsimFrame> frame = frames.resolve(socket, owner);
    if (frame) {
      point.body = frame->body;
      point.frame = frame->transform;
    }
    if (point.kind == OsimPathPoint::Kind::kMoving) {
      read_moving(node, point);
    } else {
      fields_.vector(node, "location", point.location);
      const bool on_body = point.frame.rotation == glm::dmat3(1.0) && point.frame.translation == glm::dvec3(0.0);
      if (!on_body) point.location = point.frame * point.location;
    }
    if (point.kind == OsimPathPoint::Kind::kConditional) read_condition(node, point);
    muscle.points.push_back(std::move(point));
  }

  void read_condition(pugi::xml_node node, OsimPathPoint& point) {
    point.coordinate = read_coordinate(node, "socket_coordinate");
    std::vector<double> range{0.0, 0.0};
    if (!fields_.numbers(node, "range", 2, range)) return;
    if (range[0] > range[1]) {
      fields_.error(node.child("range"), fmt::format("the range {} to {} is empty", range[0], range[1]),
                    "give the smaller value first");
    }
    point.range_min = range[0];
    point.range_max = range[1];
  }

  void read_moving(pugi::xml_node node, OsimPathPoint& point) {
    constexpr std::array kSockets{"socket_x_coordinate", "socket_y_coordinate", "socket_z_coordinate"};
    constexpr std::array kLocations{"x_location", "y_location", "z_location"};
    for (std::size_t k = 0; k < 3; ++k) {
      const pugi::xml_node function = elements(node.child(kLocations[k])).empty()
                                          ? pugi::xml_node()
                                          : elements(node.child(kLocations[k]))[0];
      if (!function) {
        fields_.error(node, fmt::format("a moving point without a function in {}", kLocations[k]),
                      "add one, such as a SimmSpline or a Constant");
        continue;
      }
      read_function(fields_, function, point.moving[k]);
      if (function.name() != std::string_view("Constant"))
        point.moving_coordinates[k] = read_coordinate(node, kSockets[k]);
    }
    // Its place at the coordinates' defaults is worked out once the joints are known to be right.
  }

  std::int32_t read_coordinate(pugi::xml_node node, const char* socket) {
    const pugi::xml_node named = node.child(socket);
    if (!named) {
      fields_.error(node, fmt::format("the point has no {}", socket), "name the coordinate that it depends on");
      return -1;
    }
    return find_osim_coordinate(fields_, named, child_text(node, socket), result_.joints);
  }

  // From the file's order of bodies to the skeleton's, in which parents stand first.
  void renumber_bodies(const std::vector<std::string>& names) {
    const Skeleton& skeleton = *result_.joints.skeleton;
    const auto renumber = [&](std::int32_t& body) { body = skeleton.find(names[static_cast<std::size_t>(body)]); };
    for (OsimGeometry& geometry : result_.geometry) renumber(geometry.body);
    for (OsimWrapObject& object : result_.wrap_objects) renumber(object.body);
    const std::vector<double> defaults = default_coordinates(result_.joints);
    for (OsimMuscle& muscle : result_.muscles) {
      for (OsimPathPoint& point : muscle.points) {
        renumber(point.body);
        point.location = location_at(result_, point, defaults);
      }
    }
  }

  std::string_view text_;
  XmlFields fields_;
  std::set<std::string> muscle_names_;
  OsimModel result_;
};

}  // namespace

Result<OsimModel> read_osim(const std::filesystem::path& file) {
  Result<std::string> text = read_text_file(file, std::uintmax_t{1} << 28);
  if (!text) return text.diagnostics();
  return parse_osim(std::move(*text), file.string());
}

Result<OsimModel> parse_osim(std::string text, std::string file_name) { return OsimReader(text, file_name).read(); }

}  // namespace fascicle::muscle
