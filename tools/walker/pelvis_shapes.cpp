// Pelvis with sacrum, and the stump of the lumbar spine. Landmarks (mm, OpenSim axes: x forward, y up, z right; right
// half only) follow the proportions of the generic male pelvis to which gait2392's attachment points belong.
#include <glm/glm.hpp>

#include "tools/walker/bone_shapes.hpp"

namespace fascicle::walker {
namespace {

void add_ilium(Solid& solid) {
  const Knot asis = knot_mm(-5, 6, 122, 5.5f), crest_a = knot_mm(-14, 36, 127, 4.5f);
  const Knot crest_b = knot_mm(-34, 56, 121, 4.5f), crest_c = knot_mm(-54, 79, 108, 4.5f);
  const Knot crest_d = knot_mm(-74, 90, 89, 4.5f), crest_e = knot_mm(-100, 84, 72, 5.0f);
  const Knot crest_f = knot_mm(-122, 71, 61, 5.5f), psis = knot_mm(-138, 46, 56, 6.0f);
  const Knot piis = knot_mm(-130, 12, 57, 6.0f), notch = knot_mm(-104, -4, 66, 7.0f);
  const Knot body_back = knot_mm(-82, -16, 80, 8.0f), body_front = knot_mm(-56, -20, 95, 8.0f);
  const Knot aiis = knot_mm(-34, -24, 102, 6.0f), fossa_a = knot_mm(-42, 28, 110, 3.2f);
  const Knot fossa_b = knot_mm(-68, 35, 87, 2.8f), fossa_c = knot_mm(-96, 38, 70, 4.0f);
  const Knot auricular = knot_mm(-116, 34, 58, 7.0f);
  const Knot socket_front = knot_mm(-50, -44, 87, 8.0f);
  const Knot fossa_low = knot_mm(-62, 2, 93, 4.0f);
  Sheet wing{{
      {asis, crest_a, fossa_a},         {crest_a, crest_b, fossa_a},   {crest_b, crest_c, fossa_a},
      {crest_c, fossa_b, fossa_a},      {crest_c, crest_d, fossa_b},   {crest_d, crest_e, fossa_b},
      {crest_e, fossa_c, fossa_b},      {crest_e, crest_f, fossa_c},   {crest_f, auricular, fossa_c},
      {crest_f, psis, auricular},       {psis, piis, auricular},       {piis, notch, auricular},
      {notch, fossa_c, auricular},      {notch, body_back, fossa_c},   {body_back, fossa_b, fossa_c},
      {body_back, fossa_low, fossa_b},  {fossa_low, fossa_a, fossa_b}, {body_back, body_front, fossa_low},
      {body_front, fossa_a, fossa_low}, {body_front, aiis, fossa_a},   {aiis, asis, fossa_a},
      {body_front, aiis, socket_front},
  }};
  solid.add(wing);
  solid.add_tube({asis, crest_a, crest_b, crest_c, crest_d, crest_e, crest_f, psis});  // the crest's lip
}

void add_hip_bone(Solid& solid) {
  // Columns from the wing to the socket.
  solid.add_tube({knot_mm(-104, -6, 67, 8), knot_mm(-99, -36, 68, 11), knot_mm(-102, -66, 68, 12)});
  solid.add_tube({knot_mm(-60, -20, 90, 9), knot_mm(-62, -42, 78, 12), knot_mm(-54, -58, 66, 10)});
  solid.add_tube({knot_mm(-82, -18, 79, 10), knot_mm(-78, -44, 68, 13)});
  solid.add(RoundCone{knot_mm(-34, -24, 101, 6), knot_mm(-45, -42, 90, 8)});
  // The socket's bowl holds the femoral head and opens outwards, forwards and down.
  const glm::vec3 hip = from_opensim_mm(-70.7f, -66.1f, 83.5f);
  const glm::vec3 opening = glm::normalize(from_opensim({0.30f, -0.42f, 0.86f}));
  solid.add(Ellipsoid{hip, glm::vec3(0.0305f)});
  solid.remove(Ellipsoid{hip + 0.031f * opening, glm::vec3(0.036f)});
  solid.remove(Ellipsoid{hip, glm::vec3(0.0245f)});
  // Pubis: upper branch, symphysis, lower branch; ischium with its tuberosity and spine.
  solid.add_tube(
      {knot_mm(-52, -58, 63, 10), knot_mm(-43, -67, 46, 8), knot_mm(-35, -76, 26, 7), knot_mm(-42, -78, 6, 8)});
  solid.add_tube({knot_mm(-42, -78, 5, 8), knot_mm(-54, -96, 5, 7)});
  solid.add_tube({knot_mm(-54, -96, 6, 7), knot_mm(-66, -109, 17, 6.2f), knot_mm(-85, -117, 30, 6.5f),
                  knot_mm(-104, -111, 43, 8.5f), knot_mm(-116, -100, 58.5f, 11.8f)});
  solid.add_tube({knot_mm(-101, -64, 69, 12), knot_mm(-115, -82, 62, 11.5f), knot_mm(-117, -99, 59.5f, 12)});
  solid.add_tube({knot_mm(-104, -60, 62, 9), knot_mm(-124, -54, 53, 3.5f)});
}

void add_sacrum(Solid& solid) {
  const Knot wing_top = knot_mm(-114, 56, 39, 11), wing_low = knot_mm(-124, 24, 39, 10);
  const Knot middle_top = knot_mm(-108, 52, 0, 17), s2 = knot_mm(-124, 30, 0, 16);
  const Knot s3 = knot_mm(-142, 8, 0, 12), s3_side = knot_mm(-141, 6, 19, 8);
  const Knot s4 = knot_mm(-156, -13, 0, 9), s4_side = knot_mm(-156, -14, 10, 6.5f);
  solid.add(Sheet{{{middle_top, wing_top, s2},
                   {wing_top, wing_low, s2},
                   {s2, wing_low, s3},
                   {wing_low, s3_side, s3},
                   {s3, s3_side, s4},
                   {s3_side, s4_side, s4}}});
  solid.add_tube({s4, knot_mm(-164, -28, 0, 6.5f), knot_mm(-163, -41, 0, 4)});  // coccyx
  solid.add_tube(
      {knot_mm(-134, 60, 0, 4.5f), knot_mm(-150, 38, 0, 4.5f), knot_mm(-163, 12, 0, 4), knot_mm(-168, -8, 0, 3.5f)});
  for (const glm::vec3& foramen : {glm::vec3(-117, 40, 19), glm::vec3(-131, 18, 15), glm::vec3(-147, -3, 11)}) {
    const glm::vec3 through(15.0f, -11.0f, 0.0f);
    const glm::vec3 front = foramen + through, back = foramen - through;
    solid.remove(RoundCone{knot_mm(front.x, front.y, front.z, 3.8f), knot_mm(back.x, back.y, back.z, 2.6f)});
  }
  solid.add(Ellipsoid{from_opensim_mm(-104, 62, 0), glm::vec3(0.026f, 0.007f, 0.018f)});  // promontory
}

// One lumbar vertebra about the middle of its body.
void add_vertebra(Solid& solid, float x, float y) {
  solid.add(Ellipsoid{from_opensim_mm(x, y + 9, 0), 0.001f * glm::vec3(26, 6.5f, 18.5f)});
  solid.add(Ellipsoid{from_opensim_mm(x, y - 9, 0), 0.001f * glm::vec3(26, 6.5f, 18.5f)});
  solid.add(Ellipsoid{from_opensim_mm(x, y, 0), 0.001f * glm::vec3(23, 14, 16)});
  solid.add_tube({knot_mm(x - 15, y + 4, 13, 6), knot_mm(x - 30, y + 2, 14, 5.5f), knot_mm(x - 42, y - 2, 0, 5)});
  solid.add_tube({knot_mm(x - 26, y + 4, 14, 5), knot_mm(x - 30, y + 5, 42, 3.5f)});  // transverse process
  solid.add_tube({knot_mm(x - 40, y - 2, 0, 5), knot_mm(x - 58, y - 9, 0, 4), knot_mm(x - 66, y - 13, 0, 5)});  // spine
  solid.add_tube({knot_mm(x - 30, y + 4, 16, 5.5f), knot_mm(x - 33, y + 20, 15, 4)});  // facets
  solid.add_tube({knot_mm(x - 32, y, 15, 5.5f), knot_mm(x - 34, y - 16, 14, 4)});
}

}  // namespace

BoneShape make_pelvis() {
  BoneShape shape;
  shape.bone = find_bone("pelvis");
  shape.solid = Solid(0.006f);
  shape.symmetric = true;
  shape.voxel = 0.0034f;
  add_ilium(shape.solid);
  add_hip_bone(shape.solid);
  add_sacrum(shape.solid);
  return shape;
}

// Landmarks in the torso's frame, which stands at (-100.7, 81.5, 0) of the pelvis.
BoneShape make_torso() {
  BoneShape shape;
  shape.bone = find_bone("torso");
  shape.solid = Solid(0.004f);
  shape.symmetric = true;
  shape.voxel = 0.0032f;
  add_vertebra(shape.solid, 9.0f, 3.0f);                                                     // L5
  add_vertebra(shape.solid, 18.0f, 37.0f);                                                   // L4
  add_vertebra(shape.solid, 23.0f, 72.0f);                                                   // L3
  shape.solid.add(Ellipsoid{from_opensim_mm(13.5f, 20, 0), 0.001f * glm::vec3(24, 5, 17)});  // discs
  shape.solid.add(Ellipsoid{from_opensim_mm(20.5f, 54.5f, 0), 0.001f * glm::vec3(24, 5, 17)});
  return shape;
}

}  // namespace fascicle::walker
