#include "modules/muscle/import/osim_reader.hpp"

#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/modules/muscle/import/small_model.hpp"

namespace fascicle::muscle {
namespace {

using test::small_model;
using test::with;
using testing::HasSubstr;

struct Broken {
  const char* name;
  std::string_view from;  // a piece of the small model
  std::string_view to;
  const char* expected;   // part of an error's text
};

// Each broken model with one of its errors, as printed.
const Broken kBroken[] = {
    {"NotXml", "<Model name=\"small\">", "<Model name=small>", "this is not XML"},
    {"UnclosedElement", "</OpenSimDocument>", "", "this is not XML"},
    {"NumberInPlaceOfAll", "<mass>0.1</mass>", "<mass></mass>", "0 numbers; give 1"},
    {"OldVersion", "Version=\"40000\"", "Version=\"30000\"",
     "small.osim:2:2: the document has version 30000; open the model in OpenSim 4 and save it again"},
    {"NoVersion", " Version=\"40000\"", "", "the document has version "},
    {"NoModel", "<Model name=\"small\">", "<Part><Model name=\"small\">", "this is not XML"},
    {"NanMass", "<mass>7.5</mass>", "<mass>nan</mass>",
     "BodySet/Body[thigh]/mass: 'nan' is not a finite number within 1e9; write a plain number"},
    {"HugeNumber", "<mass>7.5</mass>", "<mass>1e300</mass>", "'1e300' is not a finite number"},
    {"NegativeMass", "<mass>7.5</mass>", "<mass>-1</mass>", "-1 is out of range; give a number from 0"},
    {"VectorOfTwo", "<mass_center>0 -0.2 0</mass_center>", "<mass_center>0 -0.2</mass_center>", "2 numbers; give 3"},
    {"InertiaOfThree", "<inertia>0.1 0.02 0.1 0 0 0</inertia>", "<inertia>0.1 0.02 0.1</inertia>", "3 numbers; give 6"},
    {"BodyTwice", "<Body name=\"shank\">", "<Body name=\"thigh\">", "the body 'thigh' is there already"},
    {"UnknownParentFrame", "<socket_parent_frame>thigh_offset</socket_parent_frame>",
     "<socket_parent_frame>/bodyset/thihg</socket_parent_frame>",
     "there is no frame '/bodyset/thihg'; did you mean 'thigh'?"},
    {"MissingParentFrame", "<socket_parent_frame>ground_offset</socket_parent_frame>", "",
     "the joint 'hip' has no socket_parent_frame"},
    {"EmptySocket", "<socket_child_frame>thigh</socket_child_frame>", "<socket_child_frame/>", "it names no frame"},
    {"FrameOnItself", "<socket_parent>/bodyset/thigh</socket_parent>",
     "<socket_parent>/jointset/knee/thigh_offset</socket_parent>", "is fixed to itself, in a circle"},
    {"JointCircle", "<socket_parent>/ground</socket_parent>", "<socket_parent>/bodyset/shank</socket_parent>",
     "run in a circle; let the chain of parents end at the ground"},
    {"TwoJointsOnOneBody", "<socket_child_frame>/bodyset/patella</socket_child_frame>",
     "<socket_child_frame>/bodyset/shank</socket_child_frame>", "the child of two joints"},
    {"JointMovesGround", "<socket_child_frame>thigh</socket_child_frame>",
     "<socket_child_frame>/ground</socket_child_frame>", "moves the ground"},
    {"UnknownJoint", "<SliderJoint name=\"patellar\">", "<ScrewJoint name=\"patellar\">", "this is not XML"},
    {"JointTwice", "<SliderJoint name=\"patellar\">", "<SliderJoint name=\"knee\">",
     "the joint 'knee' is there already"},
    {"PinWithoutCoordinate",
     "<Coordinate name=\"hip_angle\"><default_value>0</default_value><range>-1 2</range></Coordinate>", "",
     "a PinJoint with 0 coordinates; give 1"},
    {"CoordinateTwice", "<Coordinate name=\"knee_angle\">", "<Coordinate name=\"hip_angle\">",
     "the coordinate 'hip_angle' is there already"},
    {"EmptyRange", "<range>-1 2</range>", "<range>2 -1</range>",
     "the range 2 to -1 is empty; give the smaller value first"},
    {"NeitherTrueNorFalse", "<clamped>true</clamped>", "<clamped>maybe</clamped>", "'maybe' is neither true nor false"},
    {"MissingFunction", "<LinearFunction name=\"function\"><coefficients>1 0</coefficients></LinearFunction>", "",
     "the axis depends on 'knee_angle' but has no function"},
    {"UnknownFunction", "<LinearFunction name=\"function\"><coefficients>1 0</coefficients></LinearFunction>",
     "<GCVSpline name=\"function\"/>", "the function GCVSpline is not supported"},
    {"SplineFalls", "<x>-2 -1 0 0.2</x>", "<x>-2 -1 0 -0.5</x>", "x falls or repeats at point 3 (-0.5 after 0)"},
    {"SplineUneven", "<y>0.02 0.01 0 0.001</y>", "<y>0.02 0.01 0</y>", "4 x values but 3 y values"},
    {"SplineOfOne", "<x>-2 -1 0 0.2</x><y>0.02 0.01 0 0.001</y>", "<x>1</x><y>1</y>",
     "1 point, where at least 2 are needed"},
    {"FiveAxes",
     "<TransformAxis name=\"rotation2\"><coordinates></coordinates><axis>0 1 0</axis>\n"
     "              <Constant name=\"function\"><value>0</value></Constant></TransformAxis>",
     "", "the SpatialTransform has 5 axes; give six"},
    {"AxisOfNoLength", "<axis>0 0 1</axis>", "<axis>0 0 0</axis>", "an axis of the joint 'knee' has no length"},
    {"UnknownCoordinate", "<coordinates>knee_angle</coordinates>", "<coordinates>knee_angel</coordinates>",
     "there is no coordinate 'knee_angel'; did you mean 'knee_angle'?"},
    {"CoupledToItself", "<independent_coordinate_names>knee_angle<", "<independent_coordinate_names>patella_shift<",
     "is coupled in a circle"},
    {"CouplingWithoutFunction",
     "<coupled_coordinates_function><LinearFunction><coefficients>0.05 "
     "0.04</coefficients></LinearFunction></coupled_coordinates_function>",
     "", "a coupling without a function"},
    {"MuscleTwice", "<Millard2012EquilibriumMuscle name=\"plain\">", "<Millard2012EquilibriumMuscle name=\"extensor\">",
     "the muscle 'extensor' is there already"},
    {"OnePoint",
     "<PathPoint name=\"Q1\"><socket_parent_frame>/ground</socket_parent_frame><location>0 1.1 "
     "0</location></PathPoint>",
     "", "the path has 1 point; give at least an origin and an insertion"},
    {"PointOnUnknownBody", "<socket_parent_frame>/bodyset/shank</socket_parent_frame><location>0.03 -0.08 0</location>",
     "<socket_parent_frame>/bodyset/shnak</socket_parent_frame><location>0.03 -0.08 0</location>",
     "PathPoint[P4]/socket_parent_frame: there is no frame '/bodyset/shnak'; did you mean 'shank'?"},
    {"PointWithoutFrame", "<PathPoint name=\"P1\"><socket_parent_frame>/bodyset/thigh</socket_parent_frame>",
     "<PathPoint name=\"P1\">", "a path point without socket_parent_frame"},
    {"ConditionWithoutCoordinate", "<socket_coordinate>/jointset/knee/knee_angle</socket_coordinate>", "",
     "the point has no socket_coordinate"},
    {"MovingWithoutFunction", "<LinearFunction><coefficients>0.01 0.02</coefficients></LinearFunction>", "",
     "a moving point without a function in y_location"},
    {"UnknownWrapObject", "<wrap_object>condyle</wrap_object>", "<wrap_object>condile</wrap_object>",
     "there is no wrap object 'condile'; did you mean 'condyle'?"},
    {"FibreOfNoLength", "<optimal_fiber_length>0.09</optimal_fiber_length>",
     "<optimal_fiber_length>0</optimal_fiber_length>", "0 is out of range"},
    {"PennationInDegrees", "<pennation_angle_at_optimal>0.1<", "<pennation_angle_at_optimal>15<", "15 is out of range"},
    {"MeshWithoutFile", "<mesh_file>thigh.vtp</mesh_file>", "", "a mesh without mesh_file"},
};

class BrokenModel : public testing::TestWithParam<Broken> {};

TEST_P(BrokenModel, IsRefusedWithPlaceCauseAndRemedy) {
  const std::string text = with(small_model(), GetParam().from, GetParam().to);
  ASSERT_FALSE(text.empty()) << "the piece to break is not in the small model";
  const Result<OsimModel> model = parse_osim(text, "small.osim");
  ASSERT_FALSE(model.ok());
  EXPECT_THAT(to_text(model.diagnostics()), HasSubstr(GetParam().expected));
  for (const Diagnostic& error : model.diagnostics().errors) {
    EXPECT_GT(error.line, 0) << to_string(error);
    EXPECT_FALSE(error.remedy.empty()) << to_string(error);
  }
}

INSTANTIATE_TEST_SUITE_P(OsimReader, BrokenModel, testing::ValuesIn(kBroken),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(OsimReader, RefusesWhatIsNotThere) {
  EXPECT_FALSE(read_osim("/nowhere/model.osim").ok());
  EXPECT_FALSE(parse_osim("", "empty.osim").ok());
  EXPECT_FALSE(parse_osim("hello", "hello.osim").ok());
  EXPECT_THAT(to_text(parse_osim("<Storage/>", "x.osim").diagnostics()),
              HasSubstr("x.osim:1:2: Storage: this is not an OpenSim document"));
}

TEST(OsimReader, RefusesOtherEncodings) {
  const std::string latin = with(small_model(), "Made for tests", "Fait \xe0 l'essai");
  EXPECT_THAT(to_text(parse_osim(latin, "s.osim").diagnostics()),
              HasSubstr("s.osim:5:19: byte 0xe0 is not UTF-8; save the file as UTF-8"));
  EXPECT_TRUE(parse_osim(with(small_model(), "Made for tests", "Fait \xc3\xa0 l'essai"), "s.osim").ok());
}

TEST(OsimReader, ReportsAllErrorsInOneGoWithTheirLines) {
  std::string text = with(small_model(), "<mass>7.5</mass>", "<mass>x</mass>");
  text = with(text, "<range>-1 2</range>", "<range>-1</range>");
  text = with(text, "<wrap_object>condyle</wrap_object>", "<wrap_object>rod</wrap_object>");
  const Result<OsimModel> model = parse_osim(text, "small.osim");
  ASSERT_EQ(model.diagnostics().errors.size(), 3u) << to_text(model.diagnostics());
  EXPECT_EQ(model.diagnostics().errors[0].line, 25);
  EXPECT_EQ(model.diagnostics().errors[0].column, 12);
  EXPECT_EQ(model.diagnostics().errors[1].line, 40);
}

TEST(OsimReader, RefusesJointTypesThatItDoesNotKnow) {
  std::string text = with(small_model(), "<SliderJoint name", "<ScrewJoint name");
  text = with(text, "</SliderJoint>", "</ScrewJoint>");
  EXPECT_THAT(to_text(parse_osim(text, "s").diagnostics()), HasSubstr("the joint type ScrewJoint is not supported"));
}

TEST(OsimReader, ReadsTheSmallModel) {
  const Result<OsimModel> model = parse_osim(small_model(), "small.osim");
  ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
  const Skeleton& skeleton = *model->joints.skeleton;
  EXPECT_THAT(skeleton.names, testing::ElementsAre("ground", "thigh", "patella", "shank"));
  EXPECT_THAT(skeleton.parents, testing::ElementsAre(-1, 0, 1, 1));
  EXPECT_DOUBLE_EQ(model->joints.bodies[1].mass, 7.5);
  EXPECT_DOUBLE_EQ(model->joints.bodies[1].mass_center.y, -0.2);
  ASSERT_EQ(model->geometry.size(), 1u);
  EXPECT_EQ(model->geometry[0].body, 1);
  EXPECT_DOUBLE_EQ(model->geometry[0].scale.y, 2.0);
  ASSERT_EQ(model->muscles.size(), 2u);
  const OsimMuscle& extensor = model->muscles[0];
  EXPECT_THAT(extensor.groups, testing::ElementsAre("knee_ext"));
  EXPECT_THAT(extensor.wraps, testing::ElementsAre("condyle"));
  EXPECT_DOUBLE_EQ(extensor.max_isometric_force, 1200.0);
  EXPECT_EQ(extensor.points[3].body, 3);
  const OsimMuscle& plain = model->muscles[1];
  EXPECT_DOUBLE_EQ(plain.max_isometric_force, 1000.0);  // OpenSim's default
  EXPECT_EQ(plain.points[0].body, 0);
  // The offset frame is turned by a quarter about z and moved by 0.1 along it.
  EXPECT_LT(glm::distance(plain.points[1].location, glm::dvec3(0.0, 0.1, 0.1)), 1e-15);
  EXPECT_THAT(to_text(model.diagnostics()), HasSubstr("1 PathActuator left out"));
}

TEST(OsimReader, KnowsWhatEachCoordinateMeasures) {
  const Result<OsimModel> model = parse_osim(small_model(), "small.osim");
  ASSERT_TRUE(model.ok());
  const auto& coordinates = model->joints.coordinates;
  EXPECT_EQ(coordinates[0].kind, JointCoordinate::Kind::kRotation);
  EXPECT_EQ(coordinates[1].kind, JointCoordinate::Kind::kRotation);
  EXPECT_EQ(coordinates[2].kind, JointCoordinate::Kind::kTranslation);
  EXPECT_TRUE(coordinates[1].clamped);
  EXPECT_EQ(coordinates[2].driver, 1);
}

TEST(OsimReader, MovesAndSwitchesPoints) {
  const Result<OsimModel> model = parse_osim(small_model(), "small.osim");
  ASSERT_TRUE(model.ok());
  const auto& points = model->muscles[0].points;
  std::vector<double> values = default_coordinates(model->joints);
  EXPECT_FALSE(is_active(*model, points[1], values));
  values[1] = -1.5;
  EXPECT_TRUE(is_active(*model, points[1], values));
  values[1] = -1.0 + 0.9e-5;  // OpenSim's tolerance
  EXPECT_TRUE(is_active(*model, points[1], values));
  values[1] = -1.0 + 1.1e-5;
  EXPECT_FALSE(is_active(*model, points[1], values));
  values[1] = -1.0;
  const glm::dvec3 moved = location_at(*model, points[2], values);
  EXPECT_LT(glm::distance(moved, glm::dvec3(0.03 + 0.02 / 2.2, 0.01, 0.001)), 1e-15);
}

TEST(OsimReader, FixesABodyWithoutAJointToTheGround) {
  std::string text = with(small_model(), "<SliderJoint name=\"patellar\">", "<!--");
  text = with(text, "</SliderJoint>", "-->");
  text = with(text, "<CoordinateCouplerConstraint name", "<!--");
  text = with(text, "</CoordinateCouplerConstraint>", "-->");
  const Result<OsimModel> model = parse_osim(text, "small.osim");
  ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
  EXPECT_THAT(to_text(model.diagnostics()), HasSubstr("the body 'patella' has no joint; it is fixed to the ground"));
}

TEST(OsimReader, ReadsRelativeSockets) {
  std::string text = with(small_model(), "<socket_parent>/bodyset/thigh</socket_parent>",
                          "<socket_parent>../../../bodyset/thigh</socket_parent>");
  const Result<OsimModel> model = parse_osim(text, "small.osim");
  ASSERT_TRUE(model.ok()) << to_text(model.diagnostics());
  EXPECT_EQ(model->joints.joints[2].name, "knee");
  EXPECT_DOUBLE_EQ(model->joints.joints[2].parent_translation.y, -0.4);
}

}  // namespace
}  // namespace fascicle::muscle
