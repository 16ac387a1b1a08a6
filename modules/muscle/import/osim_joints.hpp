// The joints of an OpenSim model.
#pragma once

#include "engine/animation/joint_model.hpp"
#include "modules/muscle/import/osim_frames.hpp"
#include "modules/muscle/import/xml_fields.hpp"

namespace fascicle::muscle {

// Reads coordinates, joints, couplings and the bodies' masses into `joints`, and finishes it. Appends what is wrong.
// A body without a joint is fixed to the ground, with a warning.
void read_osim_joints(XmlFields& fields, pugi::xml_node model, OsimFrames& frames, JointModel& joints);

// The coordinate that a socket or a list names, by its name or its path; -1 with an error where there is none.
std::int32_t find_osim_coordinate(XmlFields& fields, pugi::xml_node at, const std::string& text,
                                  const JointModel& joints);

}  // namespace fascicle::muscle
