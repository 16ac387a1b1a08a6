// fascicle-make-walker: makes the embedded character from its tables. Its output is committed; run it again after a
// change here: fascicle-make-walker --out content/characters/walker
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "tools/walker/bone_shapes.hpp"
#include "tools/walker/checks.hpp"
#include "tools/walker/gait.hpp"
#include "tools/walker/muscle_meshes.hpp"
#include "tools/walker/muscle_sections.hpp"
#include "tools/walker/muscle_table.hpp"
#include "tools/walker/skin.hpp"
#include "tools/walker/write_character.hpp"
#include "tools/walker/write_glb.hpp"

namespace fascicle::walker {
namespace {

constexpr float kSole = 0.005f;  // m of skin under the bones of the foot

TriangleMesh moved(TriangleMesh mesh, const glm::quat& rotation, const glm::vec3& place) {
  for (glm::vec3& p : mesh.positions) p = place + rotation * p;
  return mesh;
}

std::vector<TriangleMesh> placed_bones(const std::vector<TriangleMesh>& meshes, const Pose& pose) {
  const Placed placed = place_bones(pose);
  std::vector<TriangleMesh> out;
  for (const TriangleMesh& mesh : meshes) {
    const auto bone = static_cast<std::size_t>(find_bone(mesh.name));
    out.push_back(moved(mesh, placed.rotation[bone], placed.place[bone]));
  }
  return out;
}

// Wavefront files to look at with any viewer.
void write_obj(const std::filesystem::path& file, const std::vector<TriangleMesh>& meshes,
               const std::vector<std::vector<glm::vec3>>& lines) {
  std::ofstream out(file);
  std::size_t first = 1;
  for (const TriangleMesh& mesh : meshes) {
    out << "o " << mesh.name << '\n';
    for (const glm::vec3& p : mesh.positions) out << fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      out << fmt::format("f {} {} {}\n", first + mesh.indices[i], first + mesh.indices[i + 1],
                         first + mesh.indices[i + 2]);
    first += mesh.positions.size();
  }
  for (const std::vector<glm::vec3>& line : lines) {
    for (const glm::vec3& p : line) out << fmt::format("v {:.6f} {:.6f} {:.6f}\n", p.x, p.y, p.z);
    out << "l";
    for (std::size_t i = 0; i < line.size(); ++i) out << ' ' << first + i;
    out << '\n';
    first += line.size();
  }
}

std::vector<std::vector<glm::vec3>> action_lines(const std::vector<MuscleSpec>& muscles, const Pose& pose) {
  const Placed placed = place_bones(pose);
  std::vector<std::vector<glm::vec3>> lines;
  for (const bool left : {false, true}) {
    for (const MuscleSpec& muscle : muscles) {
      lines.emplace_back();
      for (const PathPoint& point : muscle.path) {
        const int right_bone = find_bone(point.bone);
        const auto bone = static_cast<std::size_t>(left ? mirrored_bone(right_bone) : right_bone);
        const glm::vec3 local =
            left ? glm::vec3(-point.position.x, point.position.y, point.position.z) : point.position;
        lines.back().push_back(placed.place[bone] + placed.rotation[bone] * local);
      }
    }
  }
  return lines;
}

int make(const std::filesystem::path& out, const std::filesystem::path& obj, bool skip_skin) {
  const std::vector<MuscleSpec>& muscles = muscle_table();
  const std::vector<BoneShape> shapes = make_bone_shapes(muscles);
  const std::vector<TriangleMesh> bone_meshes = mesh_bones(shapes);
  for (const TriangleMesh& mesh : bone_meshes) {
    const MeshFaults faults = find_faults(mesh);
    fmt::print("bone {:10} {:>6} vertices{}{}\n", mesh.name, mesh.positions.size(),
               faults.open_edges > 0 ? ", open" : "",
               faults.crowded_edges > 0 ? fmt::format(", {} crowded edges", faults.crowded_edges) : "");
  }
  const Gait gait = make_gait([&bone_meshes](const Pose& pose) { return lowest_foot(pose, bone_meshes); }, kSole);
  float low = 1e9f, high = -1e9f;
  for (const Pose& pose : gait.poses) {
    low = std::min(low, lowest_foot(pose, bone_meshes));
    high = std::max(high, lowest_foot(pose, bone_meshes));
  }
  fmt::print("lowest point of the feet over the cycle: {:.1f} to {:.1f} mm above the floor\n", 1e3f * low, 1e3f * high);
  fmt::print("{}", report_lines(muscles, shapes, gait));
  std::fflush(stdout);

  std::vector<MeshSize> sizes;
  std::vector<std::size_t> stations, sides;
  for (const MuscleSpec& muscle : muscles) {
    sizes.push_back(plan_mesh(muscle));
    stations.push_back(sizes.back().stations);
    sides.push_back(sizes.back().sides);
  }
  std::vector<Belly> bellies = arrange_bellies(muscles, shapes, stations);
  std::vector<TriangleMesh> muscle_meshes = mesh_bellies(bellies, sizes, shapes);
  fmt::print("{}{}", report_meshes(muscles, muscle_meshes, sides, shapes), report_overlaps(muscle_meshes));
  std::fflush(stdout);
  const std::size_t right = muscle_meshes.size();
  for (std::size_t m = 0; m < right; ++m) {
    muscle_meshes.push_back(mirrored(muscle_meshes[m]));
    muscle_meshes.back().name = mirrored_name(muscle_meshes[m].name);
  }

  Skin skin;
  if (!skip_skin) {
    std::vector<TriangleMesh> parts = placed_bones(bone_meshes, rest_pose());
    parts.insert(parts.end(), muscle_meshes.begin(), muscle_meshes.end());
    skin = make_skin(parts, shapes, muscles);
    const MeshFaults faults = find_faults(skin.mesh);
    fmt::print("skin {} vertices{}{}\n", skin.mesh.positions.size(), faults.open_edges > 0 ? ", open" : "",
               faults.crowded_edges > 0 ? ", crowded" : "");
  }
  if (!obj.empty()) {
    std::filesystem::create_directories(obj);
    write_obj(obj / "bones.obj", placed_bones(bone_meshes, rest_pose()), {});
    write_obj(obj / "muscles.obj", muscle_meshes, {});
    write_obj(obj / "lines.obj", {}, action_lines(muscles, rest_pose()));
    write_obj(obj / "skin.obj", {skin.mesh}, {});
    for (int i = 0; i < 8; ++i) {
      const Pose& pose = gait.poses[static_cast<std::size_t>(i * kGaitKeys / 8)];
      write_obj(obj / fmt::format("walk_{}.obj", i), placed_bones(bone_meshes, pose), action_lines(muscles, pose));
    }
  }
  if (out.empty() || skip_skin) return 0;
  std::filesystem::create_directories(out);
  const bool written =
      write_meshes(out / "bones.glb", bone_meshes) && write_meshes(out / "muscles.glb", muscle_meshes) &&
      write_walker(out / "walker.glb", skin, gait) && write_character(out / "walker.character.json", muscles);
  if (!written) {
    fmt::print(stderr, "{}: cannot be written; give a folder that can be\n", out.string());
    return 1;
  }
  for (const char* name : {"bones.glb", "muscles.glb", "walker.glb", "walker.character.json"})
    fmt::print("{:24} {:>9} bytes\n", name, std::filesystem::file_size(out / name));
  return 0;
}

}  // namespace
}  // namespace fascicle::walker

int main(int argc, char** argv) {
  CLI::App app("Makes the walker, the embedded character, from its tables of landmarks and muscles.");
  std::string out, obj;
  bool skip_skin = false;
  app.add_option("--out", out, "Folder for walker.glb, bones.glb, muscles.glb and walker.character.json");
  app.add_option("--obj", obj, "Folder for Wavefront files of the rest pose and of eight poses of the cycle");
  app.add_flag("--no-skin", skip_skin, "Only check bones, lines and muscles; nothing is written to --out");
  CLI11_PARSE(app, argc, argv);
  return fascicle::walker::make(out, obj, skip_skin);
}
