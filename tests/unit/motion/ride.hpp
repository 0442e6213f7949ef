// A robot on the executor: what the engine does, without it; every tick is checked.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <span>

#include "rt_core/base/time.hpp"
#include "rt_core/kinematics/forward.hpp"
#include "rt_core/motion/executor.hpp"
#include "rt_core/motion/planner.hpp"

namespace cellmirror::motion {

class Ride {
 public:
  static constexpr double kTick = 1e-3;

  Ride(kinematics::Chain chain, const JointValues& q) : chain_(std::move(chain)), q_(q) {
    sut_->reset(joints());
    sut_->set_chain(&chain_);
    RobotParameters& p = parameters;
    p.max_velocity.fill(2.0);
    p.active_velocity.fill(1.0);
    p.max_acceleration.fill(8.0);
    p.active_acceleration.fill(4.0);
    p.linear_velocity = 0.5;
    p.linear_acceleration = 2.0;
    p.rotational_velocity = 1.0;
    p.rotational_acceleration = 4.0;
  }

  [[nodiscard]] std::size_t joints() const { return chain_.variable_count(); }
  [[nodiscard]] const kinematics::Chain& chain() const { return chain_; }
  [[nodiscard]] const JointValues& q() const { return q_; }
  [[nodiscard]] const JointValues& qd() const { return qd_; }
  [[nodiscard]] Pose X_BT() const { return kinematics::forward(chain_, std::span(q_).first(joints())); }
  [[nodiscard]] const MotionState& state() const { return sut_->state(); }
  [[nodiscard]] MoveExecutor& sut() { return *sut_; }
  [[nodiscard]] double now() const { return now_; }
  [[nodiscard]] Timestamp time() const { return time_of(now_); }
  // Of the clock of the ride, which does not begin with "never".
  [[nodiscard]] static Timestamp time_of(double seconds) {
    return Timestamp{1'000'000'000 + std::llround(seconds * 1e9)};
  }
  // When the newest move ended, s.
  [[nodiscard]] double finished() const { return seconds(state().finished_time - time_of(0)); }

  // A move by the planner's parameters; not tried out before.
  [[nodiscard]] Move joints_to(const JointValues& target, Start start = Start::supersede) {
    Move move = plan_joint_move(chain_, parameters, target).value();
    return stamped(move, start);
  }
  // The planner's move, or nothing where the line cannot be followed.
  [[nodiscard]] Result<Move> line_to(const JointValues& from, const Pose& X_BG, Start start = Start::supersede) {
    auto plan = plan_linear_move(chain_, parameters, from, X_BG);
    if (!plan) return std::unexpected(plan.error());
    end_of_plan = plan->end;
    duration_of_plan = plan->duration_s;
    return stamped(plan->move, start);
  }
  [[nodiscard]] Move pause(double seconds) {
    Move move;
    move.kind = MoveKind::delay;
    move.delay_s = seconds;
    return stamped(move, Start::queue);
  }
  [[nodiscard]] Result<Move> arc_to(const JointValues& from, const Eigen::Vector3d& p_BV, const Pose& X_BG,
                                    Start start = Start::queue) {
    auto plan = plan_circular_move(chain_, parameters, from, p_BV, X_BG);
    if (!plan) return std::unexpected(plan.error());
    end_of_plan = plan->end;
    duration_of_plan = plan->duration_s;
    return stamped(plan->move, start);
  }
  Move stamped(Move move, Start start) {
    move.start = start;
    move.id = ++ids_;
    return move;
  }

  // One tick. Checks ranges and velocities.
  bool tick(double dt = kTick) {
    const JointValues before = q_;
    now_ += dt;
    const bool moved = sut_->step(dt, time(), {chain_.lower(), chain_.upper()}, std::span(q_).first(joints()),
                                  std::span(qd_).first(joints()));
    if (!moved) qd_.fill(0);
    for (std::size_t i = 0; i < joints(); ++i) {
      EXPECT_GE(q_[i], chain_.lower()[i] - 1e-9) << "joint " << i << " at " << now_;
      EXPECT_LE(q_[i], chain_.upper()[i] + 1e-9) << "joint " << i << " at " << now_;
      const double speed = std::abs(q_[i] - before[i]) / dt;
      EXPECT_LE(speed, parameters.max_velocity[i] * (1 + 1e-6)) << "joint " << i << " at " << now_;
      EXPECT_LE(speed, sut_->fastest()[i] * (1 + 1e-6) + 1e-9) << "joint " << i << " at " << now_;
    }
    return moved;
  }
  // Until it stands; seconds.
  double run(const std::function<void()>& each = [] {}, double most = 60) {
    const double start = now_;
    do {
      tick();
      each();
    } while (state().moving && now_ < start + most);
    EXPECT_FALSE(state().moving);
    return now_ - start;
  }

  RobotParameters parameters;
  JointValues end_of_plan{};
  double duration_of_plan = 0;

 private:
  kinematics::Chain chain_;
  JointValues q_{};
  JointValues qd_{};
  std::unique_ptr<MoveExecutor> sut_ = std::make_unique<MoveExecutor>();
  std::uint32_t ids_ = 0;
  double now_ = 0;
};

}  // namespace cellmirror::motion
