#include "rt_core/engine/trajectory_bytes.hpp"

#include "rt_core/ports/joint_trajectory.hpp"

namespace cellmirror::engine {

namespace {

using motion::KnotOrder;
using motion::KnotState;
using motion::Trajectory;

constexpr std::size_t kHeadBytes = 1024;
constexpr std::size_t kKnotBytes = 24;
constexpr std::size_t kPointBytes = 9;

template <class Archive>
void transfer_head(Archive& archive, Trajectory& value, std::size_t& points) {
  archive.bounded(value.joints, kMaxJointsPerRobot);
  archive.bounded(points, kMaxTrajectoryPoints);
  archive(value.id, value.start, value.given, value.max_velocity, value.deceleration, value.path_tolerance,
          value.goal_tolerance, value.stopped_velocity, value.goal_time);
}

template <class Archive>
void transfer_points(Archive& archive, Trajectory& value) {
  for (double& time : value.times) archive(time);
  for (KnotOrder& order : value.orders) archive.choice(order, KnotOrder::accelerations);
  for (KnotState& knot : value.knots) archive(knot.position, knot.velocity, knot.acceleration);
}

}  // namespace

std::size_t bytes_of(const Trajectory& trajectory) {
  return kHeadBytes + trajectory.points() * kPointBytes + trajectory.knots.size() * kKnotBytes;
}

void write_trajectory(StateWriter& out, const Trajectory& trajectory) {
  Trajectory copy = trajectory;
  std::size_t points = copy.points();
  transfer_head(out, copy, points);
  transfer_points(out, copy);
}

std::optional<Trajectory> read_trajectory(StateReader& in) {
  Trajectory out;
  std::size_t points = 0;
  transfer_head(in, out, points);
  // Before memory is taken: what is left has to hold them.
  if (!in.ok() || in.rest().size() < points * (kPointBytes + out.joints * kKnotBytes)) {
    in.fail();
    return std::nullopt;
  }
  out.times.resize(points);
  out.orders.resize(points);
  out.knots.resize(points * out.joints);
  transfer_points(in, out);
  if (in.ok() && motion::is_sound(out, out.joints)) return out;
  in.fail();
  return std::nullopt;
}

}  // namespace cellmirror::engine
