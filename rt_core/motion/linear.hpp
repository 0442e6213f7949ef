// Moves the TCP along straight ways and arcs and finds the joints for them, tick by tick. Belongs to the tick thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "rt_core/base/real_time.hpp"
#include "rt_core/kinematics/chain.hpp"
#include "rt_core/motion/move.hpp"
#include "rt_core/motion/path.hpp"

namespace cellmirror::motion {

// Accuracy of the joints on the path, per component [m, rad]: requested, and still accepted near rounding limits or
// singularities.
inline constexpr double kPathTolerance = 1e-8;
inline constexpr double kPathTaken = 1e-6;

class LinearMotion {
 public:
  enum class Progress : std::uint8_t {
    under_way,
    arrived,
    blocked,  // no posture for the next piece; q and qd are untouched
  };

  // From rest in `q`. `chain` lives as long as the motion. Of the `lag` seconds by which it begins late it makes up for
  // those that it gives back.
  double start(const Move& move, const kinematics::Chain& chain, std::span<const double> q, double lag) CELL_RT;
  // Instead of what is left. As much of the present velocity as leads along the new way is kept; the rest brakes, and
  // the move (linear) goes, superposed, from where that will stop. `pace`: of the last advance(), here and below.
  void blend(const Move& move, double pace) CELL_RT;
  // Behind what is left, and superposed on it. Only where at_fly_point().
  void append(const Move& move) CELL_RT;
  // To rest on the present way, at the acceleration of the newest move.
  void brake(double pace) CELL_RT;

  // Where the next move may begin (manual, rob_cart_fly_radius). Never while two are superposed already.
  [[nodiscard]] bool at_fly_point() const CELL_RT;
  // Whether a move of this chain and task can be superposed.
  [[nodiscard]] bool fits(const Move& move, const kinematics::Chain* chain) const CELL_RT;

  // `dt` seconds on from the posture `q`, of which the path advances by the fraction `pace` (positive). It slows down
  // further if a joint, or the TCP under two superposed moves, would be too fast.
  Progress advance(double dt, double pace, std::span<double> q, std::span<double> qd) CELL_RT;
  // How long before the end of the last advance() it arrived, s.
  [[nodiscard]] double overrun() const CELL_RT { return overrun_; }
  [[nodiscard]] PaceChange pace_change(double pace) const CELL_RT { return path_.pace_change(pace); }
  // Whether the older one of two superposed moves ended in the last advance().
  [[nodiscard]] bool older_ended() const CELL_RT { return older_ended_; }

  [[nodiscard]] const kinematics::Chain* chain() const CELL_RT { return chain_; }
  [[nodiscard]] const JointValues& max_velocity() const CELL_RT { return max_velocity_; }
  [[nodiscard]] const JointValues& acceleration() const CELL_RT { return move_.acceleration; }  // of the joints

  // Its members, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive.reference(chain_);
    archive(move_, path_, posture_, max_velocity_, linear_velocity_, rotational_velocity_, pace_, overrun_,
            older_ended_);
  }

 private:
  [[nodiscard]] double pace_of_tool(double dt, double pace) const CELL_RT;
  [[nodiscard]] bool find_posture(double later, JointValues& posture) const CELL_RT;
  void put(const JointValues& posture, bool last, double dt, std::span<double> q, std::span<double> qd) const CELL_RT;
  [[nodiscard]] double stopping_time(const kinematics::Twist& twist) const CELL_RT;
  void take_limits(const Move& move, bool superposed) CELL_RT;

  const kinematics::Chain* chain_ = nullptr;
  Move move_;  // the newest
  SuperposedPath path_;
  JointValues posture_{};       // that meets the path; what the joints show lags behind it by steps below min_velocity
  JointValues max_velocity_{};  // of the moves under way, the higher one of each joint
  double linear_velocity_ = 0;
  double rotational_velocity_ = 0;
  double pace_ = 1;  // besides the requested one: 1, or less if the path is slowed down
  double overrun_ = 0;
  bool older_ended_ = false;
};

}  // namespace cellmirror::motion
