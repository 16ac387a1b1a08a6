#include "engine/animation/joint_model.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/animation/joint_model_reader.hpp"
#include "engine/animation/joint_model_writer.hpp"

namespace fascicle {
namespace {

using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

// A pendulum of two: arm at (0, 1, 0) turning about z, forearm 0.3 m below turning about z as well.
const char* const kPendulum = R"({
  "bodies": [ { "name": "forearm", "mass": 1 }, { "name": "arm", "mass": 2 } ],
  "coordinates": [
    { "name": "shoulder", "range": [-3, 3] },
    { "name": "elbow", "default": 0.5, "range": [0, 2.5], "clamped": true },
    { "name": "lift", "kind": "translation", "range": [-1, 1], "locked": true, "default": 0.25 },
    { "name": "follower", "range": [-9, 9], "coupled_to": { "coordinate": "elbow", "function": { "linear": [2, 0.1] } } }
  ],
  "joints": [
    { "name": "b", "parent": "arm", "child": "forearm", "parent_frame": { "translation": [0, -0.3, 0] },
      "rotations": [ { "axis": [0, 0, 2], "coordinate": "elbow" } ] },
    { "name": "a", "parent": "ground", "child": "arm", "parent_frame": { "translation": [0, 1, 0] },
      "rotations": [ { "axis": [0, 0, 1], "coordinate": "shoulder" } ],
      "translations": [ { "axis": [0, 1, 0], "coordinate": "lift" } ] }
  ] })";

Result<JointModel> read(const std::string& text) {
  const auto document = parse_json(text, "model.json");
  if (!document) return document.diagnostics();
  return read_joint_model(document->root());
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? std::string() : text.replace(at, from.size(), to);
}

struct Broken {
  const char* name;
  const char* from;
  const char* to;
  const char* expected;
};

const Broken kBroken[] = {
    {"NoBodies", "\"bodies\": [ { \"name\": \"forearm\", \"mass\": 1 }, { \"name\": \"arm\", \"mass\": 2 } ],", "",
     "bodies"},
    {"BodyTwice", "\"name\": \"arm\"", "\"name\": \"forearm\"", "the body 'forearm' is there already"},
    {"UnknownBody", "\"parent\": \"arm\"", "\"parent\": \"amr\"", "unknown body 'amr'; did you mean 'arm'?"},
    {"UnknownCoordinate", "\"coordinate\": \"elbow\" }", "\"coordinate\": \"elbwo\" }",
     "unknown coordinate 'elbwo'; did you mean 'elbow'?"},
    {"UnknownField", "\"mass\": 1", "\"mas\": 1", "mas"},
    {"RangeOfOne", "\"range\": [-3, 3]", "\"range\": [-3]", "this is not a range"},
    {"RangeBackwards", "\"range\": [-3, 3]", "\"range\": [3, -3]",
     "this is not a range; give two numbers, the smaller first"},
    {"NoRange", ", \"range\": [-3, 3]", "", "range"},
    {"ClampedDefaultAbove", "\"default\": 0.5", "\"default\": 2.6",
     "model.json:5:35: /coordinates/1/default: the default 2.6 of a clamped coordinate lies outside its range, 0 to "
     "2.5"},
    {"ClampedDefaultBelow", "\"default\": 0.5", "\"default\": -0.1", "the default -0.1 of a clamped coordinate"},
    {"ClampedDefaultLeftOut", "\"default\": 0.5, \"range\": [0, 2.5]", "\"range\": [1, 2.5]",
     "/coordinates/1/range: the default 0 of a clamped coordinate lies outside its range, 1 to 2.5; give a "
     "\"default\""},
    {"AxisOfTwo", "\"axis\": [0, 0, 2]", "\"axis\": [0, 2]", "2 numbers; give three"},
    {"AxisOfNoLength", "\"axis\": [0, 0, 2]", "\"axis\": [0, 0, 0]",
     "model.json:10:5: /joints/0: an axis of the joint 'b' has no length"},
    {"AxisOfNothing", "\"axis\": [0, 0, 2], \"coordinate\": \"elbow\"", "\"axis\": [0, 0, 2]",
     "neither a coordinate nor a function"},
    {"Circle", "\"parent\": \"ground\"", "\"parent\": \"forearm\"", "run in a circle"},
    {"OwnParent", "\"parent\": \"ground\"", "\"parent\": \"arm\"", "run in a circle"},
    {"BodyWithoutJoint", "\"child\": \"arm\"", "\"child\": \"forearm\"", "the child of two joints"},
    {"CoordinateTwice", "\"name\": \"elbow\"", "\"name\": \"shoulder\"", "the coordinate 'shoulder' is there already"},
    {"CoupledInACircle", "\"coordinate\": \"elbow\", \"function\"", "\"coordinate\": \"follower\", \"function\"",
     "coupled in a circle"},
    {"TwoFunctions", "{ \"linear\": [2, 0.1] }", "{ \"linear\": [2, 0.1], \"polynomial\": [1] }",
     "give exactly one of them"},
    {"LinearOfOne", "{ \"linear\": [2, 0.1] }", "{ \"linear\": [2] }", "1 numbers; give two: slope, value at 0"},
    {"SplineFalls", "{ \"linear\": [2, 0.1] }", "{ \"spline\": { \"x\": [0, -1], \"y\": [0, 0] } }",
     "x falls or repeats at point 1"},
    {"FunctionIsText", "{ \"linear\": [2, 0.1] }", "\"twice\"", "function"},
    {"NegativeMass", "\"mass\": 2", "\"mass\": -2", "mass"},
};

class BrokenJoints : public testing::TestWithParam<Broken> {};

TEST_P(BrokenJoints, AreRefused) {
  const std::string text = replaced(kPendulum, GetParam().from, GetParam().to);
  ASSERT_FALSE(text.empty());
  const auto model = read(text);
  ASSERT_FALSE(model.ok());
  EXPECT_THAT(to_text(model.diagnostics()), HasSubstr(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(JointModel, BrokenJoints, testing::ValuesIn(kBroken),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(JointModel, ADefaultMayLieOutsideOfARangeThatDoesNotClampOrAtItsEnd) {
  const std::string free = replaced(kPendulum, "\"default\": 0.5, \"range\": [0, 2.5], \"clamped\": true",
                                    "\"default\": 9, \"range\": [0, 2.5]");
  ASSERT_FALSE(free.empty());
  EXPECT_TRUE(read(free).ok());
  EXPECT_TRUE(read(replaced(kPendulum, "\"default\": 0.5", "\"default\": 2.5")).ok());
}

TEST(JointModel, SortsParentsFirstAndTurnsTheGround) {
  const auto model = read(kPendulum);
  ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
  EXPECT_THAT(model->skeleton->names, testing::ElementsAre("ground", "arm", "forearm"));
  EXPECT_THAT(model->skeleton->parents, testing::ElementsAre(-1, 0, 1));
  EXPECT_EQ(model->bodies[1].mass, 2.0);
  EXPECT_EQ(model->joints[1].name, "b");
  // x forward, y up, z right become z, y and -x: a rotation.
  const auto bones = evaluate_bones(*model, default_coordinates(*model));
  EXPECT_LT(glm::distance(bones[0] * glm::dvec3(1, 2, 3), glm::dvec3(-3, 2, 1)), 1e-15);
  EXPECT_NEAR(glm::determinant(bones[0].rotation), 1.0, 1e-15);
}

TEST(JointModel, PosesAPendulum) {
  const auto model = read(kPendulum);
  ASSERT_TRUE(model.ok());
  const std::vector<double> values{kPi / 2, 1.0, 0.0, 0.0};
  const auto bones = evaluate_bones(*model, values);
  // The shoulder lifts the arm forward (about z, to the right): the elbow lies 0.3 m ahead at the shoulder's height,
  // which the locked lift keeps 0.25 m up. Ahead is z.
  EXPECT_LT(glm::distance(bones[2].translation, glm::dvec3(0.0, 1.25, 0.3)), 1e-15);
  // The forearm's end, 0.2 m on, turned by one more radian.
  const glm::dvec3 end = bones[2] * glm::dvec3(0.0, -0.2, 0.0);
  EXPECT_LT(glm::distance(end, glm::dvec3(0.0, 1.25 + 0.2 * std::sin(1.0), 0.3 + 0.2 * std::cos(1.0))), 1e-15);
}

TEST(JointModel, ClampsLocksAndCouples) {
  const auto model = read(kPendulum);
  ASSERT_TRUE(model.ok());
  const std::vector<double> values{5.0, 5.0, 5.0, 5.0};
  EXPECT_EQ(coordinate_value(*model, values, 0), 5.0);   // its range is not enforced
  EXPECT_EQ(coordinate_value(*model, values, 1), 2.5);   // clamped
  EXPECT_EQ(coordinate_value(*model, values, 2), 0.25);  // locked
  EXPECT_DOUBLE_EQ(coordinate_value(*model, values, 3), 2 * 2.5 + 0.1);
  const std::vector<double> wild{std::nan(""), std::numeric_limits<double>::infinity(), 0.0, 0.0};
  EXPECT_EQ(coordinate_value(*model, wild, 0), 0.0);
  EXPECT_EQ(coordinate_value(*model, wild, 1), 2.5);
}

TEST(JointModel, RotatesAboutCarriedAxesInOrder) {
  // Body-fixed z, x, y by a quarter each.
  const auto model = read(R"({ "bodies": [ { "name": "b" } ],
    "coordinates": [ { "name": "p", "range": [0, 1] }, { "name": "q", "range": [0, 1] }, { "name": "r", "range": [0, 1] } ],
    "joints": [ { "name": "j", "parent": "ground", "child": "b",
      "child_frame": { "translation": [0, 0, 0.5], "orientation": [0.1, 0.2, 0.3] },
      "rotations": [ { "axis": [0, 0, 1], "coordinate": "p" }, { "axis": [1, 0, 0], "coordinate": "q" },
                     { "axis": [0, 1, 0], "coordinate": "r" } ] } ] })");
  ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
  const double quarter = kPi / 2;
  const RigidTransform pose = evaluate_joint(*model, std::vector<double>{quarter, quarter, quarter}, 0);
  // The point at the child frame's origin stays at the joint.
  EXPECT_LT(glm::length(pose * glm::dvec3(0, 0, 0.5)), 1e-15);
  // R = Rz Rx Ry on the child frame's x axis: Ry takes x to -z, Rx takes -z to y, Rz takes y to -x.
  const glm::dmat3 child = rotation_from_xyz({0.1, 0.2, 0.3});
  EXPECT_LT(glm::distance(pose.rotation * (child * glm::dvec3(1, 0, 0)), glm::dvec3(-1, 0, 0)), 1e-15);
  EXPECT_LT(glm::distance(rotation_from_xyz({quarter, quarter, 0.0}) * glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)),
            1e-15);
}

TEST(JointModel, WritesTheSamePoseInSinglePrecision) {
  const auto model = read(kPendulum);
  ASSERT_TRUE(model.ok());
  const std::vector<double> values{0.7, 1.3, 0.0, 0.0};
  std::vector<Trs> local(3);
  pose_joints(*model, values, local);
  const auto bones = evaluate_bones(*model, values);
  const glm::mat4 world = to_matrix(local[0]) * to_matrix(local[1]) * to_matrix(local[2]);
  const glm::vec3 point(world * glm::vec4(0.1f, -0.2f, 0.3f, 1.0f));
  EXPECT_LT(glm::distance(glm::dvec3(point), bones[2] * glm::dvec3(0.1, -0.2, 0.3)), 2e-7);
  pose_joints(*model, default_coordinates(*model), local);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_EQ(local[b].translation, model->skeleton->rest_local[b].translation);
    EXPECT_EQ(local[b].rotation, model->skeleton->rest_local[b].rotation);
  }
}

TEST(JointModel, NeverWritesAPoseThatIsNotFinite) {
  const auto model = read(R"({ "bodies": [ { "name": "b" } ], "coordinates": [ { "name": "q", "range": [0, 1] } ],
    "joints": [ { "name": "j", "parent": "ground", "child": "b",
      "translations": [ { "axis": [1, 0, 0], "coordinate": "q", "function": { "polynomial": [1, 0, 0, 0, 0, 0, 0, 0, 0] } } ] } ] })");
  ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
  std::vector<Trs> local(2);
  pose_joints(*model, std::vector<double>{1e300}, local);
  EXPECT_EQ(local[1].translation, glm::vec3(0.0f));
}

TEST(JointModel, WhatIsWrittenReadsBackAlike) {
  const auto model = read(kPendulum);
  ASSERT_TRUE(model.ok());
  const std::string text = write_joint_model(*model, 0);
  const auto again = read(text);
  ASSERT_TRUE(again.ok()) << to_text(again.diagnostics());
  EXPECT_EQ(write_joint_model(*again, 0), text);
  EXPECT_THAT(text, HasSubstr("\"axis\": [0, 0, 2]"));  // as it was given
}

}  // namespace
}  // namespace fascicle
