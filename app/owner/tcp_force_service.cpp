#include "app/owner/tcp_force_service.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

bool is_moved(const CompiledCell& cell, std::int32_t node) {
  for (; node > 0; node = cell.parent[static_cast<std::size_t>(node)]) {
    if (cell.joint_of[static_cast<std::size_t>(node)] >= 0) return true;
  }
  return false;
}

}  // namespace

std::string arrows_without_effect(const ForceArrowSettings& settings, const CompiledCell& cell,
                                  bool has_haptic_devices) {
  const bool of_joints =
      settings.joint_forces != ArrowComponent::none || settings.joint_torques != ArrowComponent::none;
  const bool of_tcps = settings.tcp_force != ArrowComponent::none;
  const auto moves = [&](const CompiledInertia& body) { return is_moved(cell, body.node); };
  if (std::ranges::any_of(cell.inertia, moves)) return {};
  constexpr const char* kNoMasses = "no joint of the cell moves a part whose mass is known";
  if (of_tcps && !has_haptic_devices) {
    return fmt::format("{} and there is no haptic device, so {} have no arrows", kNoMasses,
                       of_joints ? "joints and TCPs" : "TCPs");
  }
  return of_joints ? fmt::format("{}, so joints have no arrows", kNoMasses) : std::string();
}

Result<void> TcpForceService::make_memory() {
  if (memory_) return {};
  auto segment = SharedSegment::make({.purpose = "force at the TCP",
                                      .key = parts_.key,
                                      .bytes = tcp_force_block_offset::kSize,
                                      .mode = parts_.mode,
                                      .instance = parts_.instance,
                                      .guard = parts_.guard,
                                      .block = GuardedBlock::tcp_force});
  if (!segment) return std::unexpected(segment.error());
  memory_ = std::make_shared<TcpForceMemory>(std::move(*segment));
  return {};
}

Result<void> TcpForceService::set_arrows(const ForceArrowSettings& settings) {
  const bool motors_only = settings_.arrows.motors_only;
  settings_.arrows = settings;
  settings_.arrows.motors_only = motors_only;
  return {};
}

Result<void> TcpForceService::set_motors_only(bool on) {
  settings_.arrows.motors_only = on;
  return {};
}

Result<void> TcpForceService::set_limits(const ForceLimits& limits) {
  const auto allowed = [](double limit) { return std::isfinite(limit) && limit >= 0.0; };
  if (!allowed(limits.max_force) || !allowed(limits.max_torque))
    return fail("a limit is a positive number", "0 means that there is no limit");
  if (auto made = make_memory(); !made) return made;
  settings_.limits = limits;
  return {};
}

Result<void> TcpForceService::set_test(bool on, const std::array<double, 4>& values) {
  if (!on) {
    settings_.test.reset();
    return {};
  }
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    return fail("a value is no number");
  if (auto made = make_memory(); !made) return made;
  settings_.test = values;
  return {};
}

void TcpForceService::follow() {
  if (!memory_) return;
  const Timestamp now = parts_.clock.now();
  if (last_check_.known() && now - last_check_ < kFollowEvery) return;
  last_check_ = now;
  if (memory_->segment().users().gone) {
    if (auto renewed = memory_->segment().renew(); !renewed)
      log_error("force.memory", "the memory {} was removed: {}", parts_.key, renewed.error().text());
  }
  const TcpForceReport report = memory_->report();
  const bool is_beyond = (report.newest.flags & kTcpForceBeyondLimit) != 0;
  if (!is_beyond && report.times_beyond == times_reported_) return;
  if (last_message_.known() && now - last_message_ < kMessageEvery) return;
  times_reported_ = report.times_beyond;
  last_message_ = now;
  warn(report.beyond);
}

void TcpForceService::warn(const TcpForce& force) {
  const auto& v = force.values;
  const double newton = std::hypot(v[0], v[1], v[2]);
  const std::string text =
      fmt::format("{}: force {:.2f} N, torque {:.3f} Nm at the TCP; the limits are {} N and {} Nm", force.robot.view(),
                  newton, v[3], settings_.limits.max_force, settings_.limits.max_torque);
  parts_.show_message(text);
}

}  // namespace cellmirror::app
