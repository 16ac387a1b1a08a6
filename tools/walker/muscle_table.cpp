// Attachment points and Hill parameters: S. L. Delp et al., IEEE Trans. Biomed. Eng. 37 (1990), as published in the
// gait2392 model (metres, OpenSim axes, right side); `foot` is its calcn. The 24 units are those of the thesis's
// appendix A. Rectus femoris and vastus intermedius insert on the patella, which moves as their moving points do.
#include "tools/walker/muscle_table.hpp"

#include <cstddef>

#include <glm/geometric.hpp>

#include "tools/walker/skeleton.hpp"

namespace fascicle::walker {
namespace {

constexpr float kSpecificTension = 610000.0f;  // N/m^2
constexpr auto kConditional = PointKind::kConditional;
constexpr auto kExtra = PointKind::kExtra;

PathPoint pelvis(float x, float y, float z, PointKind kind = PointKind::kPublished) {
  return {"pelvis", from_opensim({x, y, z}), kind};
}
PathPoint femur(float x, float y, float z, PointKind kind = PointKind::kPublished) {
  return {"femur_r", from_opensim({x, y, z}), kind};
}
PathPoint tibia(float x, float y, float z, PointKind kind = PointKind::kPublished) {
  return {"tibia_r", from_opensim({x, y, z}), kind};
}
PathPoint patella(float x, float y, float z) { return {"patella_r", from_opensim({x, y, z}), PointKind::kPublished}; }
PathPoint foot(float x, float y, float z, PointKind kind = PointKind::kPublished) {
  return {"foot_r", from_opensim({x, y, z}), kind};
}

std::vector<MuscleSpec> hip_muscles() {
  return {
      {"gluteus_medius_1_r", 819, 0.0535f, 0.078f, 0.13962634f,
       {pelvis(-0.0408f, 0.0304f, 0.1209f), femur(-0.0218f, -0.0117f, 0.0555f)},
       {.begin = 0.0f, .peak = 0.40f, .end = 0.92f, .aspect = 4.3f, .wrap = 1.0f, .skew = 0.3f, .lift = 0.85f,
        .origin_width = 30, .origin_thickness = 4, .insertion_width = 9, .insertion_thickness = 3,
        .outward_origin = {0.35f, 0, 1}, .outward_insertion = {0.25f, 0, 1}, .middle_shift = {6, 0, 4}}},
      {"gluteus_medius_2_r", 573, 0.0845f, 0.053f, 0.0f,
       {pelvis(-0.0855f, 0.0445f, 0.0766f), femur(-0.0258f, -0.0058f, 0.0527f)},
       {.begin = 0.0f, .peak = 0.42f, .end = 0.92f, .aspect = 4.1f, .wrap = 0.9f, .skew = -0.2f, .lift = 0.85f,
        .origin_width = 30, .origin_thickness = 4, .insertion_width = 9, .insertion_thickness = 3,
        .outward_origin = {-0.3f, 0, 1}, .outward_insertion = {-0.1f, 0, 1}, .middle_shift = {-2, 0, 4}}},
      {"gluteus_medius_3_r", 653, 0.0646f, 0.053f, 0.33161256f,
       {pelvis(-0.1223f, 0.0105f, 0.0648f), femur(-0.0309f, -0.0047f, 0.0518f)},
       {.begin = 0.0f, .peak = 0.42f, .end = 0.92f, .aspect = 3.7f, .wrap = 0.9f, .skew = 0.2f, .lift = 0.8f,
        .origin_width = 24, .origin_thickness = 4, .insertion_width = 8, .insertion_thickness = 3,
        .outward_origin = {-0.8f, 0, 0.7f}, .outward_insertion = {-0.5f, 0, 1}, .middle_shift = {-6, 0, 2}}},
      {"gluteus_maximus_1_r", 573, 0.142f, 0.125f, 0.08726646f,
       {pelvis(-0.1195f, 0.0612f, 0.07f), pelvis(-0.1291f, 0.0012f, 0.0886f), femur(-0.0457f, -0.0248f, 0.0392f),
        femur(-0.0277f, -0.0566f, 0.047f)},
       {.begin = 0.0f, .peak = 0.45f, .end = 0.95f, .aspect = 4.9f, .wrap = 1.2f, .skew = 0.25f, .lift = 0.7f,
        .origin_width = 27, .origin_thickness = 4, .insertion_width = 15, .insertion_thickness = 4,
        .outward_origin = {-0.7f, 0, 0.7f}, .outward_insertion = {-0.4f, 0, 0.9f}, .middle_shift = {-8, 3, 12}}},
      {"gluteus_maximus_2_r", 819, 0.147f, 0.127f, 0.0f,
       {pelvis(-0.1349f, 0.0176f, 0.0563f), pelvis(-0.1376f, -0.052f, 0.0914f), femur(-0.0426f, -0.053f, 0.0293f),
        femur(-0.0156f, -0.1016f, 0.0419f)},
       {.begin = 0.0f, .peak = 0.45f, .end = 0.95f, .aspect = 4.7f, .wrap = 1.1f, .skew = 0.1f, .lift = 0.7f,
        .origin_width = 27, .origin_thickness = 4, .insertion_width = 16, .insertion_thickness = 4,
        .outward_origin = {-0.9f, 0, 0.4f}, .outward_insertion = {-0.5f, 0, 0.85f}, .middle_shift = {-10, 0, 6}}},
      {"gluteus_maximus_3_r", 552, 0.144f, 0.145f, 0.08726646f,
       {pelvis(-0.1556f, -0.0314f, 0.0058f), pelvis(-0.1529f, -0.1052f, 0.0403f), femur(-0.0299f, -0.1041f, 0.0135f),
        femur(-0.006f, -0.1419f, 0.0411f)},
       {.begin = 0.0f, .peak = 0.48f, .end = 0.95f, .aspect = 4.5f, .wrap = 1.0f, .skew = -0.25f, .lift = 0.7f,
        .origin_width = 24, .origin_thickness = 4, .insertion_width = 15, .insertion_thickness = 4,
        .outward_origin = {-1, 0, 0.1f}, .outward_insertion = {-0.5f, 0, 0.6f}, .middle_shift = {-8, -4, 0}}},
      {"iliacus_r", 1073, 0.1f, 0.1f, 0.12217305f,
       {pelvis(-0.0674f, 0.0365f, 0.0854f), pelvis(-0.0258f, -0.055f, 0.0811f),
        pelvis(-0.0288f, -0.0805f, 0.0816f, kConditional), femur(0.0017f, -0.0543f, 0.0057f),
        femur(-0.0193f, -0.0621f, 0.0129f)},
       {.begin = 0.0f, .peak = 0.24f, .end = 0.78f, .aspect = 4.6f, .wrap = 1.4f, .skew = 0.3f, .lift = 0.8f,
        .origin_width = 38, .origin_thickness = 5, .insertion_width = 3, .insertion_thickness = 2,
        .outward_origin = {0.55f, 0.1f, -0.8f}, .outward_insertion = {1, 0, -0.2f}, .middle_shift = {0, 0, 6},
        .tendon_shift = {4, 0, 6}, .insertion_shift = {3, -4, 4}}},
      {"psoas_major_r", 1113, 0.1f, 0.16f, 0.13962634f,
       {pelvis(-0.0647f, 0.0887f, 0.0289f), pelvis(-0.0238f, -0.057f, 0.0759f),
        pelvis(-0.0288f, -0.0805f, 0.0816f, kConditional), femur(0.0016f, -0.0507f, 0.0038f),
        femur(-0.0188f, -0.0597f, 0.0104f)},
       {.begin = 0.0f, .peak = 0.27f, .end = 0.80f, .aspect = 1.8f, .wrap = 0.9f, .skew = 0.3f, .lift = 0.8f,
        .origin_width = 14, .origin_thickness = 7, .insertion_width = 3, .insertion_thickness = 2,
        .outward_origin = {1, 0, -0.1f}, .outward_insertion = {1, 0, -0.2f}, .origin_shift = {-7, 0, -5},
        .middle_shift = {3, 0, -8},
        .tendon_shift = {0, 0, -6}, .insertion_shift = {0, 5, -4}}},
      {"quadratus_femoris_r", 381, 0.054f, 0.024f, 0.0f,
       {pelvis(-0.1143f, -0.1151f, 0.052f), femur(-0.0381f, -0.0359f, 0.0366f)},
       {.begin = 0.0f, .peak = 0.5f, .end = 1.0f, .aspect = 4.0f, .wrap = 0.7f, .skew = 0.2f, .lift = 0.8f,
        .origin_width = 12, .origin_thickness = 4, .insertion_width = 13, .insertion_thickness = 3.5f,
        .outward_origin = {-1, 0, 0}, .outward_insertion = {-1, 0, 0.2f}, .middle_shift = {-2, -3, 0}}},
      {"inferior_gemellus_r", 164, 0.024f, 0.039f, 0.0f,
       {pelvis(-0.1133f, -0.082f, 0.0714f), femur(-0.0195f, -0.0024f, 0.0352f, kExtra),
        femur(-0.0142f, -0.0033f, 0.0443f)},
       {.begin = 0.0f, .peak = 0.4f, .end = 0.8f, .aspect = 2.2f, .wrap = 0.8f, .skew = 0.2f, .lift = 0.9f,
        .origin_width = 6, .origin_thickness = 3, .insertion_width = 3, .insertion_thickness = 2,
        .outward_origin = {-1, 0.2f, 0}, .outward_insertion = {-1, 0.4f, 0}, .middle_shift = {-4, 0, 0},
        .insertion_shift = {-4, -2, 0}}},
      {"piriformis_r", 444, 0.026f, 0.115f, 0.17453293f,
       {pelvis(-0.1396f, 0.0003f, 0.0235f), pelvis(-0.1193f, -0.0276f, 0.0657f), femur(-0.0148f, -0.0036f, 0.0437f)},
       {.begin = 0.0f, .peak = 0.38f, .end = 0.85f, .aspect = 3.2f, .wrap = 0.9f, .skew = -0.2f, .lift = 0.9f,
        .origin_width = 10, .origin_thickness = 4, .insertion_width = 2.4f, .insertion_thickness = 2,
        .outward_origin = {-0.6f, -0.3f, 0.7f}, .outward_insertion = {-0.8f, 0.5f, 0}, .middle_shift = {-4, 3, 0},
        .tendon_shift = {-2, 6, 0}, .insertion_shift = {-1, 7, 0}}},
  };
}

std::vector<MuscleSpec> thigh_muscles() {
  return {
      {"adductor_magnus_2_r", 343, 0.121f, 0.12f, 0.05235988f,
       {pelvis(-0.0831f, -0.1192f, 0.0308f), femur(0.0054f, -0.2285f, 0.0227f)},
       {.begin = 0.03f, .peak = 0.45f, .end = 0.95f, .aspect = 4.4f, .wrap = 1.2f, .skew = 0.3f, .lift = 0.6f,
        .origin_width = 18, .origin_thickness = 4, .insertion_width = 30, .insertion_thickness = 2.5f,
        .outward_origin = {-0.6f, 0, -0.8f}, .outward_insertion = {-0.6f, 0, -0.8f}, .middle_shift = {-3, 0, -3}}},
      {"pectineus_r", 266, 0.1f, 0.033f, 0.0f,
       {pelvis(-0.0431f, -0.0768f, 0.0451f), femur(-0.0122f, -0.0822f, 0.0253f)},
       {.begin = 0.0f, .peak = 0.45f, .end = 0.97f, .aspect = 3.8f, .wrap = 1.0f, .skew = -0.3f, .lift = 0.7f,
        .origin_width = 16, .origin_thickness = 4, .insertion_width = 16, .insertion_thickness = 2.5f,
        .outward_origin = {0.9f, 0.1f, -0.3f}, .outward_insertion = {0.7f, 0, -0.7f}, .middle_shift = {2, 0, -4}}},
      {"gracilis_r", 162, 0.352f, 0.126f, 0.05235988f,
       {pelvis(-0.07401f, -0.1187f, 0.02794f), tibia(-0.01943f, -0.05153f, -0.0358f),
        tibia(0.006f, -0.0836f, -0.0228f)},
       {.begin = 0.02f, .peak = 0.30f, .end = 0.72f, .aspect = 4.8f, .wrap = 1.1f, .skew = 0.2f, .lift = 0.5f,
        .origin_width = 12, .origin_thickness = 3, .insertion_width = 2.6f, .insertion_thickness = 1.4f,
        .outward_origin = {0, 0, -1}, .outward_insertion = {0, 0, -1}, .middle_shift = {-5, 0, -6},
        .tendon_shift = {-19, 0, -5}, .insertion_shift = {-6, -5, 0}}},
      {"sartorius_r", 156, 0.52f, 0.1f, 0.0f,
       {pelvis(-0.0153f, -0.0013f, 0.1242f), femur(-0.003f, -0.3568f, -0.0421f), tibia(-0.0056f, -0.0419f, -0.0399f),
        tibia(0.006f, -0.0589f, -0.0383f), tibia(0.0243f, -0.084f, -0.0252f)},
       {.begin = 0.02f, .peak = 0.40f, .end = 0.84f, .aspect = 5.0f, .wrap = 1.3f, .skew = 0.25f, .lift = 0.5f,
        .origin_width = 8, .origin_thickness = 3.5f, .insertion_width = 2.6f, .insertion_thickness = 1.4f,
        .outward_origin = {1, 0, 0.3f}, .outward_insertion = {0.2f, 0, -1}, .middle_shift = {14, 0, -6},
        .tendon_shift = {-19, 0, -6}, .insertion_shift = {-7, -5, 0}}},
      {"tensor_fasciae_latae_r", 233, 0.095f, 0.425f, 0.05235988f,
       {pelvis(-0.0311f, 0.0214f, 0.1241f), femur(0.0294f, -0.0995f, 0.0597f), femur(0.0054f, -0.4049f, 0.0357f),
        tibia(0.006f, -0.0487f, 0.0297f)},
       {.begin = 0.01f, .peak = 0.15f, .end = 0.38f, .aspect = 3.0f, .wrap = 0.9f, .skew = 0.3f, .lift = 0.6f,
        .origin_width = 9, .origin_thickness = 4, .insertion_width = 7, .insertion_thickness = 1.4f,
        .outward_origin = {0.4f, 0, 1}, .outward_insertion = {0.1f, 0, 1}, .middle_shift = {-2, 0, 9},
        .tendon_shift = {11, 0, 2}, .insertion_shift = {7, 0, 1}}},
      {"biceps_femoris_long_head_r", 896, 0.109f, 0.326f, 0.0f,
       {pelvis(-0.12596f, -0.10257f, 0.06944f), tibia(-0.0301f, -0.036f, 0.02943f), tibia(-0.0234f, -0.0563f, 0.0343f)},
       {.begin = 0.10f, .peak = 0.45f, .end = 0.80f, .aspect = 3.1f, .wrap = 1.1f, .skew = 0.25f, .lift = 0.5f,
        .origin_width = 7, .origin_thickness = 3.5f, .insertion_width = 2.6f, .insertion_thickness = 2,
        .outward_origin = {-1, 0, 0.2f}, .outward_insertion = {-1, 0, 0.5f}, .middle_shift = {-10, 0, 0},
        .tendon_shift = {-13, 0, 6}, .insertion_shift = {-6, 0, 2}}},
      {"biceps_femoris_short_head_r", 804, 0.173f, 0.089f, 0.40142573f,
       {femur(0.005f, -0.2111f, 0.0234f), tibia(-0.0301f, -0.036f, 0.02943f), tibia(-0.0234f, -0.0563f, 0.0343f)},
       {.begin = 0.0f, .peak = 0.42f, .end = 0.84f, .aspect = 3.9f, .wrap = 1.2f, .skew = -0.3f, .lift = 0.8f,
        .origin_width = 20, .origin_thickness = 3, .insertion_width = 2.6f, .insertion_thickness = 2,
        .outward_origin = {-0.7f, 0, 0.5f}, .outward_insertion = {-0.8f, 0, 0.6f}, .middle_shift = {2, 0, 5},
        .tendon_shift = {4, 0, -5}, .insertion_shift = {3, 0, -3}}},
      {"rectus_femoris_r", 1169, 0.114f, 0.31f, 0.08726646f,
       {pelvis(-0.0295f, -0.0311f, 0.0968f), patella(0, 0, 0)},
       {.begin = 0.06f, .peak = 0.42f, .end = 0.86f, .aspect = 3.2f, .wrap = 1.2f, .skew = 0.15f, .lift = 0.8f,
        .origin_width = 7, .origin_thickness = 4, .insertion_width = 11, .insertion_thickness = 2.5f,
        .outward_origin = {1, 0, 0.1f}, .outward_insertion = {1, 0, 0}, .middle_shift = {16, 0, 2},
        .insertion_shift = {1, 1, 0}}},
      {"vastus_intermedius_r", 1365, 0.087f, 0.136f, 0.05235988f,
       {femur(0.029f, -0.1924f, 0.031f), femur(0.0335f, -0.2084f, 0.0285f), patella(-0.0062944f, 0.0043083f, 0.0004f)},
       {.begin = 0.0f, .peak = 0.42f, .end = 0.92f, .aspect = 5.2f, .wrap = 2.6f, .skew = 0.1f, .lift = 0.8f,
        .origin_width = 18, .origin_thickness = 4, .insertion_width = 15, .insertion_thickness = 2.5f,
        .outward_origin = {1, 0, 0.25f}, .outward_insertion = {1, 0, 0.05f}, .middle_shift = {2, 0, -10},
        .insertion_shift = {-2, 1, 0}}},
  };
}

std::vector<MuscleSpec> shank_muscles() {
  return {
      {"medial_gastrocnemius_r", 1558, 0.06f, 0.39f, 0.29670597f,
       {femur(-0.019f, -0.3929f, -0.0235f), femur(-0.03f, -0.4022f, -0.0258f), foot(0.0f, 0.031f, -0.0053f)},
       {.begin = 0.03f, .peak = 0.26f, .end = 0.54f, .aspect = 4.0f, .wrap = 1.2f, .skew = -0.35f, .lift = 0.6f,
        .origin_width = 7, .origin_thickness = 3, .insertion_width = 6, .insertion_thickness = 1.6f,
        .outward_origin = {-1, 0, -0.4f}, .outward_insertion = {-1, 0, 0}, .middle_shift = {-12, 0, -6},
        .insertion_shift = {-3.2f, 1.0f, 0}}},
      {"soleus_r", 3549, 0.05f, 0.25f, 0.43633231f,
       {tibia(-0.0024f, -0.1533f, 0.0071f), foot(0.0f, 0.031f, -0.0053f)},
       {.begin = 0.0f, .peak = 0.34f, .end = 0.78f, .aspect = 5.0f, .wrap = 1.7f, .skew = 0.15f, .lift = 0.9f,
        .origin_width = 30, .origin_thickness = 4, .insertion_width = 8, .insertion_thickness = 2.6f,
        .outward_origin = {-1, 0, 0}, .outward_insertion = {-1, 0, 0}, .middle_shift = {-8, 0, 2},
        .insertion_shift = {0.5f, 0, 0}}},
      {"tibialis_posterior_r", 1588, 0.031f, 0.31f, 0.20943951f,
       {tibia(-0.0094f, -0.1348f, 0.0019f), tibia(-0.0144f, -0.4051f, -0.0229f), foot(0.0417f, 0.0334f, -0.0286f),
        foot(0.0772f, 0.0159f, -0.0281f)},
       {.begin = 0.0f, .peak = 0.32f, .end = 0.66f, .aspect = 3.3f, .wrap = 1.0f, .skew = 0.3f, .lift = 0.8f,
        .origin_width = 8, .origin_thickness = 3, .insertion_width = 2.6f, .insertion_thickness = 1.7f,
        .outward_origin = {-1, 0, 0.1f}, .outward_insertion = {0, -0.2f, -1}, .middle_shift = {-3, 0, 5},
        .tendon_shift = {-11, 0, 5}, .insertion_shift = {4, -5, 1}}},
      {"tibialis_anterior_r", 905, 0.098f, 0.223f, 0.08726646f,
       {tibia(0.0179f, -0.1624f, 0.0115f), tibia(0.0329f, -0.3951f, -0.0177f), foot(0.1166f, 0.0178f, -0.0305f)},
       {.begin = 0.0f, .peak = 0.30f, .end = 0.66f, .aspect = 3.1f, .wrap = 1.1f, .skew = -0.2f, .lift = 0.8f,
        .origin_width = 11, .origin_thickness = 4, .insertion_width = 2.6f, .insertion_thickness = 1.8f,
        .outward_origin = {0.6f, 0, 0.8f}, .outward_insertion = {0.6f, 0.7f, -0.5f}, .middle_shift = {0, 0, 8},
        .tendon_shift = {-3, -4, 10}, .insertion_shift = {-5, -1, 5}}},
  };
}

}  // namespace

float MuscleSpec::volume() const { return max_isometric_force / kSpecificTension * optimal_fibre_length; }

const std::vector<MuscleSpec>& muscle_table() {
  static const std::vector<MuscleSpec> table = [] {
    std::vector<MuscleSpec> all = hip_muscles();
    for (const auto& part : {thigh_muscles(), shank_muscles()}) all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return table;
}

std::vector<glm::vec3> rest_path(const MuscleSpec& muscle) {
  std::vector<glm::vec3> path;
  for (const PathPoint& point : muscle.path)
    path.push_back(bones()[static_cast<std::size_t>(find_bone(point.bone))].place + point.position);
  return path;
}

float published_length(const MuscleSpec& muscle) {
  const std::vector<glm::vec3> path = rest_path(muscle);
  float length = 0.0f;
  std::size_t last = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (muscle.path[i].kind == PointKind::kExtra) continue;
    length += glm::distance(path[last], path[i]);
    last = i;
  }
  return length;
}

}  // namespace fascicle::walker
