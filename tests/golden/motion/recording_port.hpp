// Robots that write down what they are told, and stand at once where they were commanded to; or, held, that have only
// begun. Everything else of the fleet is asked of the real one.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/owner/fleet.hpp"
#include "app/owner/motion/motion_port.hpp"
#include "rt_core/motion/move_text.hpp"

namespace cellmirror::testing {

class RecordingPort final : public app::MotionPort {
 public:
  RecordingPort(app::Fleet& fleet, const Cell& cell) : fleet_(fleet), cell_(cell), positions_(cell.start_positions()) {}

  std::string trace;
  bool held = false;

  Result<void> check_simulated(std::string_view robot) const override { return fleet_.check_simulated(robot); }
  [[nodiscard]] motion::MotionState motion(std::string_view robot) override { return states_[std::string(robot)]; }
  [[nodiscard]] std::span<const JointValues> positions() override { return positions_; }

  Result<void> jump(std::string_view robot, const JointValues& joints) override {
    trace += fmt::format("{}: jump", robot);
    for (std::size_t i = 0; i < cell_.robot(robot)->joint_count(); ++i)
      trace += fmt::format(" {:.6f}", rounded(joints[i]));
    trace += "\n";
    positions_[cell_.robot(robot)->slot()] = joints;
    return {};
  }
  Result<void> set_chain(std::string_view /*robot*/, std::shared_ptr<const kinematics::Chain> /*chain*/) override {
    return {};
  }
  Result<void> add_move(std::string_view robot, const motion::Move& given) override {
    motion::Move move = given;
    for (double& joint : move.target) joint = rounded(joint);
    trace += fmt::format("{}: {}\n", robot, motion::move_text(move, cell_.robot(robot)->joint_count()));
    if (held) return {};
    motion::MotionState& state = states_[std::string(robot)];
    state.finished_from = state.finished = move.id;
    state.outcome = motion::Outcome::arrived;
    if (move.kind == motion::MoveKind::joints) positions_[cell_.robot(robot)->slot()] = move.target;
    return {};
  }
  Result<void> stop_motion(std::string_view robot) override {
    trace += fmt::format("{}: stop\n", robot);
    return {};
  }
  Result<void> set_pace(std::string_view robot, double pace) override {
    trace += fmt::format("{}: pace {:.6f}\n", robot, pace);
    return {};
  }
  Result<void> hold_behind(std::string_view robot, std::uint32_t move) override {
    trace += fmt::format("{}: hold behind {}\n", robot, move);
    return {};
  }

 private:
  // Inverse kinematics promises 1e-5.
  static double rounded(double value) { return std::round(value * 1e3) / 1e3 + 0.0; }

  app::Fleet& fleet_;
  const Cell& cell_;
  std::vector<JointValues> positions_;
  std::map<std::string, motion::MotionState> states_;
};

}  // namespace cellmirror::testing
