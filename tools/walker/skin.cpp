#include "tools/walker/skin.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "tools/walker/muscle_meshes.hpp"
#include "tools/walker/voxel_mesh.hpp"

namespace fascicle::walker {
namespace {

constexpr int kWeightPasses = 26;  // of diffusion over the mesh's edges, about 1 cm each

glm::vec3 in(const char* bone, float x, float y, float z) {
  return bones()[static_cast<std::size_t>(find_bone(bone))].place + from_opensim_mm(x, y, z);
}

// The right half of a leg's outline, in the character's rest space.
Solid make_envelope() {
  Solid solid(0.045f);
  const auto knot = [](const char* bone, float x, float y, float z, float r) {
    return Knot{in(bone, x, y, z), 0.001f * r};
  };
  solid.add_tube({knot("femur_r", -12, -60, 16, 74), knot("femur_r", 2, -130, 10, 73), knot("femur_r", 8, -210, 8, 65),
                  knot("femur_r", 8, -300, 2, 54), knot("femur_r", 4, -370, 0, 46), knot("tibia_r", 4, -15, 2, 44),
                  knot("tibia_r", -8, -80, 6, 46), knot("tibia_r", -16, -140, 6, 48), knot("tibia_r", -10, -220, 8, 40),
                  knot("tibia_r", -4, -320, 8, 28), knot("tibia_r", -4, -400, 2, 27),
                  knot("talus_r", -12, -12, 0, 26)});
  solid.add_tube({knot("tibia_r", -14, -420, 2, 21), knot("foot_r", 12, 20, -3, 20)});
  solid.add_tube({knot("talus_r", 10, 0, -4, 24), knot("foot_r", 90, 27, -2, 20), knot("foot_r", 140, 12, -2, 13)});
  solid.add_tube({knot("foot_r", 20, 12, -4, 17), knot("foot_r", 90, 14, 4, 15), knot("foot_r", 155, 5, 2, 11)});
  solid.add_tube({knot("foot_r", 150, 4, -26, 10), knot("toes_r", 40, -1, -22, 7)});
  solid.add_tube({knot("foot_r", 150, 3, 28, 9), knot("toes_r", 8, -3, 38, 6)});
  solid.add(
      ThickTriangle{knot("foot_r", 150, 4, -26, 10), knot("foot_r", 140, 2, 30, 9), knot("toes_r", 30, -2, 0, 7)});
  solid.add_tube({knot("pelvis", -118, -40, 62, 78), knot("pelvis", -104, -104, 74, 70)});  // buttock
  solid.add_tube({knot("pelvis", -62, 40, 60, 84), knot("pelvis", -66, -40, 72, 84)});      // hip and flank
  solid.add_tube({knot("pelvis", -62, 110, 40, 92), knot("pelvis", -62, 20, 50, 88)});      // belly
  solid.add_tube({knot("pelvis", -30, 0, 30, 50), knot("pelvis", -40, -60, 30, 34)});       // lower belly
  // Over what lies right under the skin: toes, fifth metatarsal, kneecap and outer ankle.
  solid.add_tube({knot("toes_r", 10, 3, -26, 9), knot("toes_r", 57, 2, -20, 7.5f), knot("toes_r", 38, 2, 10, 7),
                  knot("toes_r", 8, 2, 43, 7)});
  solid.add_tube({knot("foot_r", 70, 12, 30, 10), knot("foot_r", 140, 6, 32, 9)});
  solid.add(RoundCone{knot("patella_r", -15, -8, 0, 14), knot("patella_r", -17, -24, 0, 11)});
  solid.add(RoundCone{knot("tibia_r", -6, -390, 26, 14), knot("tibia_r", -6, -418, 27, 13)});
  return solid;
}

// What the right side's muscles look like before they are fitted to their meshes: spindles about the action lines, with
// half of the tendon at the insertion (method 1.4) and a sine's profile.
Solid make_spindles(const std::vector<MuscleSpec>& muscles) {
  constexpr float kEnd = 0.3f;          // of the thickest radius
  constexpr float kMeanSquare = 0.60f;  // of the profile
  constexpr int kStations = 16;
  Solid solid(0.006f);
  for (const MuscleSpec& muscle : muscles) {
    const std::vector<glm::vec3> path = rest_path(muscle);
    const float length = published_length(muscle);
    const float belly = std::max(0.2f * length, length - 0.5f * muscle.tendon_slack_length);
    const float thickest = std::sqrt(muscle.volume() / (kMeanSquare * glm::pi<float>() * belly));
    Tube tube;
    float gone = 0.0f;
    for (std::size_t i = 1; i < path.size(); ++i) {
      const float part = glm::distance(path[i - 1], path[i]);
      for (int k = 0; k <= kStations; ++k) {
        const float share = static_cast<float>(k) / kStations;
        const float at = std::min((gone + share * part) / belly, 1.0f);
        const float profile = kEnd + (1.0f - kEnd) * std::sin(glm::pi<float>() * at);
        tube.knots.push_back({glm::mix(path[i - 1], path[i], share), thickest * profile});
      }
      gone += part;
    }
    solid.add(tube);
  }
  return solid;
}

// Both sides' mesh of a solid that is the right half.
TriangleMesh mesh_both_sides(const Solid& solid, float voxel) {
  const float margin = 0.03f;
  const glm::vec3 high = solid.high() + margin;
  return mesh_field([&solid](const glm::vec3& p) { return solid.distance(glm::vec3(-std::abs(p.x), p.y, p.z)); },
                    {solid.low() - margin, glm::vec3(margin - solid.low().x, high.y, high.z)}, voxel, 0.0f);
}

// Takes the grid's steps out of the surface: shrinking and swelling passes by turns (Taubin 1995) keep the volume.
void fair(TriangleMesh& mesh, int passes) {
  for (int pass = 0; pass < 2 * passes; ++pass) {
    const float weight = pass % 2 == 0 ? 0.5f : -0.53f;
    std::vector<glm::vec3> sum(mesh.positions.size(), glm::vec3(0.0f));
    std::vector<float> count(mesh.positions.size(), 0.0f);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::uint32_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
      sum[a] += mesh.positions[b];
      count[a] += 1.0f;
    }
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      if (count[v] > 0.0f) mesh.positions[v] += weight * (sum[v] / count[v] - mesh.positions[v]);
  }
}

void add_normals(TriangleMesh& mesh) {
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const glm::vec3 n = glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    for (const std::uint32_t v : {a, b, c}) mesh.normals[v] += n;
  }
  for (glm::vec3& n : mesh.normals) n = glm::length(n) > 0.0f ? glm::normalize(n) : glm::vec3(0.0f, 1.0f, 0.0f);
}

using Weights = std::vector<float>;  // one a bone

// All weight to the nearest bone of the vertex's own side; the kneecap's is shared by thigh and shank.
Weights nearest_bone(const glm::vec3& p, const std::vector<BoneShape>& shapes) {
  Weights weights(bones().size(), 0.0f);
  const glm::vec3 right(-std::abs(p.x), p.y, p.z);
  float best = 1e9f;
  int bone = 0;
  for (const BoneShape& shape : shapes) {
    const float d = shape.distance(right - bones()[static_cast<std::size_t>(shape.bone)].place);
    if (d < best) {
      best = d;
      bone = shape.bone;
    }
  }
  const bool left = p.x > 0.0f;
  const auto give = [&](int to, float weight) {
    weights[static_cast<std::size_t>(left ? mirrored_bone(to) : to)] += weight;
  };
  if (bone == find_bone("patella_r")) {
    give(find_bone("femur_r"), 0.5f);
    give(find_bone("tibia_r"), 0.5f);
  } else if (bone == find_bone("talus_r")) {
    give(find_bone("foot_r"), 1.0f);
  } else {
    give(bone, 1.0f);
  }
  return weights;
}

void diffuse(std::vector<Weights>& weights, const TriangleMesh& mesh) {
  const std::size_t count = bones().size();
  for (int pass = 0; pass < kWeightPasses; ++pass) {
    std::vector<Weights> sum(weights.size(), Weights(count, 0.0f));
    std::vector<float> neighbours(weights.size(), 0.0f);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::uint32_t a = mesh.indices[i], b = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
      for (std::size_t k = 0; k < count; ++k) sum[a][k] += weights[b][k];
      neighbours[a] += 1.0f;
    }
    for (std::size_t v = 0; v < weights.size(); ++v) {
      if (neighbours[v] == 0.0f) continue;
      for (std::size_t k = 0; k < count; ++k) weights[v][k] = 0.5f * weights[v][k] + 0.5f * sum[v][k] / neighbours[v];
    }
  }
}

}  // namespace

Skin make_skin(const std::vector<TriangleMesh>& parts, const std::vector<BoneShape>& shapes,
               const std::vector<MuscleSpec>& muscles) {
  std::vector<TriangleMesh> all = parts;
  all.push_back(mesh_both_sides(make_envelope(), 0.006f));
  all.push_back(mesh_both_sides(make_spindles(muscles), 0.005f));
  WrapSettings settings;
  settings.cut_height = in("pelvis", 0, 122, 0).y;
  Skin skin;
  skin.mesh = wrap_meshes(all, settings);
  skin.mesh.name = "skin";
  fair(skin.mesh, 8);
  add_normals(skin.mesh);

  std::vector<Weights> weights;
  for (const glm::vec3& p : skin.mesh.positions) weights.push_back(nearest_bone(p, shapes));
  diffuse(weights, skin.mesh);
  for (const Weights& all_weights : weights) {
    std::array<std::uint8_t, 4> joints{};
    std::array<float, 4> kept{};
    Weights left = all_weights;
    float total = 0.0f;
    for (std::size_t slot = 0; slot < 4; ++slot) {
      const auto best = std::max_element(left.begin(), left.end());
      if (*best <= 0.004f) continue;
      joints[slot] = static_cast<std::uint8_t>(best - left.begin());
      kept[slot] = *best;
      total += *best;
      *best = 0.0f;
    }
    for (float& w : kept) w /= total;
    skin.joints.push_back(joints);
    skin.weights.push_back(kept);
  }
  return skin;
}

}  // namespace fascicle::walker
