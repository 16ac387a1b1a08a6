// A small OpenSim model with one of everything that matters, for tests that change a piece of it.
#pragma once

#include <string>
#include <string_view>

namespace fascicle::test {

// A thigh and a shank: a free-standing hip (pin), a knee whose translation is a spline of its angle, a coupled patella;
// a muscle with fixed, conditional and moving points and a wrap.
inline std::string small_model() {
  return R"(<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000">
  <Model name="small">
    <Ground name="ground"/>
    <credits>Made for tests. License: Creative Commons (CCBY 4.0).</credits>
    <BodySet name="bodyset">
      <objects>
        <Body name="patella">
          <mass>0.1</mass>
        </Body>
        <Body name="thigh">
          <attached_geometry>
            <Mesh name="thigh_mesh"><scale_factors>1 2 1</scale_factors><mesh_file>thigh.vtp</mesh_file></Mesh>
          </attached_geometry>
          <components>
            <PhysicalOffsetFrame name="plate">
              <socket_parent>..</socket_parent>
              <translation>0 0 0.1</translation>
              <orientation>0 0 1.5707963267948966</orientation>
            </PhysicalOffsetFrame>
          </components>
          <WrapObjectSet name="wrapobjectset">
            <objects><WrapCylinder name="condyle"><radius>0.02</radius></WrapCylinder></objects>
          </WrapObjectSet>
          <mass>7.5</mass>
          <mass_center>0 -0.2 0</mass_center>
          <inertia>0.1 0.02 0.1 0 0 0</inertia>
        </Body>
        <Body name="shank">
          <mass>3</mass>
        </Body>
      </objects>
    </BodySet>
    <JointSet name="jointset">
      <objects>
        <PinJoint name="hip">
          <socket_parent_frame>ground_offset</socket_parent_frame>
          <socket_child_frame>thigh</socket_child_frame>
          <coordinates>
            <Coordinate name="hip_angle"><default_value>0</default_value><range>-1 2</range></Coordinate>
          </coordinates>
          <frames>
            <PhysicalOffsetFrame name="ground_offset">
              <socket_parent>/ground</socket_parent>
              <translation>0 1 0</translation>
              <orientation>0 0 0</orientation>
            </PhysicalOffsetFrame>
          </frames>
        </PinJoint>
        <CustomJoint name="knee">
          <socket_parent_frame>thigh_offset</socket_parent_frame>
          <socket_child_frame>/bodyset/shank</socket_child_frame>
          <coordinates>
            <Coordinate name="knee_angle"><default_value>-0.1</default_value><range>-2 0.2</range><clamped>true</clamped></Coordinate>
          </coordinates>
          <frames>
            <PhysicalOffsetFrame name="thigh_offset">
              <socket_parent>/bodyset/thigh</socket_parent>
              <translation>0 -0.4 0</translation>
              <orientation>0 0 0</orientation>
            </PhysicalOffsetFrame>
          </frames>
          <SpatialTransform>
            <TransformAxis name="rotation1"><coordinates>knee_angle</coordinates><axis>0 0 1</axis>
              <LinearFunction name="function"><coefficients>1 0</coefficients></LinearFunction></TransformAxis>
            <TransformAxis name="rotation2"><coordinates></coordinates><axis>0 1 0</axis>
              <Constant name="function"><value>0</value></Constant></TransformAxis>
            <TransformAxis name="rotation3"><coordinates></coordinates><axis>1 0 0</axis>
              <Constant name="function"><value>0</value></Constant></TransformAxis>
            <TransformAxis name="translation1"><coordinates>knee_angle</coordinates><axis>1 0 0</axis>
              <SimmSpline name="function"><x>-2 -1 0 0.2</x><y>0.02 0.01 0 0.001</y></SimmSpline></TransformAxis>
            <TransformAxis name="translation2"><coordinates>knee_angle</coordinates><axis>0 1 0</axis>
              <MultiplierFunction name="function"><function><PiecewiseLinearFunction><x>-2 0</x><y>1 0</y></PiecewiseLinearFunction></function><scale>0.01</scale></MultiplierFunction></TransformAxis>
            <TransformAxis name="translation3"><coordinates></coordinates><axis>0 0 1</axis>
              <Constant name="function"><value>0.005</value></Constant></TransformAxis>
          </SpatialTransform>
        </CustomJoint>
        <SliderJoint name="patellar">
          <socket_parent_frame>/bodyset/thigh</socket_parent_frame>
          <socket_child_frame>/bodyset/patella</socket_child_frame>
          <coordinates>
            <Coordinate name="patella_shift"><range>-1 1</range></Coordinate>
          </coordinates>
        </SliderJoint>
      </objects>
    </JointSet>
    <ConstraintSet name="constraintset">
      <objects>
        <CoordinateCouplerConstraint name="follow">
          <isEnforced>true</isEnforced>
          <coupled_coordinates_function><LinearFunction><coefficients>0.05 0.04</coefficients></LinearFunction></coupled_coordinates_function>
          <independent_coordinate_names>knee_angle</independent_coordinate_names>
          <dependent_coordinate_name>patella_shift</dependent_coordinate_name>
          <scale_factor>2</scale_factor>
        </CoordinateCouplerConstraint>
      </objects>
    </ConstraintSet>
    <ForceSet name="forceset">
      <objects>
        <Thelen2003Muscle name="extensor">
          <GeometryPath name="geometrypath">
            <PathPointSet>
              <objects>
                <PathPoint name="P1"><socket_parent_frame>/bodyset/thigh</socket_parent_frame><location>0.03 -0.1 0</location></PathPoint>
                <ConditionalPathPoint name="P2"><socket_parent_frame>/bodyset/thigh</socket_parent_frame><location>0.04 -0.38 0</location>
                  <socket_coordinate>/jointset/knee/knee_angle</socket_coordinate><range>-2 -1</range></ConditionalPathPoint>
                <MovingPathPoint name="P3"><socket_parent_frame>/bodyset/shank</socket_parent_frame>
                  <socket_x_coordinate>/jointset/knee/knee_angle</socket_x_coordinate>
                  <socket_y_coordinate>/jointset/knee/knee_angle</socket_y_coordinate>
                  <socket_z_coordinate>/jointset/knee/knee_angle</socket_z_coordinate>
                  <x_location><SimmSpline><x>-2 0.2</x><y>0.03 0.05</y></SimmSpline></x_location>
                  <y_location><LinearFunction><coefficients>0.01 0.02</coefficients></LinearFunction></y_location>
                  <z_location><Constant><value>0.001</value></Constant></z_location></MovingPathPoint>
                <PathPoint name="P4"><socket_parent_frame>/bodyset/shank</socket_parent_frame><location>0.03 -0.08 0</location></PathPoint>
              </objects>
            </PathPointSet>
            <PathWrapSet><objects><PathWrap name="w"><wrap_object>condyle</wrap_object></PathWrap></objects></PathWrapSet>
          </GeometryPath>
          <max_isometric_force>1200</max_isometric_force>
          <optimal_fiber_length>0.09</optimal_fiber_length>
          <tendon_slack_length>0.25</tendon_slack_length>
          <pennation_angle_at_optimal>0.1</pennation_angle_at_optimal>
        </Thelen2003Muscle>
        <Millard2012EquilibriumMuscle name="plain">
          <GeometryPath name="geometrypath">
            <PathPointSet>
              <objects>
                <PathPoint name="Q1"><socket_parent_frame>/ground</socket_parent_frame><location>0 1.1 0</location></PathPoint>
                <PathPoint name="Q2"><socket_parent_frame>/bodyset/thigh/plate</socket_parent_frame><location>0.1 0 0</location></PathPoint>
              </objects>
            </PathPointSet>
          </GeometryPath>
          <optimal_fiber_length>0.09</optimal_fiber_length>
        </Millard2012EquilibriumMuscle>
        <PathActuator name="rope"/>
      </objects>
      <groups>
        <ObjectGroup name="knee_ext"><members>extensor</members></ObjectGroup>
      </groups>
    </ForceSet>
  </Model>
</OpenSimDocument>
)";
}

// The text with the first `from` replaced; empty where it does not occur, which a test then notices.
inline std::string with(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) return {};
  return text.replace(at, from.size(), to);
}

}  // namespace fascicle::test
