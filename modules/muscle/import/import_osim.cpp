#include "modules/muscle/import/import_osim.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/animation/joint_model_reader.hpp"
#include "engine/animation/joint_model_writer.hpp"
#include "engine/content/quote_json.hpp"
#include "engine/content/json_reader.hpp"

namespace fascicle::muscle {
namespace {

constexpr double kSamePlace = 2e-5;  // m; character files refuse consecutive points within 1e-5 of each other

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

class CharacterImport {
 public:
  CharacterImport(const OsimModel& model, const ImportOptions& options)
      : model_(model), options_(options), defaults_(default_coordinates(model.joints)),
        rest_(evaluate_bones(model.joints, defaults_)) {}

  Result<std::string> run() {
    const std::string name = options_.name.empty() ? model_.name : options_.name;
    text_ = "{\n";
    line(fmt::format("\"$schema\": {},", quote_json(options_.schema)));
    line("\"version\": 1,");
    line(fmt::format("\"name\": {},", quote_json(name.empty() ? "model" : name)));
    write_source();
    line(fmt::format("\"skeleton\": {{ \"joints\": {} }},", write_joint_model(model_.joints, 2)));
    write_geometry();
    line("\"attachment_space\": \"bone\",");
    line("\"level\": { \"section_vertices\": 8, \"longitudinal_subdivision\": 2 },");
    line(fmt::format("\"specific_tension\": {},", json_number(options_.specific_tension)));
    write_muscles();
    text_ += "}\n";
    if (diagnostics_.ok()) check_that_it_reads_back();
    if (!diagnostics_.ok()) return std::move(diagnostics_);
    return Result<std::string>(std::move(text_), std::move(diagnostics_));
  }

 private:
  // The reader of character files is stricter than XML (a scaled spline may leave its range, for instance).
  void check_that_it_reads_back() {
    const Result<JsonDocument> document = parse_json(text_, model_.file + " (as a character)");
    if (!document) return diagnostics_.append(document.diagnostics());
    diagnostics_.append(read_joint_model(document->root().member("skeleton").member("joints")).diagnostics());
  }

  void line(const std::string& content) { text_ += "  " + content + "\n"; }

  const std::string& bone_name(std::int32_t bone) const {
    return model_.joints.skeleton->names[static_cast<std::size_t>(bone)];
  }

  void warn(int at_line, int column, std::string path, std::string cause, std::string remedy) {
    diagnostics_.warnings.push_back(
        {model_.file, at_line, column, std::move(path), std::move(cause), std::move(remedy)});
  }

  void write_source() {
    std::string source = options_.source;
    if (source.empty()) {
      source =
          fmt::format("OpenSim model {} ({})", model_.name, std::filesystem::path(model_.file).filename().string());
      if (!model_.credits.empty()) source += ". " + model_.credits;
    }
    line(fmt::format("\"source\": {},", quote_json(source)));
    const std::string licence = options_.licence.empty() ? find_licence(model_.credits) : options_.licence;
    if (licence.empty()) {
      warn(0, 0, {}, "the model's credits name no licence that is known here", "state it with --licence");
    } else {
      line(fmt::format("\"licence\": {},", quote_json(licence)));
    }
  }

  void write_geometry() {
    std::vector<std::string> lines;
    std::vector<std::string> absent;
    for (const OsimGeometry& geometry : model_.geometry) {
      const std::filesystem::path file = std::filesystem::path(geometry.file).filename();
      std::error_code ignored;
      if (file.extension() != ".vtp" || !std::filesystem::is_regular_file(options_.geometry_folder / file, ignored)) {
        absent.push_back(geometry.file);
        continue;
      }
      std::string entry = fmt::format("{{ \"bone\": {}, \"file\": {}", quote_json(bone_name(geometry.body)),
                                      quote_json(options_.geometry_prefix + file.string()));
      if (geometry.scale != glm::dvec3(1.0)) entry += ", \"scale\": " + json_list(geometry.scale);
      if (geometry.translation != glm::dvec3(0.0)) entry += ", \"translation\": " + json_list(geometry.translation);
      if (geometry.orientation != glm::dvec3(0.0)) {
        const glm::dquat q = glm::normalize(glm::quat_cast(rotation_from_xyz(geometry.orientation)));
        const double xyzw[] = {q.x, q.y, q.z, q.w};
        entry += ", \"rotation\": " + json_list(xyzw);
      }
      lines.push_back(entry + " }");
    }
    if (!absent.empty()) {
      warn(0, 0, {}, fmt::format("{} bone meshes are left out, no .vtp files in '{}': {}", absent.size(),
                                 options_.geometry_folder.string(), joined(absent)),
           "name the folder of the model's geometry with --geometry");
    }
    write_array("bone_meshes", lines, ",");
  }

  void write_array(const char* name, const std::vector<std::string>& entries, const char* after) {
    if (entries.empty()) return line(fmt::format("\"{}\": []{}", name, after));
    line(fmt::format("\"{}\": [", name));
    for (std::size_t i = 0; i < entries.size(); ++i) line("  " + entries[i] + (i + 1 == entries.size() ? "" : ","));
    line(std::string("]") + after);
  }

  void write_muscles() {
    std::vector<std::string> entries;
    for (const OsimMuscle& muscle : model_.muscles) entries.push_back(muscle_text(muscle));
    write_array("muscles", entries, "");
  }

  // The points in their default state; notes what that changes.
  std::vector<const OsimPathPoint*> default_path(const OsimMuscle& muscle) {
    std::vector<std::string> notes;
    std::vector<std::string> kept, dropped, moving, doubled;
    std::vector<const OsimPathPoint*> path;
    for (const OsimPathPoint& point : muscle.points) {
      const bool active = is_active(model_, point, defaults_);
      if (point.kind == OsimPathPoint::Kind::kConditional) (active ? kept : dropped).push_back(point.name);
      if (point.kind == OsimPathPoint::Kind::kMoving) moving.push_back(point.name);
      if (active) path.push_back(&point);
    }
    const auto place = [&](const OsimPathPoint* point) {
      return rest_[static_cast<std::size_t>(point->body)] * point->location;
    };
    for (std::size_t i = 1; i < path.size() && path.size() > 2;) {
      if (glm::distance(place(path[i - 1]), place(path[i])) > kSamePlace) {
        ++i;
        continue;
      }
      // Of two points in one place the inner one goes.
      const std::size_t gone = i + 1 == path.size() ? i - 1 : i;
      doubled.push_back(path[gone]->name);
      path.erase(path.begin() + static_cast<std::ptrdiff_t>(gone));
    }
    if (path.size() < 2 || (path.size() == 2 && glm::distance(place(path[0]), place(path[1])) <= kSamePlace)) {
      diagnostics_.errors.push_back({model_.file, muscle.line, muscle.column, muscle.name,
                                     "in the default pose the path has no length",
                                     "give it an origin and an insertion apart"});
      path.clear();
    }
    if (!kept.empty()) notes.push_back("conditional points stay on: " + joined(kept));
    if (!dropped.empty()) notes.push_back("conditional points stay off: " + joined(dropped));
    if (!moving.empty()) notes.push_back("moving points stand still: " + joined(moving));
    if (!muscle.wraps.empty()) notes.push_back("it does not wrap over: " + joined(muscle.wraps));
    if (!doubled.empty()) notes.push_back("points in the place of their neighbour are left out: " + joined(doubled));
    if (!notes.empty()) {
      warn(muscle.line, muscle.column, muscle.name, fmt::format("{}", fmt::join(notes, "; ")),
           "see whether the line cuts bone in the poses that matter, and add via points");
    }
    return path;
  }

  std::string attachment(const OsimPathPoint& point) const {
    return fmt::format("{{ \"bone\": {}, \"position\": {} }}", quote_json(bone_name(point.body)),
                       json_list(point.location));
  }

  std::string muscle_text(const OsimMuscle& muscle) {
    if (!(muscle.max_isometric_force > 0.0)) {
      diagnostics_.errors.push_back({model_.file, muscle.line, muscle.column, muscle.name,
                                     "its max_isometric_force is 0, so nothing says how thick it is",
                                     "give its force (N)"});
    }
    const std::vector<const OsimPathPoint*> path = default_path(muscle);
    if (path.empty()) return {};
    const std::string indent = "\n      ";
    std::string entry = fmt::format("{{ \"name\": {},", quote_json(muscle.name));
    if (!muscle.groups.empty()) {
      std::vector<std::string> groups;
      for (const std::string& group : muscle.groups) groups.push_back(quote_json(group));
      entry += fmt::format(" \"groups\": [{}],", joined(groups));
    }
    entry += indent + "\"origin\": " + attachment(*path.front()) + ",";
    if (path.size() > 2) {
      entry += indent + "\"via\": [";
      for (std::size_t i = 1; i + 1 < path.size(); ++i) {
        entry += indent + "  " + attachment(*path[i]) + (i + 2 == path.size() ? " ]," : ",");
      }
    }
    entry += indent + "\"insertion\": " + attachment(*path.back()) + ",";
    entry += indent + fmt::format(
                          "\"max_isometric_force\": {}, \"optimal_fibre_length\": {}, \"tendon_slack_length\": {}, "
                          "\"pennation\": {} }}",
                          json_number(muscle.max_isometric_force), json_number(muscle.optimal_fibre_length),
                          json_number(muscle.tendon_slack_length), json_number(muscle.pennation));
    return entry;
  }

  const OsimModel& model_;
  const ImportOptions& options_;
  std::vector<double> defaults_;
  std::vector<RigidTransform> rest_;
  std::string text_;
  Diagnostics diagnostics_;
};

}  // namespace

Result<std::string> import_character(const OsimModel& model, const ImportOptions& options) {
  return CharacterImport(model, options).run();
}

std::string find_licence(const std::string& credits) {
  for (const std::string_view mark : {"CCBY", "CC BY", "CC-BY"}) {
    const std::size_t at = credits.find(mark);
    if (at == std::string::npos) continue;
    std::string rest;
    for (std::size_t i = at + mark.size(); i < credits.size() && rest.size() < 12; ++i) {
      const char c = credits[i];
      const bool part = std::isdigit(static_cast<unsigned char>(c)) || c == '.' || c == ' ' || c == '-' ||
                        (c >= 'A' && c <= 'Z');
      if (!part) break;
      rest += c;
    }
    while (!rest.empty() && (rest.back() == ' ' || rest.back() == '.')) rest.pop_back();
    if (!rest.empty() && rest.front() != ' ' && rest.front() != '-') rest = " " + rest;
    return "CC BY" + rest;
  }
  return {};
}

}  // namespace fascicle::muscle
