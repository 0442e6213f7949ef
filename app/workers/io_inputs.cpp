#include "app/workers/io_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace cellmirror::app {

namespace {

struct InputState {
  const CellState& cell_state;
  const engine::TickState& tick;
  const RangeReadings* ranges;

  bool operator()(const BarrierInput& input) const {
    if (ranges == nullptr) return true;
    const auto found = std::ranges::find(ranges->barriers, input.barrier, &BarrierReading::name);
    return found == ranges->barriers.end() || found->interrupted;
  }
  bool operator()(const JointInput& input) const {
    const auto robot = std::ranges::find(cell_state.robots, input.robot, &RobotSnapshot::id);
    if (robot == cell_state.robots.end() || robot->slot >= tick.robots.size()) return false;
    const engine::RobotTickState& state = tick.robots[robot->slot];
    if (input.joint >= state.joint_count) return false;
    const double position = state.joints.at(input.joint).position;
    return input.above ? position > input.position : position < input.position;
  }
};

std::int16_t analogue_of(const AnalogueInputConfig& input, const RangeReadings* ranges) {
  constexpr double kFull = std::numeric_limits<std::int16_t>::max();
  if (ranges == nullptr) return static_cast<std::int16_t>(kFull);
  const auto found = std::ranges::find(ranges->readings, input.sensor, &RangeReading::id);
  if (found == ranges->readings.end() || !found->distance_m) return static_cast<std::int16_t>(kFull);
  return static_cast<std::int16_t>(std::lround(kFull * std::clamp(*found->distance_m / input.full_scale, 0.0, 1.0)));
}

}  // namespace

IoInputs io_inputs(const IoNodeConfig& node, const CellState& cell_state, const engine::TickState& tick,
                   const RangeReadings* ranges) {
  IoInputs inputs;
  for (const DigitalInputConfig& input : node.inputs) {
    const bool on = std::visit(InputState{cell_state, tick, ranges}, input.source) != input.inverted;
    if (on) inputs.digital |= std::uint32_t{1} << input.bit;
  }
  for (const AnalogueInputConfig& input : node.analogues)
    inputs.analogue.at(input.channel) = analogue_of(input, ranges);
  return inputs;
}

}  // namespace cellmirror::app
