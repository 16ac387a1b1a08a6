// Femur, tibia with fibula, patella, talus, foot and toes. Landmarks in mm, OpenSim axes (x forward, y up, z right), in
// the bone's frame, right side: centres and radii of the shafts at stations, and the places of what sticks out.
#include <glm/glm.hpp>

#include "tools/walker/bone_shapes.hpp"

namespace fascicle::walker {
namespace {

void add_femur_top(Solid& solid) {
  solid.add(Ellipsoid{glm::vec3(0.0f), glm::vec3(0.0222f)});
  solid.add_tube({knot_mm(-1, -3, 8, 16), knot_mm(-7, -11, 24, 13.5f), knot_mm(-12, -20, 38, 15)});
  solid.add_tube({knot_mm(-18, -10, 47, 9), knot_mm(-19, -17, 49, 11.5f), knot_mm(-15, -34, 47, 12)});
  solid.add_tube({knot_mm(-26, -7, 44, 6), knot_mm(-30, -18, 42, 6.5f), knot_mm(-30, -38, 34, 6.5f),
                  knot_mm(-22, -55, 18, 8)});                                // intertrochanteric crest
  solid.add_tube({knot_mm(-20, -57, 15, 8.5f), knot_mm(-10, -66, 26, 12)});  // lesser trochanter
  solid.add_tube({knot_mm(-12, -20, 38, 16), knot_mm(-11, -48, 38, 15)});
  solid.add_tube({knot_mm(-22, -58, 45, 5.5f), knot_mm(-12, -101, 40, 5), knot_mm(-3, -140, 37, 4.5f)});  // gluteal
}

void add_femur_shaft(Solid& solid) {
  solid.add_tube({knot_mm(-10, -56, 37, 14.5f), knot_mm(-7, -73, 36.5f, 13.5f), knot_mm(-2, -91, 36.5f, 12.8f),
                  knot_mm(6, -126, 33.6f, 12.4f), knot_mm(13.3f, -160, 30.3f, 12), knot_mm(18.2f, -195, 27.3f, 11.5f),
                  knot_mm(21.2f, -230, 23.6f, 11.3f), knot_mm(23, -265, 19.4f, 11.4f), knot_mm(22.5f, -300, 15, 11.8f),
                  knot_mm(21.5f, -335, 10.8f, 12.4f), knot_mm(19.5f, -360, 7, 13)});
  solid.add_tube({knot_mm(-1, -150, 30, 3.5f), knot_mm(6.5f, -195, 25.5f, 3.5f), knot_mm(9.5f, -230, 22, 3.5f),
                  knot_mm(11.5f, -265, 18.5f, 3)});  // linea aspera
}

void add_femur_condyles(Solid& solid) {
  solid.add_tube({knot_mm(19, -352, 7, 13), knot_mm(16, -372, -4, 13), knot_mm(11, -392, -16, 14)});
  solid.add_tube({knot_mm(19, -352, 9, 12.5f), knot_mm(17, -372, 14, 12), knot_mm(11, -392, 20, 13)});
  solid.add(Ellipsoid{from_opensim_mm(4, -403, -21), 0.001f * glm::vec3(14.5f, 25.5f, 26)});
  solid.add(Ellipsoid{from_opensim_mm(6, -401, 20.5f), 0.001f * glm::vec3(14, 24, 27.5f)});
  solid.add_tube({knot_mm(23, -395, -14, 10), knot_mm(19.5f, -397, 2, 9.5f), knot_mm(25, -395, 16, 10)});  // groove
  solid.add_tube({knot_mm(4, -390, -24, 10), knot_mm(2, -388, -34, 5)});  // epicondyles
  solid.add_tube({knot_mm(4, -390, 24, 10), knot_mm(2, -391, 32, 5)});
  solid.add_tube({knot_mm(8, -384, -33, 4), knot_mm(8, -374, -27, 4)});              // adductor tubercle
  solid.remove(RoundCone{knot_mm(-26, -410, 0, 8.5f), knot_mm(-4, -420, 0, 7.5f)});  // intercondylar notch
}

void add_tibia(Solid& solid) {
  solid.add(Ellipsoid{from_opensim_mm(1, -42, -13), 0.001f * glm::vec3(16.5f, 12.5f, 25)});
  solid.add(Ellipsoid{from_opensim_mm(0, -42, 17.5f), 0.001f * glm::vec3(14.5f, 12.5f, 25)});
  solid.add(Ellipsoid{from_opensim_mm(8, -46, 3), 0.001f * glm::vec3(26, 14, 22)});
  solid.add_tube({knot_mm(-3, -33, -4, 5), knot_mm(-3, -29, -3, 2.5f)});  // intercondylar eminence
  solid.add_tube({knot_mm(-3, -33, 6, 5), knot_mm(-3, -29.5f, 5, 2.5f)});
  solid.add_tube({knot_mm(3, -54, 2, 23), knot_mm(6, -78, 2, 18.5f), knot_mm(9, -104, 3, 16.5f),
                  knot_mm(10, -147, 2, 14), knot_mm(8.5f, -180, 2, 12.5f), knot_mm(7.5f, -211, 2.5f, 11.8f),
                  knot_mm(7, -254, 3.5f, 11), knot_mm(6.3f, -297, 3.7f, 11.2f), knot_mm(5.5f, -340, 4, 13.5f),
                  knot_mm(5.2f, -364, 4, 15.5f), knot_mm(5, -386, 2, 18), knot_mm(3.5f, -399, -1, 19)});
  solid.add_tube({knot_mm(26, -64, 4, 9), knot_mm(29, -80, 5, 9), knot_mm(30, -104, 3.5f, 6.5f),
                  knot_mm(24, -147, 2, 5.5f), knot_mm(18.5f, -211, 1.5f, 4.5f),
                  knot_mm(15, -280, 2, 4)});  // tuberosity and anterior crest
  solid.add_tube({knot_mm(2, -72, -11, 9), knot_mm(12, -86, -13, 9), knot_mm(20, -92, -11, 9)});  // pes anserinus
  solid.add_tube(
      {knot_mm(3, -398, -15, 10), knot_mm(2, -412, -20, 7.5f), knot_mm(1, -419, -20.5f, 5.5f)});  // malleolus
  solid.remove(RoundCone{knot_mm(1, -436, -12.5f, 21.5f), knot_mm(1, -436, 40, 21.5f)});  // where the talus rides
}

void add_fibula(Solid& solid) {
  const Knot stations[] = {
      knot_mm(-11, -65, 35, 8.5f),       knot_mm(-8, -75, 35, 10.3f),       knot_mm(-5, -104, 33.6f, 8),
      knot_mm(-3, -135, 30.5f, 6.8f),    knot_mm(-2.2f, -166, 28.8f, 6.4f), knot_mm(-2, -228, 27.4f, 6.3f),
      knot_mm(-2.6f, -291, 28.2f, 6.3f), knot_mm(-4.4f, -354, 30, 6.5f),    knot_mm(-5, -385, 31.5f, 7.5f),
      knot_mm(-6, -412, 32.5f, 9),       knot_mm(-7, -427, 31, 6)};
  solid.keep(Tube{{std::begin(stations), std::end(stations)}});
  solid.keep(RoundCone{knot_mm(-12, -63, 35, 5), knot_mm(-14, -58, 35, 3.5f)});  // styloid process
}

struct Ray {
  Knot base, middle, head;
};

}  // namespace

BoneShape make_femur() {
  BoneShape shape;
  shape.bone = find_bone("femur_r");
  shape.solid = Solid(0.007f);
  add_femur_top(shape.solid);
  add_femur_shaft(shape.solid);
  add_femur_condyles(shape.solid);
  return shape;
}

BoneShape make_tibia() {
  BoneShape shape;
  shape.bone = find_bone("tibia_r");
  shape.solid = Solid(0.006f);
  add_tibia(shape.solid);
  add_fibula(shape.solid);
  return shape;
}

// Its frame stands at the upper pole, where rectus femoris inserts.
BoneShape make_patella() {
  BoneShape shape;
  shape.bone = find_bone("patella_r");
  shape.solid = Solid(0.006f);
  shape.voxel = 0.0018f;
  shape.solid.add(Ellipsoid{from_opensim_mm(-9, -14, 0), 0.001f * glm::vec3(20, 17, 9)});
  shape.solid.add_tube({knot_mm(-8, -22, 0, 9), knot_mm(-11, -33, 0, 5.5f)});
  shape.solid.add_tube({knot_mm(-8, -4, -7, 6), knot_mm(-8, -4, 7, 6)});
  shape.solid.add_tube({knot_mm(-13, -14, -10, 6), knot_mm(-15, -14, 0, 6), knot_mm(-13, -14, 10, 6)});
  return shape;
}

BoneShape make_talus() {
  BoneShape shape;
  shape.bone = find_bone("talus_r");
  shape.solid = Solid(0.005f);
  shape.voxel = 0.0018f;
  shape.solid.add_tube({knot_mm(0, -3, -10, 13.5f), knot_mm(0, -3, 8, 13.5f)});  // trochlea
  shape.solid.add_tube({knot_mm(8, -3, -3, 11), knot_mm(22, -5, -6, 9.5f)});     // neck and head
  shape.solid.add_tube({knot_mm(-6, -6, 0, 10), knot_mm(-14, -8, 2, 7)});
  return shape;
}

BoneShape make_foot() {
  BoneShape shape;
  shape.bone = find_bone("foot_r");
  shape.solid = Solid(0.0035f);
  shape.voxel = 0.0027f;
  Solid& solid = shape.solid;
  solid.add_tube({knot_mm(4, 13, -4, 14), knot_mm(18, 17, -5, 15), knot_mm(34, 19, -1, 13), knot_mm(54, 18, 8, 11)});
  solid.add_tube({knot_mm(3, 20, -5, 10), knot_mm(26, 23, -6, 9), knot_mm(42, 24, 1, 9)});
  solid.add_tube({knot_mm(8, -1, -10, 8), knot_mm(12, -2, 4, 6.5f)});                                // tuber's two feet
  solid.add_tube({knot_mm(34, 22, -10, 8), knot_mm(42, 25, -19, 6)});                                // sustentaculum
  solid.add_tube({knot_mm(58, 17, 12, 10.5f), knot_mm(74, 17, 20, 10)});                             // cuboid
  solid.add_tube({knot_mm(74, 32, -6, 9), knot_mm(74, 29, -18, 9.5f), knot_mm(73, 22, -26, 6.5f)});  // navicular
  solid.add_tube({knot_mm(84, 27, -21, 9.5f), knot_mm(98, 22, -24, 9)});                             // cuneiforms
  solid.add_tube({knot_mm(84, 31, -9, 8), knot_mm(97, 29, -11, 7.5f)});
  solid.add_tube({knot_mm(82, 29, 2, 7.5f), knot_mm(96, 27, 1, 7)});
  const Ray rays[] = {
      {knot_mm(104, 21, -24, 9), knot_mm(138, 11, -28, 6.3f), knot_mm(166, 3, -28, 9)},
      {knot_mm(102, 28, -11.5f, 6.8f), knot_mm(138, 17, -12, 4.3f), knot_mm(171, 3, -11, 5.8f)},
      {knot_mm(100, 26, 1, 6.5f), knot_mm(136, 15, 3, 4.0f), knot_mm(168, 2, 5, 5.5f)},
      {knot_mm(90, 22, 13, 7), knot_mm(130, 12, 17, 4.0f), knot_mm(160, 1, 21, 5.5f)},
      {knot_mm(82, 15, 26, 7.5f), knot_mm(118, 8, 31, 4.3f), knot_mm(148, 0, 35, 6)},
  };
  for (const Ray& ray : rays) solid.add_tube({ray.base, ray.middle, ray.head});
  solid.add_tube({knot_mm(80, 13, 28, 6.5f), knot_mm(70, 10, 36, 5)});  // styloid of the fifth
  return shape;
}

BoneShape make_toes() {
  BoneShape shape;
  shape.bone = find_bone("toes_r");
  shape.solid = Solid(0.003f);
  shape.voxel = 0.0024f;
  Solid& solid = shape.solid;
  solid.add_tube({knot_mm(-3, 3, -28, 7.5f), knot_mm(10, 0, -27, 6), knot_mm(24, -2, -25, 7)});
  solid.add_tube({knot_mm(30, -2, -25, 6.5f), knot_mm(46, -3, -22, 5), knot_mm(58, -5, -20, 4)});
  const Ray rays[] = {
      {knot_mm(3, 2, -11, 5.5f), knot_mm(24, 0, -8, 3.8f), knot_mm(46, -4, -3, 3.6f)},
      {knot_mm(0, 1, 5, 5.2f), knot_mm(20, -1, 9, 3.7f), knot_mm(40, -4.5f, 13, 3.5f)},
      {knot_mm(-8, 0, 21, 5), knot_mm(11, -2, 26, 3.6f), knot_mm(29, -5, 30, 3.4f)},
      {knot_mm(-20, -1, 35, 5), knot_mm(-3, -3, 41, 3.6f), knot_mm(12, -5.5f, 45, 3.4f)},
  };
  for (const Ray& ray : rays) {
    solid.add_tube({ray.base, ray.middle, ray.head});
    solid.add(Ellipsoid{0.5f * (ray.middle.position + ray.head.position), glm::vec3(0.0046f)});
  }
  return shape;
}

}  // namespace fascicle::walker
