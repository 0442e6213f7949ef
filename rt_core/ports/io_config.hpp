// What a cell file says about the I/O nodes that the gateway answers for, and about light barriers. Plain data, SI;
// config/ fills it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/ports/io_image.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

// On while the beam of the barrier is interrupted.
struct BarrierInput {
  std::string barrier;
};
// On while the joint is beyond a position.
struct JointInput {
  std::string robot;
  std::size_t joint = 0;  // the joint's number in the robot
  double position = 0;    // rad or m
  bool above = true;      // else below
};

struct DigitalInputConfig {
  std::size_t bit = 0;
  std::variant<BarrierInput, JointInput> source;
  bool inverted = false;
};

// The distance of an ultrasonic sensor: 32767 at `full_scale` and beyond, and without an echo.
struct AnalogueInputConfig {
  std::size_t channel = 0;  // from 0
  std::string sensor;       // name, as SET_USSPAR takes it
  double full_scale = 1;    // m
};

// Moves one joint of a simulated robot to one of two positions.
struct JointOutput {
  std::string robot;
  std::size_t joint = 0;
  double on = 0;  // rad or m
  double off = 0;
};
// SCRIPT commands, e.g. CONNECT and DISCONNECT; empty: nothing is done.
struct CommandOutput {
  std::string on;
  std::string off;
};

struct DigitalOutputConfig {
  std::size_t bit = 0;
  std::variant<JointOutput, CommandOutput> target;
};

struct IoNodeConfig {
  CanChannelConfig channel;
  std::uint8_t node_id = 0;        // 1..127
  bool waits_for_lss = false;      // has no number until a master gives it one; node_id is its serial number
  std::uint16_t heartbeat_ms = 0;  // object 0x1017 at power-on
  Nanoseconds period{1'000'000};   // of looking at the inputs
  std::vector<DigitalInputConfig> inputs;
  std::vector<AnalogueInputConfig> analogues;
  std::vector<DigitalOutputConfig> outputs;
  Place place = {};  // of the table
};

}  // namespace cellmirror
