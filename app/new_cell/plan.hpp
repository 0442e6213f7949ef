// What a new cell will consist of: found out before anything is written. Plain data; SI.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rt_core/ports/robot_state.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror::app {

struct PlannedFile {
  std::filesystem::path from;  // copied; empty: `text` is written
  std::string to;              // relative to the cell folder
  std::string text;
};

struct PlannedJoint {
  std::string name;
  JointKind kind = JointKind::revolute;
  double min_position = 0;  // rad or m
  double max_position = 0;
  double start_position = 0;
  double max_velocity = 0;  // rad/s or m/s
};

// A CiA 402 drive of a joint.
struct PlannedDrive {
  std::uint8_t node = 0;
  std::size_t joint = 0;
  std::string eds = {};           // file in robots/
  double increments = 0;          // of 0x6064 for a rad or a metre
  bool increments_known = false;  // by the EDS; else they are a placeholder
  // A TPDO of the EDS holds 0x6064; else the driver's default mapping is written into the cell file.
  bool position_mapped = false;
  bool default_mapping = false;  // the position is where simulated drives send it, too
};

struct PlannedSignal {
  std::string message;
  std::string signal;
  std::size_t joint = 0;
  JointQuantity quantity = JointQuantity::position;
  double scale = 1;
  std::string unit = {};  // as the DBC says it
  bool multiplexed = false;
};

struct PlannedRobot {
  std::string node;  // name of its node in the cell
  std::string id;
  std::string file;  // its ABSTRACT file, as the cell file names it
  std::string base;  // link; empty: the root
  Eigen::Vector3d xyz_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy_rad = Eigen::Vector3d::Zero();
  std::vector<PlannedJoint> joints;
  // Where its joint values come from: one of these.
  std::string topic;  // ROS 2's name
  std::vector<PlannedDrive> drives;
  std::string dbc;  // file in robots/
  std::vector<PlannedSignal> signals;
  std::vector<std::string> other_signals = {};  // of the DBC, "MESSAGE.SIGNAL [unit]", where none was guessed
  bool made_up = false;                         // its component is a guess, too
};

struct CellPlan {
  std::string name;
  std::string channel;
  std::vector<PlannedRobot> robots;
  std::vector<PlannedFile> files;
  std::vector<std::string> guesses;  // sentences for the person: what was decided in his place
};

}  // namespace cellmirror::app
