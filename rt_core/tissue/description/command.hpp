// What SCRIPT asks of the simulation of tissue: small types, in the order in which they came. SI.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/ports/tissue_settings.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

// Robots that are instruments of one simulation; what commands say of others has no effect.
inline constexpr std::size_t kMostInstruments = 8;

// How the active robot acts on tissue (rob_ela_interact).
struct InstrumentAction {
  InstrumentKind kind = InstrumentKind::gripper;
  InstrumentTest test = InstrumentTest::off;
  std::uint8_t joint = 0;  // index in the robot's joints
  double value_1 = 0;      // rad or m
  double value_2 = 0;

  [[nodiscard]] constexpr bool triggered(double q) const {
    switch (test) {
      case InstrumentTest::off:
        return false;
      case InstrumentTest::at_least:
        return q >= value_1;
      case InstrumentTest::below:
        return q < value_1;
      case InstrumentTest::within:
        return q >= value_1 && q <= value_2;
      case InstrumentTest::outside:
        return q < value_1 || q > value_2;
    }
    return false;
  }
};

// Virtual cylinders about the instrument's z axis that end at its tool centre point.
struct InstrumentShape {
  double shaft_radius_m = 0.0025;
  double effector_radius_m = 0.004;  // mean distance of the effector's surface from the axis
  double effector_length_m = 0.018;
  double shaft_length_m = 0.30;
};

// A clip's shape in the tool centre point T; its axis z points along the closed legs.
struct ClipDefinition {
  std::string name;
  Pose X_TC = Pose::Identity();
  double length_m = 0.009;
  double width_m = 0.003;
  SurfaceMesh shape;  // in C
};

struct SetCalculation {
  bool on = true;
};
struct ResetModel {};
struct SetAttributes {  // of one object, or of all (-1)
  int object = -1;
  std::uint16_t mask = 0;
  std::uint16_t values = 0;
};
struct SetConnections {
  std::vector<Connection> connections;
};
struct SetLimit {
  TissueLimit limit{};
  std::uint8_t actions = 0;  // bits of TissueLimitAction; 0: off
  double value = 0;          // m/s, m, N or 1
};
struct SetEffect {
  TissueEffect effect{};
  bool on = false;
  int instrument = -1;  // slot of the robot, for suction and irrigation
};
struct ResetPool {};
struct CleanLens {};
struct SetInstrumentAction {
  int instrument = 0;
  InstrumentAction action;
};  // instrument: slot of the robot
struct SetInstrumentShape {
  int instrument = 0;
  InstrumentShape shape;
};
struct SetClip {
  int instrument = 0;
  ClipDefinition clip;
};

using Command = std::variant<SetCalculation, ResetModel, SetAttributes, SetConnections, SetLimit, SetEffect, ResetPool,
                             CleanLens, SetInstrumentAction, SetInstrumentShape, SetClip>;

}  // namespace cellmirror::tissue
