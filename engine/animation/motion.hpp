// A recorded motion: the coordinates of a joint model over time, as inverse kinematics or a simulation gives them.
// Immutable and shared. `read_motion` (motion_reader.hpp) makes one from an OpenSim .mot or .sto file.
//
// A looped motion plays one cycle of the record: the stretch of at least 0.6 s whose ends are most alike in angles and
// angular velocities. What difference remains between its ends is spread evenly over the cycle, so that nothing jumps.
// Where the root travels over the ground, the travel goes on from cycle to cycle; played in place, it is taken out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fascicle {

struct JointModel;

struct MotionCycle {
  double start = 0.0;  // s, on the record's own time axis
  double end = 0.0;    // s; equal to start where the record is a single pose
  double length() const { return end - start; }
};

struct Motion {
  std::string name;
  std::size_t coordinates = 0;   // of the model that it was read for
  std::vector<double> times;     // s, strictly rising, at least one
  std::vector<double> values;    // times x coordinates (rad, m); a coordinate that the file lacks has its default
  std::vector<double> slopes;    // their time derivatives (a unit/s), of the parabola through each three neighbours
  MotionCycle cycle;
  std::vector<double> cycle_mean;      // by coordinate, over the cycle
  std::vector<double> cycle_change;    // by coordinate, from the cycle's start to its end
  std::vector<std::uint8_t> horizontal;  // by coordinate: 1 where it moves the root level over the ground

  double duration() const { return times.back() - times.front(); }
};

// Fills in slopes, cycle and what follows from it.
void finish_motion(Motion& motion, const JointModel& model);

// Lets a finished motion repeat all of its record, every value as recorded: where its ends differ it jumps.
void loop_whole_record(Motion& motion);

// The record at `time` (s, on its own axis; held at its ends): a cubic Hermite curve with continuous velocity.
void sample_motion(const Motion& motion, double time, std::span<double> values);

// The looped motion at `time` s since the cycle's start, any sign. Travel is a level movement of the root of more than
// 0.1 m/s on average; `in_place` takes it out and centres the root's level position over the cycle on 0.
void sample_cycle(const Motion& motion, double time, bool in_place, std::span<double> values);

}  // namespace fascicle
