#include "app/gateway/tcp_force_worker.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace cellmirror::app {

namespace {

// The one whose instrument is the active robot; null: nothing tells of a force there.
const HapticState* haptic_of_active(const OwnerPicture& picture, const engine::TickState& tick) {
  const auto robot = std::ranges::find(picture.robots, picture.active_robot, &RobotPicture::id);
  if (robot == picture.robots.end()) return nullptr;
  const auto state = std::ranges::find_if(tick.haptics, [&](const HapticState& haptic) {
    return haptic.phase != HapticPhase::closed && haptic.slot == robot->slot;
  });
  return state == tick.haptics.end() ? nullptr : &*state;
}

bool is_beyond(const TcpForce& force, const ForceLimits& limits) {
  const double newton = std::hypot(force.values[0], force.values[1], force.values[2]);
  const double newton_metres = std::abs(static_cast<double>(force.values[3]));
  return (limits.max_force > 0 && newton > limits.max_force) ||
         (limits.max_torque > 0 && newton_metres > limits.max_torque);
}

}  // namespace

TcpForce tcp_force_of(const OwnerPicture& picture, const engine::TickState& tick) {
  TcpForce out;
  out.time = tick.time;
  out.process = static_cast<std::uint32_t>(getpid());
  out.robot.assign(picture.active_robot);
  if (picture.forces.test) {
    std::ranges::transform(*picture.forces.test, out.values.begin(), [](double v) { return static_cast<float>(v); });
    out.flags = kTcpForceValid | kTcpForceTest;
  } else if (const HapticState* haptic = haptic_of_active(picture, tick)) {
    for (std::size_t i = 0; i < 3; ++i)
      out.values[i] = static_cast<float>(haptic->force_E[static_cast<Eigen::Index>(i)]);
    out.values[3] = static_cast<float>(haptic->axis_torque);
    out.flags = kTcpForceValid;
  }
  if (is_beyond(out, picture.forces.limits)) out.flags |= kTcpForceBeyondLimit;
  return out;
}

TcpForceWorker::TcpForceWorker(engine::Engine& engine, const PictureBoard& pictures, const Clock& clock,
                               Nanoseconds tick_period)
    : worker_(
          "tcp-force", *this, [&engine]() -> const engine::TickState& { return engine.tcp_force_view(); }, pictures,
          clock, tick_period) {}

void TcpForceWorker::run(const OwnerPicture& picture, const engine::TickState& tick) {
  TcpForce force = tcp_force_of(picture, tick);
  force.sequence = ++sequence_;
  picture.tcp_force->write(force);
}

}  // namespace cellmirror::app
