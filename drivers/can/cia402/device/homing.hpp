// Homing (CiA 402-2, 9): the search for a switch's edge, and for the index pulse of the encoder. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/can/cia402/device/motion_plan.hpp"
#include "rt_core/ports/device_config.hpp"

namespace cellmirror::can {

enum class HomingSwitch : std::uint8_t { none, negative_limit, positive_limit, home };

// A method as a search: the edge of a switch, crossed in a direction, then perhaps the next index pulse that way.
// Directions are those of increasing (1) and decreasing (-1) increments.
struct HomingMethod {
  HomingSwitch search = HomingSwitch::none;
  int first = 0;    // direction in which the switch is looked for
  int edge = 0;     // which end of the switch's active range
  int through = 0;  // the direction in which that edge is crossed, and in which the index is looked for
  bool index = false;
};

// Methods 1 to 14, 17 to 30, 33, 34, 35 and 37.
[[nodiscard]] std::optional<HomingMethod> homing_method(int number);

// What homing sees of the axis, in increments of the encoder that no homing has shifted.
struct HomingInputs {
  double position = 0;
  std::optional<JointInterval> limit_switches;  // active below the lower and above the upper
  std::optional<JointInterval> home_switch;     // active within
  double index_distance = 1;                    // between two index pulses; one is at 0
};

[[nodiscard]] bool is_active(HomingSwitch which, const HomingInputs& inputs);

class Homing {
 public:
  enum class State : std::uint8_t { idle, searching, attained, failed };

  // Speeds are positive. The method is one that homing_method() knows.
  void start(const HomingMethod& method, const MotionPoint& at, const HomingInputs& inputs, double fast, double slow,
             double acceleration);
  // Nothing is searched any more; the axis, which is at `at`, stops.
  void enter(const MotionPoint& at, double acceleration);

  // One step: where the axis shall be.
  [[nodiscard]] MotionPoint step(double dt, const HomingInputs& inputs);
  // The positions are renumbered: the one that is demanded now becomes `position`.
  void shift(double position);
  [[nodiscard]] State state() const { return state_; }
  // The axis stands after attained or failed.
  [[nodiscard]] bool is_over() const { return time_ >= plan_.duration(); }
  // Attained: where home is [increments]. It is latched where the edge or the pulse is, not where the step ended.
  [[nodiscard]] double home() const { return home_; }

 private:
  enum class Phase : std::uint8_t { find_switch, leave_switch, cross_edge, find_index };

  void run(int direction, double speed);
  void look(const HomingInputs& inputs);
  void look_for_switch(const HomingInputs& inputs);
  void at_edge(const HomingInputs& inputs);
  void finish(State state);
  [[nodiscard]] double edge_position(const HomingInputs& inputs) const;

  HomingMethod method_;
  double fast_ = 1;
  double slow_ = 1;
  double acceleration_ = 1;
  State state_ = State::idle;
  Phase phase_ = Phase::find_switch;
  int direction_ = 0;
  int turns_ = 0;  // at limit switches
  double next_index_ = 0;
  double home_ = 0;
  MotionPlan plan_;
  double time_ = 0;  // of the plan
  MotionPoint at_;
};

}  // namespace cellmirror::can
