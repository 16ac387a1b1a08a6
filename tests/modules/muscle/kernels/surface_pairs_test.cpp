#include "modules/muscle/kernels/surface/surface_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/geometry/closest_point.hpp"
#include "modules/muscle/asset/surface/rest_clearance.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/plain_surface.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/sheet.hpp"

namespace fascicle::muscle {
namespace {

constexpr float kContact = 0.0012f, kMargin = 0.001f;  // m

glm::vec3 place(const SurfacePoint& p) { return {p.x, p.y, p.z}; }

// A muscle as find_pairs wants it.
struct Body {
  explicit Body(const TriangleMesh& mesh, bool itself = false) : asset(test::plain_surface(mesh)) {
    asset.mean_edge = asset.hinges.empty() ? 0.001f : asset.hinges[0].length;
    tree = build_surface_tree(asset);
    lay_out_boxes(tree, asset, itself, boxes);
    points = asset.rest;
  }

  void keep_clear_of(const Body& other) { clearance = find_rest_clearance(asset, other.asset, kContact); }

  void move(const glm::mat4& by) {
    for (SurfacePoint& p : points) {
      const glm::vec3 moved(by * glm::vec4(place(p), 1.0f));
      p = {moved.x, moved.y, moved.z, p.inverse_mass};
    }
  }

  PairedSurface paired() { return {&asset, &tree, &boxes, points, clearance}; }

  SurfaceAsset asset;
  SurfaceTree tree;
  SurfaceBoxes boxes;
  AlignedVector<SurfacePoint> points;
  std::vector<float> clearance;
};

PairsJob job_of(Body& first, Body* second = nullptr, float margin = kMargin) {
  PairsJob job;
  job.first = first.paired();
  if (second != nullptr) job.second = second->paired();
  job.contact_distance = kContact;
  job.margin = margin;
  return job;
}

void find(const PairsJob& job, Body& first, Body* second, SurfacePairs& pairs) {
  place_boxes(first.tree, first.asset, first.points, first.boxes);
  if (second != nullptr) place_boxes(second->tree, second->asset, second->points, second->boxes);
  find_pairs(job, pairs);
}

bool equal(const AlignedVector<SurfacePoint>& a, const AlignedVector<SurfacePoint>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const SurfacePoint& p, const SurfacePoint& q) {
    return p.x == q.x && p.y == q.y && p.z == q.z && p.inverse_mass == q.inverse_mass;
  });
}

// One triangle in the plane y = 0 that looks up, and one far below that a vertex of its own belongs to.
TriangleMesh triangle_at(float y, float size = 0.01f) {
  TriangleMesh mesh;
  mesh.positions = {{0, y, 0}, {0, y, size}, {size, y, 0}};
  mesh.indices = {0, 1, 2};
  return mesh;
}

// Where a point is against a triangle, by code of its own.
struct Against {
  double distance = 0.0, height = 0.0;  // m
  bool over = false;                    // the nearest point is straight below
};
Against against(const glm::vec3& p, const Body& body, std::uint32_t t) {
  const std::uint32_t* corner = &body.asset.triangles[3 * t];
  const glm::dvec3 q(p), a(place(body.points[corner[0]])), b(place(body.points[corner[1]])),
      c(place(body.points[corner[2]]));
  const glm::dvec3 nearest = closest_point_on_triangle(q, a, b, c);
  const double distance = glm::distance(q, nearest);
  const double height = glm::dot(glm::normalize(glm::cross(b - a, c - a)), q - a);
  return {distance, height, distance - std::abs(height) < 1e-9};
}

TEST(SurfaceTree, HoldsEachTriangleOnceAndGivesEachVertexToOneLeaf) {
  const SurfaceTree none = build_surface_tree(test::plain_surface({}));
  EXPECT_TRUE(none.nodes.empty());

  const Body body(test::make_torus(0.05f, 0.02f, 40, 24));
  std::multiset<std::uint32_t> triangles, own;
  for (std::size_t n = 0; n < body.tree.nodes.size(); ++n) {
    const SurfaceTree::Node& node = body.tree.nodes[n];
    if (node.count == 0) {
      EXPECT_GT(node.right, n + 1);
      continue;
    }
    EXPECT_LE(node.count, kSurfaceLeaf);
    const auto vertices = body.tree.vertices.begin() + node.first_vertex;
    own.insert(vertices, vertices + node.own);
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t t = body.tree.triangles[node.first + i];
      triangles.insert(t);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(std::count(vertices, vertices + node.vertex_count, body.asset.triangles[3 * t + k]), 1);
      }
    }
  }
  EXPECT_EQ(triangles.size(), body.asset.triangle_count());
  EXPECT_EQ(std::set<std::uint32_t>(triangles.begin(), triangles.end()).size(), body.asset.triangle_count());
  EXPECT_EQ(own.size(), body.asset.vertex_count);
  EXPECT_EQ(std::set<std::uint32_t>(own.begin(), own.end()).size(), body.asset.vertex_count);
}

TEST(SurfaceTree, KeepsTheTwoSidesOfASheetApart) {
  const Body body(test::make_sheet({0.04f, 0.001f, 0.04f}, 40, 40));
  std::size_t mixed = 0, leaves = 0;
  for (const SurfaceTree::Node& node : body.tree.nodes) {
    bool up = false, down = false;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t* corner = &body.asset.triangles[3 * body.tree.triangles[node.first + i]];
      const glm::vec3 a = place(body.points[corner[0]]);
      const float turn = glm::cross(place(body.points[corner[1]]) - a, place(body.points[corner[2]]) - a).y;
      up = up || turn > 0.0f;
      down = down || turn < 0.0f;
    }
    leaves += node.count > 0;
    mixed += up && down;
  }
  EXPECT_LT(mixed * 20, leaves);
}

TEST(SurfaceBoxes, HoldWhatIsBelowThem) {
  Body body(test::make_sphere(0.03f, 16, 24), true);
  body.move(glm::scale(glm::mat4(1.0f), glm::vec3(1.0f, 2.0f, 0.5f)));
  place_boxes(body.tree, body.asset, body.points, body.boxes);
  const SurfaceRange& all = body.boxes.boxes[0];
  for (const SurfacePoint& p : body.points) {
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      EXPECT_LE(all.lower[axis], place(p)[k]);
      EXPECT_GE(all.upper[axis], place(p)[k]);
    }
  }
  EXPECT_FLOAT_EQ(all.upper[1], 0.06f);  // the rings have vertices on the y axis
  for (std::size_t t = 0; t < body.asset.triangle_count(); ++t) {
    const SurfaceNormal& n = body.boxes.triangle_normals[t];
    EXPECT_NEAR(n.x * n.x + n.y * n.y + n.z * n.z, 1.0f, 1e-6f);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = body.asset.triangles[3 * t + k];
      EXPECT_GT(glm::dot(place(body.points[v]), glm::vec3(n.x, n.y, n.z)), 0.0f);
      EXPECT_LE(body.boxes.vertex_normals[v].lower[k], (&n.x)[k]);
      EXPECT_GE(body.boxes.vertex_normals[v].upper[k], (&n.x)[k]);
      EXPECT_LE(body.boxes.normal_ranges[0].lower[k], (&n.x)[k]);
    }
  }
}

TEST(RestClearance, IsTheSignedDistanceUpToTheReach) {
  const Body large(test::make_sphere(0.05f, 48, 64));
  Body other(test::make_sphere(0.02f, 24, 32, {0.06f, 0.0f, 0.0f}));
  const std::vector<float> clearance = find_rest_clearance(other.asset, large.asset, 0.004f);
  std::size_t inside = 0, beyond = 0;
  for (std::size_t v = 0; v < clearance.size(); ++v) {
    const float expected = std::min(glm::length(place(other.points[v])) - 0.05f, 0.004f);
    EXPECT_NEAR(clearance[v], expected, 2e-4f);  // the sphere has corners
    inside += clearance[v] < 0.0f;
    beyond += clearance[v] == 0.004f;
  }
  EXPECT_GT(inside, 50u);
  EXPECT_GT(beyond, 50u);
}

TEST(FindPairs, OfNothingAreNone) {
  Body empty{TriangleMesh{}}, sphere(test::make_sphere(0.02f, 8, 12));
  SurfacePairs pairs;
  lay_out_pairs(100, pairs);
  find(job_of(empty, &sphere), empty, &sphere, pairs);
  EXPECT_TRUE(pairs.pairs.empty());
  const PairsJob job = job_of(sphere, &empty);
  find(job, sphere, &empty, pairs);
  EXPECT_TRUE(pairs.pairs.empty());
  project_pairs(job, pairs);
  EXPECT_EQ(pairs.pushed, 0u);
}

// Pairs of two muscles where a vertex is in reach outside of a triangle, against a search of every vertex with every
// triangle: all where it is straight above, and none out of reach.
void expect_all_pairs(Body& first, Body& second, const SurfacePairs& pairs, const glm::mat4& second_to_first) {
  std::set<std::tuple<int, std::uint32_t, std::uint32_t>> found;
  for (const SurfacePair& pair : pairs.pairs) found.insert({pair.of_second, pair.vertex, pair.triangle});
  EXPECT_EQ(found.size(), pairs.pairs.size());
  Body moved = second;
  moved.move(second_to_first);
  std::size_t near = 0;
  constexpr double kReach = static_cast<double>(kContact + kMargin), kNearly = 1e-6;
  for (int of_second = 0; of_second < 2; ++of_second) {
    const Body& of = of_second != 0 ? moved : first;
    const Body& other = of_second != 0 ? first : moved;
    for (std::uint32_t v = 0; v < of.asset.vertex_count; ++v) {
      for (std::uint32_t t = 0; t < other.asset.triangle_count(); ++t) {
        const Against at = against(place(of.points[v]), other, t);
        const bool is_found = found.contains({of_second, v, t});
        const bool must = at.over && at.height > kNearly && at.distance < kReach - kNearly;
        const bool may = at.height > -kNearly && at.distance < kReach + kNearly;
        near += must;
        EXPECT_TRUE(is_found || !must) << of_second << ' ' << v << ' ' << t;
        EXPECT_TRUE(may || !is_found) << of_second << ' ' << v << ' ' << t;
      }
    }
  }
  EXPECT_GT(near, 10u);
}

TEST(FindPairs, OfTwoMusclesAreAllThatAreInReach) {
  Body first(test::make_sphere(0.03f, 36, 48)), second(test::make_sphere(0.02f, 24, 36, {0.0505f, 0.004f, 0.0f}));
  SurfacePairs pairs;
  lay_out_pairs(10000, pairs);
  find(job_of(first, &second), first, &second, pairs);
  expect_all_pairs(first, second, pairs, glm::mat4(1.0f));
}

TEST(FindPairs, OfMusclesInFramesOfTheirOwnAreTheSame) {
  Body first(test::make_sphere(0.03f, 36, 48)), second(test::make_sphere(0.02f, 24, 36, {0.0505f, 0.004f, 0.0f}));
  const glm::mat4 frame = glm::rotate(glm::translate(glm::mat4(1.0f), {0.3f, -0.2f, 0.1f}), 1.1f,
                                      glm::normalize(glm::vec3(1.0f, 2.0f, 3.0f)));
  second.move(glm::inverse(frame));
  PairsJob job = job_of(first, &second);
  job.second_to_first = frame;
  SurfacePairs pairs;
  lay_out_pairs(10000, pairs);
  find(job, first, &second, pairs);
  expect_all_pairs(first, second, pairs, frame);
}

TEST(FindPairs, OfAMuscleWithItselfAreNoneWhereItIsNotFolded) {
  for (const TriangleMesh& mesh : {test::make_sphere(0.03f, 24, 36), test::make_torus(0.04f, 0.01f, 60, 20)}) {
    Body body(mesh, true);
    SurfacePairs pairs;
    lay_out_pairs(10000, pairs);
    find(job_of(body), body, nullptr, pairs);
    EXPECT_TRUE(pairs.pairs.empty());
  }
}

TEST(FindPairs, OfASheetAreItsTwoSidesAndRestStaysExactly) {
  Body body(test::make_sheet({0.04f, 0.002f, 0.04f}, 20, 20), true);
  SurfacePairs pairs;
  lay_out_pairs(20000, pairs);
  const PairsJob job = job_of(body);
  for (int step = 0; step < 3; ++step) {
    find(job, body, nullptr, pairs);
    ASSERT_GT(pairs.pairs.size(), 400u);
    for (const SurfacePair& pair : pairs.pairs) EXPECT_EQ(pair.side, -1);
    project_pairs(job, pairs);
    EXPECT_EQ(pairs.pushed, 0u);
    EXPECT_TRUE(equal(body.points, body.asset.rest));
  }
}

TEST(FindPairs, WithoutRoomAreCountedAsAnOverflow) {
  Body body(test::make_sheet({0.04f, 0.002f, 0.04f}, 20, 20), true);
  SurfacePairs pairs;
  lay_out_pairs(7, pairs);
  const PairsJob job = job_of(body);
  find(job, body, nullptr, pairs);
  EXPECT_EQ(pairs.pairs.size(), 7u);
  EXPECT_EQ(pairs.overflows, 1u);
  project_pairs(job, pairs);
  lay_out_pairs(usual_pair_capacity(body.asset.vertex_count), pairs);
  find(job, body, nullptr, pairs);
  EXPECT_EQ(pairs.overflows, 0u);
}

TEST(FindPairs, NothingIsAllocatedAndTwoRunsGiveTheSameBits) {
  const auto run = [] {
    Body body(test::make_sheet({0.04f, 0.002f, 0.04f}, 20, 20), true);
    for (SurfacePoint& p : body.points) {
      p.y += 0.03f * std::sin(100.0f * p.x);
      p.y *= 0.2f;
    }
    SurfacePairs pairs;
    lay_out_pairs(20000, pairs);
    const PairsJob job = job_of(body);
    const test::AllocationScope scope;
    for (int step = 0; step < 4; ++step) {
      find(job, body, nullptr, pairs);
      for (int substep = 0; substep < 3; ++substep) project_pairs(job, pairs);
    }
    EXPECT_EQ(scope.allocations(), 0u);
    EXPECT_GT(pairs.pairs.size(), 0u);
    return body.points;
  };
  EXPECT_TRUE(equal(run(), run()));
}

// A vertex over a triangle that looks up (+y). The other muscle is a triangle, too, whose first corner is lowest.
struct VertexOverTriangle {
  VertexOverTriangle() : below(triangle_at(0.0f)), above(needle()) {
    above.clearance.assign(3, kContact);
    below.clearance.assign(3, kContact);
    lay_out_pairs(100, pairs);
  }

  static TriangleMesh needle() {
    TriangleMesh mesh;
    mesh.positions = {{0.003f, 0.002f, 0.002f}, {0.1f, 0.2f, 0.1f}, {0.1f, 0.2f, 0.12f}};
    mesh.indices = {0, 1, 2};
    return mesh;
  }

  void find() { muscle::find(job_of(below, &above), below, &above, pairs); }
  void project() { project_pairs(job_of(below, &above), pairs); }

  Body below, above;
  SurfacePairs pairs;
};

TEST(ProjectPairs, PartsByInverseMasses) {
  VertexOverTriangle scene;
  scene.above.points[0].inverse_mass = 2.0f;
  for (int k = 0; k < 3; ++k) scene.below.points[static_cast<std::size_t>(k)].inverse_mass = static_cast<float>(k);
  scene.find();
  ASSERT_EQ(scene.pairs.pairs.size(), 1u);
  scene.project();
  EXPECT_EQ(scene.pairs.pushed, 0u);  // further than the contact distance

  scene.above.points[0].y = 0.0002f;
  const float b[3] = {0.5f, 0.2f, 0.3f}, w[3] = {0.0f, 1.0f, 2.0f};
  const float sum = 2.0f + b[1] * b[1] * w[1] + b[2] * b[2] * w[2], lambda = 0.001f / sum;
  scene.project();
  EXPECT_EQ(scene.pairs.pushed, 1u);
  EXPECT_NEAR(scene.pairs.deepest, 0.001f, 1e-8f);
  EXPECT_NEAR(scene.above.points[0].y, 0.0002f + 2.0f * lambda, 1e-8f);
  EXPECT_EQ(scene.above.points[0].x, 0.003f);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(scene.below.points[k].y, -w[k] * b[k] * lambda, 1e-8f);
}

TEST(ProjectPairs, NothingThatCannotMoveIsMoved) {
  VertexOverTriangle scene;
  for (SurfacePoint& p : scene.below.points) p.inverse_mass = 0.0f;
  scene.find();
  scene.above.points[0].y = 0.0f;
  scene.project();
  EXPECT_TRUE(equal(scene.below.points, [&] {
    AlignedVector<SurfacePoint> rest = scene.below.asset.rest;
    for (SurfacePoint& p : rest) p.inverse_mass = 0.0f;
    return rest;
  }()));
  EXPECT_NEAR(scene.above.points[0].y, kContact, 1e-8f);
}

TEST(ProjectPairs, WhatHasGoneThroughComesBackHoweverFast) {
  for (const float y : {-0.0001f, -0.002f, -0.5f}) {
    VertexOverTriangle scene;
    for (SurfacePoint& p : scene.below.points) p.inverse_mass = 0.0f;
    scene.find();
    scene.above.points[0].y = y;
    scene.project();
    EXPECT_NEAR(scene.above.points[0].y, kContact, 1e-7f);
  }
}

TEST(ProjectPairs, WhatIsHeldDownRemembersItsSideInTheNextStep) {
  VertexOverTriangle scene;
  for (SurfacePoint& p : scene.below.points) p.inverse_mass = 0.0f;
  scene.find();
  scene.above.points[0].y = -0.001f;
  scene.project();
  scene.above.points[0].y = -0.0015f;  // something else presses harder
  scene.find();
  ASSERT_EQ(scene.pairs.pairs.size(), 1u);
  EXPECT_EQ(scene.pairs.pairs[0].side, 1);
  scene.project();
  EXPECT_NEAR(scene.above.points[0].y, kContact, 1e-7f);
}

TEST(ProjectPairs, WhatGoesRoundTheRimIsLetThrough) {
  VertexOverTriangle scene;
  for (SurfacePoint& p : scene.below.points) p.inverse_mass = 0.0f;
  scene.find();
  for (const auto& [x, y] : {std::pair{-0.002f, 0.002f}, {-0.002f, -0.002f}, {0.003f, -0.002f}}) {
    scene.above.points[0].x = x;
    scene.above.points[0].y = y;
    scene.project();
    EXPECT_EQ(scene.pairs.pushed, 0u);
    EXPECT_EQ(scene.above.points[0].y, y);
  }
  EXPECT_EQ(scene.pairs.pairs[0].side, -1);
}

TEST(ProjectPairs, BeyondTheRimTheNearestPointPushes) {
  VertexOverTriangle scene;
  for (SurfacePoint& p : scene.below.points) p.inverse_mass = 0.0f;
  scene.find();
  scene.above.points[0].x = -0.0003f;
  scene.above.points[0].y = 0.0004f;
  scene.project();
  EXPECT_NEAR(scene.above.points[0].x, -0.0003f * 0.0012f / 0.0005f, 1e-7f);
  EXPECT_NEAR(scene.above.points[0].y, 0.0004f * 0.0012f / 0.0005f, 1e-7f);
}

TEST(ProjectPairs, NoNumberStaysWhereItIs) {
  VertexOverTriangle scene;
  scene.find();
  scene.above.points[0].y = std::numeric_limits<float>::quiet_NaN();
  scene.project();
  EXPECT_TRUE(equal(scene.below.points, scene.below.asset.rest));
}

// What overlaps at rest.
TEST(ProjectPairs, MusclesMayBeAsDeepInEachOtherAsTheyAreAtRest) {
  const glm::vec3 apart(0.048f, 0.0f, 0.0f);
  Body first(test::make_sphere(0.03f, 24, 36)), second(test::make_sphere(0.02f, 16, 24, apart));
  first.keep_clear_of(second);
  second.keep_clear_of(first);
  ASSERT_LT(*std::min_element(second.clearance.begin(), second.clearance.end()), -0.0015f);
  SurfacePairs pairs;
  lay_out_pairs(20000, pairs);
  const PairsJob job = job_of(first, &second);
  find(job, first, &second, pairs);
  ASSERT_GT(pairs.pairs.size(), 20u);
  project_pairs(job, pairs);
  EXPECT_EQ(pairs.pushed, 0u);
  EXPECT_TRUE(equal(first.points, first.asset.rest));
  EXPECT_TRUE(equal(second.points, second.asset.rest));

  // 0.5 mm deeper: the difference is taken back, no more.
  for (SurfacePoint& p : first.points) p.inverse_mass = 0.0f;
  second.move(glm::translate(glm::mat4(1.0f), {-0.0005f, 0.0f, 0.0f}));
  project_pairs(job, pairs);
  EXPECT_GT(pairs.pushed, 5u);
  EXPECT_LT(pairs.deepest, 0.0006f);
  const auto deepest = static_cast<std::size_t>(
      std::min_element(second.clearance.begin(), second.clearance.end()) - second.clearance.begin());
  EXPECT_NEAR(second.points[deepest].x, second.asset.rest[deepest].x, 0.00005f);
}

// Two bodies pressed by half a millimetre a step, their own shapes kept by nothing: what touches must part.
TEST(ProjectPairs, TwoMusclesDoNotPassIntoEachOther) {
  Body first(test::make_sphere(0.03f, 24, 36)), second(test::make_sphere(0.02f, 16, 24, {0.0525f, 0.0f, 0.0f}));
  first.keep_clear_of(second);
  second.keep_clear_of(first);
  for (SurfacePoint& p : first.points) p.inverse_mass = 0.0f;
  SurfacePairs pairs;
  lay_out_pairs(20000, pairs);
  const PairsJob job = job_of(first, &second);
  for (int step = 0; step < 20; ++step) {
    find(job, first, &second, pairs);
    second.move(glm::translate(glm::mat4(1.0f), {-0.0005f, 0.0f, 0.0f}));
    for (int pass = 0; pass < 6; ++pass) project_pairs(job, pairs);
  }
  EXPECT_EQ(pairs.overflows, 0u);
  float nearest = 1.0f, moved = 0.0f;
  for (std::size_t v = 0; v < second.points.size(); ++v) {
    nearest = std::min(nearest, glm::length(place(second.points[v])));
    moved = std::max(moved, glm::distance(place(second.points[v]), place(second.asset.rest[v])));
  }
  EXPECT_GT(nearest, 0.03f);  // pressed by 10 mm, from 2.5 mm away
  EXPECT_GT(moved, 0.009f);
}

TEST(ProjectPairs, TheSidesOfASheetPressedTogetherStopHalfWay) {
  Body body(test::make_sheet({0.04f, 0.002f, 0.04f}, 20, 20), true);
  const std::size_t side = body.points.size() / 2;
  for (std::size_t v = side; v < body.points.size(); ++v) body.points[v].inverse_mass = 0.0f;
  SurfacePairs pairs;
  lay_out_pairs(20000, pairs);
  const PairsJob job = job_of(body);
  for (int step = 0; step < 10; ++step) {
    find(job, body, nullptr, pairs);
    for (std::size_t v = 0; v < side; ++v) body.points[v].y -= 0.0005f;
    for (int pass = 0; pass < 4; ++pass) project_pairs(job, pairs);
  }
  for (std::size_t v = 0; v < side; ++v) EXPECT_NEAR(body.points[v].y, 0.0f, 1e-5f);  // 1 mm above the lower side
}

// A strip is folded over onto itself about its middle until the two halves would have passed through each other.
TEST(ProjectPairs, AFoldDoesNotPassThroughItself) {
  const auto fold = [](bool contacts) {
    Body body(test::make_sheet({0.08f, 0.002f, 0.02f}, 48, 12), true);
    SurfacePairs pairs;
    lay_out_pairs(20000, pairs);
    const PairsJob job = job_of(body);
    float lowest = 1.0f;
    AlignedVector<SurfacePoint> last = body.asset.rest;
    constexpr int kSteps = 120;
    for (int step = 1; step <= kSteps; ++step) {
      if (contacts) find(job, body, nullptr, pairs);
      // The left half lies, the right one turns about a roll of 3 mm radius, by 194 degrees.
      const float angle = 194.0f / 180.0f * std::numbers::pi_v<float> * static_cast<float>(step) / kSteps;
      for (std::size_t v = 0; v < body.points.size(); ++v) {
        const SurfacePoint& rest = body.asset.rest[v];
        glm::vec3 to = place(rest);
        const float along = rest.x - 0.04f, arc = 0.003f * angle;
        const float turned = std::min(std::max(along, 0.0f) / std::max(arc, 1e-9f), 1.0f) * angle;
        const float radius = 0.003f - rest.y;
        if (along > 0.0f) {
          to = glm::vec3(0.04f + radius * std::sin(turned), 0.003f - radius * std::cos(turned), rest.z);
          const float beyond = std::max(along - arc, 0.0f);
          to += beyond * glm::vec3(std::cos(turned), std::sin(turned), 0.0f);
        }
        // Contacts may hold it back; what it is moved by is the way of this step.
        body.points[v].x += to.x - last[v].x;
        body.points[v].y += to.y - last[v].y;
        last[v] = {to.x, to.y, to.z, 1.0f};
        if (along <= 0.0f) body.points[v].inverse_mass = 0.0f;
      }
      for (int pass = 0; contacts && pass < 6; ++pass) project_pairs(job, pairs);
    }
    EXPECT_EQ(pairs.overflows, 0u);
    // The folded half over the lying one, but for the rim: nothing holds its vertices to the others, so they are pushed
    // aside and slip by.
    for (std::size_t v = 0; v < body.points.size(); ++v) {
      const SurfacePoint& rest = body.asset.rest[v];
      if (rest.x > 0.052f && rest.x < 0.077f && rest.z > 0.003f && rest.z < 0.017f) {
        lowest = std::min(lowest, body.points[v].y);
      }
    }
    return lowest;
  };
  EXPECT_LT(fold(false), 0.0f);  // inside of the lying half, whose upper side is at 1 mm
  EXPECT_GT(fold(true), 0.0018f);
}

}  // namespace
}  // namespace fascicle::muscle
