// Computes the forces of the running cell's robots, in a thread of its own: every tick, or as often as it can.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "app/gateway/age_keeper.hpp"
#include "app/gateway/force_board.hpp"
#include "app/gateway/recycler.hpp"
#include "app/gateway/tick_worker.hpp"
#include "rt_core/dynamics/inverse_dynamics.hpp"
#include "rt_core/dynamics/motion_estimate.hpp"
#include "rt_core/dynamics/robot_mechanism.hpp"
#include "rt_core/engine/engine.hpp"
#include "rt_core/rt/latency_histogram.hpp"

namespace cellmirror::app {

struct NotComputed {
  std::string robot;
  std::string why;
};

// The forces at one tick after the other. No thread of its own. One thread.
class ForceComputation {
 public:
  explicit ForceComputation(const Eigen::Vector3d& gravity_W) : gravity_W_(gravity_W), motions_(kMaxRobots) {}

  // True where the mechanisms are other ones than before.
  bool take_cell(const std::shared_ptr<const CompiledCell>& cell);
  // Robots with masses, or with the instrument of a haptic device, at this tick. False, and `state` unchanged, where
  // the tick does not know all robots of the cell yet: a component was just loaded.
  bool compute(const engine::TickState& tick, ForceState& state);

  [[nodiscard]] bool has_mechanisms() const { return has_mechanisms_; }
  [[nodiscard]] const std::vector<NotComputed>& not_computed() const { return not_computed_; }
  // How often the effort of some joint has passed its limit.
  [[nodiscard]] std::uint64_t limit_warnings() const { return limit_warnings_; }

 private:
  struct Beyond {
    std::array<bool, kMaxJointsPerRobot> joint{};
  };

  bool take_motion(const engine::TickState& tick);
  void compute_robot(const dynamics::RobotMechanism& robot, RobotForces& out);
  void place_links(const dynamics::Mechanism& mechanism, std::span<const double> q);
  void take_tcp(const engine::TickState& tick, std::size_t robot, RobotForces& out);
  void watch_limits(const RobotForces& robot);

  Eigen::Vector3d gravity_W_;
  std::shared_ptr<const CompiledCell> cell_;
  std::vector<dynamics::RobotMechanism> mechanisms_;  // one a robot of the cell
  bool has_mechanisms_ = false;
  std::vector<NotComputed> not_computed_;
  std::vector<dynamics::MotionEstimate> motions_;  // by slot, as what follows
  std::vector<JointValues> positions_ = std::vector<JointValues>(kMaxRobots);
  std::vector<Beyond> beyond_ = std::vector<Beyond>(kMaxRobots);
  std::uint64_t limit_warnings_ = 0;
  CellPoses poses_;
  // Of the robot that is being computed.
  dynamics::DynamicsOutput output_;
  std::array<Pose, dynamics::kMaxLinks> X_WJ_;
};

// All that status tells of it, as of one moment.
struct ForceReport {
  bool active = false;  // some robot has masses, or there is a haptic device
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  std::shared_ptr<const ForceState> state;  // null: nothing was computed yet
  std::vector<NotComputed> not_computed;
  std::uint64_t limit_warnings = 0;
  std::uint64_t skipped = 0;  // ticks for which nothing was computed because the computation took longer
  double rate_hz = 0;
  HistogramSnapshot visible_after;
  HistogramSnapshot compute;
};

class ForceWorker final : private TickJob {
 public:
  // But for gravity_W (m/s2, in the world) not owned; they outlive the worker.
  ForceWorker(engine::Engine& engine, const PictureBoard& pictures, const Clock& clock, Nanoseconds tick_period,
              const Eigen::Vector3d& gravity_W);

  // Any thread.
  [[nodiscard]] ForceReport report() const;
  [[nodiscard]] const ForceBoard& board() const { return board_; }

 private:
  bool wanted(const OwnerPicture& picture) override;
  void run(const OwnerPicture& picture, const engine::TickState& tick) override;
  void take_cell(const OwnerPicture& picture);
  void show_nothing();

  const Clock& clock_;
  const Eigen::Vector3d gravity_W_;
  ForceComputation computation_;  // the worker's own
  Recycler<ForceState> states_;
  std::uint64_t sequence_ = 0;

  ForceBoard board_;
  AgeKeeper ages_;
  LatencyHistogram compute_;
  mutable std::mutex mutex_;  // of what follows
  bool active_ = false;
  std::vector<NotComputed> not_computed_;
  std::uint64_t limit_warnings_ = 0;

  TickWorker worker_;  // last: it uses everything above
};

}  // namespace cellmirror::app
