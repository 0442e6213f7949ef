#include "app/report/status_forces.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/report/status_collisions.hpp"
#include "app/report/status_values.hpp"
#include "rt_core/dynamics/arrows.hpp"

namespace cellmirror::app {

namespace {

using nlohmann::json;

constexpr std::size_t kMostArrows = 500;  // keeps the document within bounds

json optional_limit(double limit) { return limit > 0.0 ? json(limit) : json(nullptr); }

const char* component_word(ArrowComponent component) {
  switch (component) {
    case ArrowComponent::none:
      return "none";
    case ArrowComponent::x:
      return "x";
    case ArrowComponent::y:
      return "y";
    case ArrowComponent::z:
      return "z";
    case ArrowComponent::resultant:
      return "resultant";
  }
  return "none";
}

json wrench_json(const Wrench& wrench) {
  return {{"force_n", vector_json(wrench.force)}, {"torque_nm", vector_json(wrench.torque)}};
}

json joint_json(const JointForce& joint) {
  const bool slides = joint.kind == JointKind::prismatic;
  return {{"name", joint.name},
          {slides ? "effort_n" : "effort_nm", joint.effort},
          {slides ? "max_effort_n" : "max_effort_nm", optional_limit(joint.max_effort)},
          {"beyond_limit", joint.beyond_limit},
          {slides ? "velocity_m_s" : "velocity_rad_s", joint.velocity},
          {slides ? "acceleration_m_s2" : "acceleration_rad_s2", joint.acceleration},
          {"force_n", vector_json(joint.wrench_J.force)},
          {"torque_nm", vector_json(joint.wrench_J.torque)}};
}

json robot_json(const RobotForces& robot) {
  json joints = json::array();
  for (const JointForce& joint : robot.joints) joints.push_back(joint_json(joint));
  return {{"id", robot.id},
          {"computed", robot.computed},
          {"model_kg", robot.model_kg},
          {"payload_kg", robot.payload_kg},
          {"joints", std::move(joints)},
          {"tcp", robot.tcp_known ? wrench_json(robot.tcp_T) : json(nullptr)}};
}

json arrows_json(const ForceSettings& settings, const ForceState* state) {
  json shown = json::array();
  if (state != nullptr) {
    for (const ForceArrow& arrow : dynamics::force_arrows(settings.arrows, *state)) {
      if (shown.size() == kMostArrows) break;
      shown.push_back(
          {{"from_m", vector_json(arrow.from_m)}, {arrow.torque ? "torque_nm" : "force_n", vector_json(arrow.vector)}});
    }
  }
  return {{"joint_forces", component_word(settings.arrows.joint_forces)},
          {"joint_torques", component_word(settings.arrows.joint_torques)},
          {"tcp_force", component_word(settings.arrows.tcp_force)},
          {"motors_only", settings.arrows.motors_only},
          {"shown", std::move(shown)}};
}

}  // namespace

json forces_json(const ForceReport& report, const ForceSettings& settings, Timestamp now) {
  constexpr Nanoseconds kMicrosecond{1'000};
  constexpr Nanoseconds kMillisecond{1'000'000};
  json robots = json::array();
  json left_out = json::array();
  if (report.state) {
    for (const RobotForces& robot : report.state->robots) robots.push_back(robot_json(robot));
  }
  for (const dynamics::NotComputed& robot : report.not_computed)
    left_out.push_back({{"id", robot.robot}, {"why", robot.why}});
  return {{"active", report.active},
          {"gravity_m_s2", vector_json(report.gravity_m_s2)},
          {"age_s", report.state ? json(seconds(now - report.state->posture_time)) : json(nullptr)},
          {"sequence", report.state ? report.state->sequence : 0},
          {"rate_hz", report.rate_hz},
          {"skipped", report.skipped},
          {"compute_us", percentiles_json(report.compute, kMicrosecond)},
          {"visible_after_ms", percentiles_json(report.visible_after, kMillisecond)},
          {"robots", std::move(robots)},
          {"not_computed", std::move(left_out)},
          {"limit_warnings", report.limit_warnings},
          {"tcp_limits",
           {{"max_force_n", optional_limit(settings.limits.max_force)},
            {"max_torque_nm", optional_limit(settings.limits.max_torque)}}},
          {"arrows", arrows_json(settings, report.state.get())}};
}

}  // namespace cellmirror::app
