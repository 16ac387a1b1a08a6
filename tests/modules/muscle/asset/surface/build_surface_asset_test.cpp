#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/content/vtk_reader.hpp"
#include "engine/geometry/closest_point.hpp"
#include "modules/muscle/asset/build_muscle_asset.hpp"
#include "modules/muscle/asset/muscle_asset.hpp"
#include "modules/muscle/asset/surface/surface_asset.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/synthetic_muscles.hpp"
#include "tests/support/test_data.hpp"

namespace fascicle::muscle {
namespace {

// A ball between two bones: the lower pole's surroundings on bone 0, the upper's on bone 1.
SurfaceMuscleDescription ball() {
  SurfaceMuscleDescription description;
  description.name = "ball";
  description.mesh = test::make_sphere(0.05f, 12, 16);
  SurfaceAttachment lower{.bone = 0, .origin = true, .vertices = {}}, upper{.bone = 1, .origin = false, .vertices = {}};
  for (std::uint32_t v = 0; v < description.mesh.positions.size(); ++v) {
    if (description.mesh.positions[v].z < -0.04f) lower.vertices.push_back(v);
    if (description.mesh.positions[v].z > 0.04f) upper.vertices.push_back(v);
  }
  description.attachments = {lower, upper};
  return description;
}

struct Fault {
  std::string name;
  std::function<void(SurfaceMuscleDescription&)> make;
  std::string cause;
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class BrokenSurface : public testing::TestWithParam<Fault> {};

TEST_P(BrokenSurface, IsRefused) {
  SurfaceMuscleDescription description = ball();
  description.where.file = "arm.character.json";
  description.where.path = "/surface_muscles/0";
  GetParam().make(description);
  const auto built = build_surface_asset(description, 2);
  ASSERT_FALSE(built.ok());
  const std::vector<Diagnostic>& errors = built.diagnostics().errors;
  const auto told = std::find_if(errors.begin(), errors.end(), [](const Diagnostic& e) {
    return e.cause.find(GetParam().cause) != std::string::npos;
  });
  ASSERT_NE(told, errors.end()) << to_text(built.diagnostics());
  const Diagnostic& error = *told;
  EXPECT_NE(error.cause.find("'ball'"), std::string::npos) << error.cause;
  EXPECT_EQ(error.file, "arm.character.json");
  EXPECT_EQ(error.path.rfind("/surface_muscles/0/", 0), 0u) << error.path;
  EXPECT_FALSE(error.remedy.empty());
}

const float kNan = std::numeric_limits<float>::quiet_NaN();
INSTANTIATE_TEST_SUITE_P(
    Table, BrokenSurface,
    testing::Values(
        Fault{"NoTriangles", [](auto& d) { d.mesh.indices.clear(); }, "no triangles"},
        Fault{"CornerOutOfRange", [](auto& d) { d.mesh.indices[4] = 9999; }, "corner 9999"},
        Fault{"NotFinite", [](auto& d) { d.mesh.positions[3].y = kNan; }, "vertex 3"},
        Fault{"CornerTwice", [](auto& d) { d.mesh.indices[1] = d.mesh.indices[0]; }, "corner twice"},
        Fault{"Open", [](auto& d) { d.mesh.indices.resize(d.mesh.indices.size() - 3); }, "one triangle only"},
        Fault{"Crowded",
              [](auto& d) {
                d.mesh.positions.push_back({0.2f, 0.0f, 0.0f});
                const auto top = static_cast<std::uint32_t>(d.mesh.positions.size() - 1);
                d.mesh.indices.insert(d.mesh.indices.end(), {d.mesh.indices[0], d.mesh.indices[1], top});
              },
              "more than two triangles"},
        Fault{"Flipped", [](auto& d) { std::swap(d.mesh.indices[0], d.mesh.indices[1]); }, "run the same way"},
        Fault{"InsideOut", [](auto& d) { d.mesh = test::inside_out(d.mesh); }, "inside out"},
        Fault{"TwoPieces",
              [](auto& d) { d.mesh = test::join(d.mesh, test::make_box({1, 1, 1}, {2, 2, 2})); }, "2 separate pieces"},
        Fault{"UnknownBone", [](auto& d) { d.attachments[1].bone = 2; }, "no bone 2"},
        Fault{"UnknownFrame", [](auto& d) { d.frame_bone = -1; }, "no bone -1"},
        Fault{"EmptyAttachment", [](auto& d) { d.attachments[0].vertices.clear(); }, "takes no vertex"},
        Fault{"UnknownVertex", [](auto& d) { d.attachments[0].vertices.push_back(9999); }, "no vertex 9999"},
        Fault{"AttachedTwice",
              [](auto& d) { d.attachments[1].vertices.push_back(d.attachments[0].vertices[0]); }, "belongs to"},
        Fault{"ShortFibre", [](auto& d) { d.fibres.push_back({.points = {{0, 0, 0}}}); }, "two finite points"},
        Fault{"NoSubsteps", [](auto& d) { d.settings.substeps = 0; }, "0 is out of range"},
        Fault{"NegativeCompliance", [](auto& d) { d.settings.bend_compliance = -1.0f; }, "out of range"},
        Fault{"NotANumber", [](auto& d) { d.settings.damping = kNan; }, "out of range"},
        Fault{"UnknownDriver", [](auto& d) { d.driver = "soleus"; }, "no muscle 'soleus'"}),
    [](const auto& fault) { return fault.param.name; });

TEST(BuildSurfaceAsset, EveryFaultIsToldAtOnce) {
  SurfaceMuscleDescription description = ball();
  description.attachments[1].bone = 7;
  description.settings.friction = -1.0f;
  description.driver = "soleus";
  EXPECT_EQ(build_surface_asset(description, 2).diagnostics().errors.size(), 3u);
}

TEST(BuildSurfaceAsset, NoColourHasAVertexTwiceAndEveryEdgeHasItsHinge) {
  const auto asset = *build_surface_asset(ball(), 2);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t t = 0; t < asset->triangles.size(); ++t) {
    const std::uint32_t a = asset->triangles[t], b = asset->triangles[t % 3 == 2 ? t - 2 : t + 1];
    edges.insert(std::minmax(a, b));
  }
  EXPECT_EQ(asset->hinges.size(), edges.size());
  std::size_t packed = 0;
  for (std::size_t colour = 0; colour + 1 < asset->first_pack.size(); ++colour) {
    std::set<std::int32_t> touched;
    for (std::uint32_t p = asset->first_pack[colour]; p < asset->first_pack[colour + 1]; ++p) {
      const HingePack& pack = asset->packs[p];
      for (std::size_t lane = 0; lane < kHingeLanes; ++lane) {
        const bool spare = pack.vertex[0][lane] >= static_cast<std::int32_t>(asset->vertex_count);
        for (std::size_t i = 0; i < 4; ++i) {
          EXPECT_LT(pack.vertex[i][lane], static_cast<std::int32_t>(asset->rest.size()));
          EXPECT_EQ(pack.vertex[i][lane] >= static_cast<std::int32_t>(asset->vertex_count), spare);
          // Spare lanes of the colour's one unfilled pack have points of their own, too.
          EXPECT_TRUE(touched.insert(pack.vertex[i][lane]).second);
        }
        if (spare) continue;
        const Hinge& hinge = asset->hinges[packed++];
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(static_cast<std::uint32_t>(pack.vertex[i][lane]), hinge.vertex[i]);
        EXPECT_EQ(pack.length[lane], hinge.length);
        EXPECT_EQ(pack.angle[lane], hinge.angle);
      }
    }
  }
  // What is not in a pack cannot move.
  for (std::size_t i = packed; i < asset->hinges.size(); ++i) {
    for (const std::uint32_t v : asset->hinges[i].vertex) EXPECT_EQ(asset->rest[v].inverse_mass, 0.0f);
  }
  EXPECT_LT(packed, asset->hinges.size());
}

TEST(BuildSurfaceAsset, VerticesAreTheFilesInAnotherOrder) {
  const SurfaceMuscleDescription description = ball();
  const auto asset = *build_surface_asset(description, 2);
  ASSERT_EQ(asset->file_vertex.size(), description.mesh.positions.size());
  std::set<std::uint32_t> seen(asset->file_vertex.begin(), asset->file_vertex.end());
  EXPECT_EQ(seen.size(), asset->vertex_count);
  double mass = 0.0;
  for (std::uint32_t v = 0; v < asset->vertex_count; ++v) {
    const glm::vec3& p = description.mesh.positions[asset->file_vertex[v]];
    EXPECT_EQ(glm::vec3(asset->rest[v].x, asset->rest[v].y, asset->rest[v].z), p);
    EXPECT_EQ(asset->rest[v].inverse_mass == 0.0f, std::abs(p.z) > 0.04f);
    if (asset->rest[v].inverse_mass > 0.0f) mass += 1.0 / static_cast<double>(asset->rest[v].inverse_mass);
  }
  const double whole = 1060.0 * asset->volume;
  EXPECT_NEAR(mass / whole, 1.0 - static_cast<double>(asset->attached.size()) / asset->vertex_count, 1e-4);
  EXPECT_NEAR(asset->volume, 4.0 / 3.0 * 3.14159 * 1.25e-4, 0.06 * asset->volume);
  EXPECT_EQ(asset->attachments[0].count + asset->attachments[1].count, asset->attached.size());
}

TEST(BuildSurfaceAsset, VerticesThatNoTriangleHasAreLeftOut) {
  SurfaceMuscleDescription description = ball();
  description.mesh.positions.insert(description.mesh.positions.begin(), glm::vec3(5.0f));
  for (std::uint32_t& i : description.mesh.indices) ++i;
  for (SurfaceAttachment& a : description.attachments) {
    for (std::uint32_t& v : a.vertices) ++v;
  }
  const auto asset = *build_surface_asset(description, 2);
  EXPECT_EQ(asset->vertex_count, description.mesh.positions.size() - 1);
  EXPECT_LT(asset->size, 0.2f);
  EXPECT_EQ(std::count(asset->file_vertex.begin(), asset->file_vertex.end(), 0u), 0);
}

TEST(BuildSurfaceAsset, EdgesAlongFibresAreSoft) {
  SurfaceMuscleDescription description = ball();
  description.fibres = {{.points = {{0, 0, -1}, {0, 0, 1}}}};
  description.settings.along_fibres = 0.25f;
  const auto asset = *build_surface_asset(description, 2);
  for (const Hinge& hinge : asset->hinges) {
    const SurfacePoint &p = asset->rest[hinge.vertex[0]], &q = asset->rest[hinge.vertex[1]];
    EXPECT_NEAR(hinge.anisotropy, std::max(0.25f, 1.0f - std::abs(q.z - p.z) / hinge.length), 1e-5f);
  }
  // k divides the compliance; without a floor an edge along the fibre is as good as absent.
  description.settings.along_fibres = 0.0f;
  description.fibres = {{.points = {{0, 0, 0.05f}, {0.01f, 0, 0.05f}}}};
  EXPECT_TRUE(build_surface_asset(description, 2).ok());
}

TEST(BuildSurfaceAsset, BonesCarryByHarmonicShares) {
  const auto asset = *build_surface_asset(ball(), 2);
  ASSERT_EQ(asset->carriers.size(), 2u);
  ASSERT_EQ(asset->carry.size(), asset->vertex_count);
  for (std::uint32_t v = 0; v < asset->vertex_count; ++v) {
    const CarryWeights& carry = asset->carry[v];
    EXPECT_NEAR(carry.weight[0] + carry.weight[1], 1.0f, 1e-6f);
    EXPECT_EQ(carry.weight[2], 0.0f);
    float upper = 0.0f;
    for (std::size_t i = 0; i < 2; ++i) upper += asset->carriers[carry.carrier[i]].bone == 1 ? carry.weight[i] : 0.0f;
    const float z = asset->rest[v].z;
    if (z > 0.04f) {
      EXPECT_EQ(upper, 1.0f);
    }
    if (z < -0.04f) {
      EXPECT_EQ(upper, 0.0f);
    }
    if (std::abs(z) < 1e-6f) {
      EXPECT_NEAR(upper, 0.5f, 1e-3f);  // half way
    }
    if (z > 0.01f) {
      EXPECT_GT(upper, 0.5f);
    }
  }
}

TEST(BuildSurfaceAsset, NothingCarriesWhatNoBoneMoves) {
  SurfaceMuscleDescription description = ball();
  description.attachments[1].bone = 0;
  EXPECT_TRUE((*build_surface_asset(description, 2))->carry.empty());
  description.attachments.clear();
  EXPECT_TRUE((*build_surface_asset(description, 2))->carry.empty());
  // One bone that is not the frame carries all of it.
  description = ball();
  description.attachments.erase(description.attachments.begin());
  const auto asset = *build_surface_asset(description, 2);
  ASSERT_EQ(asset->carry.size(), asset->vertex_count);
  EXPECT_EQ(asset->carry[5].weight[0], 1.0f);
}

TEST(BuildSurfaceAsset, ADriverCarriesByTheSectionsAboutAVertex) {
  const auto muscles = *build_muscle_asset(test::synthetic_muscles(), test::rest_bones());
  const MuscleLayout& layout = muscles->muscles[0];
  SurfaceMuscleDescription description = ball();
  const glm::vec3 middle = 0.5f * (rest_point(*muscles, 0, 1) + rest_point(*muscles, 0, 2));
  for (glm::vec3& p : description.mesh.positions) p = middle + 0.1f * p;
  description.driver = layout.name;
  const auto asset = *build_surface_asset(description, test::kSyntheticBones, muscles.get());
  ASSERT_EQ(asset->carriers.size(), layout.section_count);
  EXPECT_FLOAT_EQ(asset->carriers[1].section, 1.0f / static_cast<float>(1u << layout.subdivision));
  float weight_1 = 0.0f, weight_2 = 0.0f;
  for (const CarryWeights& carry : asset->carry) {
    for (std::size_t i = 0; i < 4; ++i) {
      weight_1 += carry.carrier[i] == 1 ? carry.weight[i] : 0.0f;
      weight_2 += carry.carrier[i] == 2 ? carry.weight[i] : 0.0f;
    }
  }
  const auto count = static_cast<float>(asset->vertex_count);
  EXPECT_NEAR(weight_1 / count, 0.5f, 0.06f);
  EXPECT_NEAR(weight_2 / count, 0.5f, 0.06f);
}

TEST(BuildSurfaceAsset, TheHipsMusclesOfTheData) {
  FASCICLE_SKIP_WITHOUT_DATA("pbd/femur.vtk");
  const auto femur = *read_vtk((test::data_folder() / "pbd/femur.vtk").string());
  const ClosestPoints closest(femur);
  struct Case {
    const char* file;
    float held;                             // mm: above, the pelvis holds it
    std::size_t vertices, triangles, femur;
    double volume;                          // mm^3
  };
  for (const Case& c : {Case{"gluteus_maximus.vtk", -343.7f, 9878, 19752, 269, 746.6e3},
                        Case{"iliacus.vtk", -313.8f, 6931, 13858, 267, 102.3e3}}) {
    SurfaceMuscleDescription description;
    description.name = c.file;
    description.mesh = *read_vtk((test::data_folder() / "pbd" / c.file).string());
    SurfaceAttachment held{.bone = 0, .origin = true, .vertices = {}}, led{.bone = 1, .origin = false, .vertices = {}};
    for (std::uint32_t v = 0; v < description.mesh.positions.size(); ++v) {
      const glm::vec3& p = description.mesh.positions[v];
      if (p.z > c.held) held.vertices.push_back(v);
      else if (closest.within(p, 2.0f).distance < 2.0f) led.vertices.push_back(v);
    }
    for (glm::vec3& p : description.mesh.positions) p *= 1.0e-3f;
    description.attachments = {held, led};
    const auto built = build_surface_asset(description, 2);
    ASSERT_TRUE(built.ok()) << to_text(built.diagnostics());
    const SurfaceAsset& asset = **built;
    EXPECT_EQ(asset.vertex_count, c.vertices);
    EXPECT_EQ(asset.triangle_count(), c.triangles);
    EXPECT_EQ(asset.attachments[1].count, c.femur);
    EXPECT_EQ(asset.hinges.size(), 3 * c.triangles / 2);
    EXPECT_NEAR(asset.volume * 1e9, c.volume, 1e-3 * c.volume);
    // Few colours, well filled: no more than a tenth of the lanes are spare.
    EXPECT_LE(asset.first_pack.size(), 32u);
    EXPECT_LT(static_cast<double>(asset.packs.size() * kHingeLanes), 1.1 * static_cast<double>(asset.hinges.size()));
  }
}

}  // namespace
}  // namespace fascicle::muscle
