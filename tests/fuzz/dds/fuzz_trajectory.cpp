// Any bytes as a JointTrajectory, and what a robot does with it: what is accepted must survive being written and read
// again, be sound for the tick, and keep the robot within its range and its velocity.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "drivers/dds/trajectory_messages.hpp"
#include "rt_core/motion/trajectory_follower.hpp"
#include "rt_core/planning/trajectory_plan.hpp"

namespace {

using namespace cellmirror;

void require(bool condition) {
  if (!condition) std::abort();
}

constexpr std::size_t kJoints = 2;
constexpr double kRange = 2;
constexpr double kVelocity = 3;
constexpr double kDt = 0.001;

void follow(motion::Trajectory trajectory) {
  trajectory.id = 1;
  require(motion::is_sound(trajectory, kJoints));
  motion::TrajectoryFollower follower;
  follower.reset(kJoints);
  std::vector<double> q(kJoints, 0.0);
  std::vector<double> qd(kJoints, 0.0);
  const std::vector<double> lower(kJoints, -kRange);
  const std::vector<double> upper(kJoints, kRange);
  require(follower.begin(trajectory, qd));
  Timestamp now{10'000'000'000};
  for (int i = 0; i < 100; ++i) {
    // Every fifth period is late by a second.
    now = now + Nanoseconds(i % 5 == 4 ? 1'000'000'000 : 1'000'000);
    const std::vector<double> before = q;
    follower.step(kDt, now, {lower, upper}, q, qd);
    for (std::size_t j = 0; j < kJoints; ++j) {
      require(std::isfinite(q[j]) && std::isfinite(qd[j]));
      require(q[j] >= -kRange && q[j] <= kRange);
      require(std::abs(q[j] - before[j]) <= kVelocity * kDt * (1 + 1e-9));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> payload(reinterpret_cast<const std::byte*>(data), size);
  JointTrajectory message;
  if (dds::decode(payload, message) != dds::CdrFault::none) return 0;
  std::vector<std::byte> written;
  dds::encode(message, written);
  JointTrajectory again;
  require(dds::decode(written, again) == dds::CdrFault::none);
  require(again.joints.size() == message.joints.size() && again.points.size() == message.points.size());
  require(again.start_wall_ns == message.start_wall_ns);
  if (message.points.empty()) return 0;
  planning::TrajectoryController controller;
  controller.joints = {{.number = 0, .name = "a", .path_tolerance = 0.5}, {.number = 1, .name = "b"}};
  controller.allow_partial = true;
  const std::vector<JointKind> kinds(kJoints, JointKind::revolute);
  RobotParameters parameters;
  parameters.min_range.fill(-kRange);
  parameters.max_range.fill(kRange);
  parameters.max_velocity.fill(kVelocity);
  auto planned =
      planning::plan_trajectory(controller, {kinds, parameters}, message, nullptr, {.now = Timestamp{10'000'000'000}});
  if (planned) follow(*std::move(planned));
  return 0;
}
