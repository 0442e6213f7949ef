#include "app/owner/robot_force_service.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <utility>

#include "rt_core/base/log.hpp"

namespace cellmirror::app {

namespace {

std::size_t at(std::int32_t node) { return static_cast<std::size_t>(node); }

bool is_named_below(const CompiledCell& cell, std::int32_t node, std::int32_t component) {
  for (; node >= 0; node = cell.naming_parent[at(node)]) {
    if (node == component) return true;
  }
  return false;
}

bool is_moved_by(const CompiledCell& cell, std::int32_t node, std::size_t slot) {
  for (; node >= 0; node = cell.parent[at(node)]) {
    const std::int32_t joint = cell.joint_of[at(node)];
    if (joint >= 0) return cell.joints[at(joint)].slot == slot;
  }
  return false;
}

// Whether dynamics::robot_mechanisms() gives the robot a mechanism: masses of its own model on its joints.
bool has_masses(const CompiledCell& cell, const CompiledRobot& robot) {
  return std::ranges::any_of(cell.inertia, [&](const CompiledInertia& body) {
    return is_moved_by(cell, body.node, robot.slot) && is_named_below(cell, body.node, robot.component);
  });
}

}  // namespace

std::string force_memory_remark(const CompiledCell& cell, const CompiledRobot& robot, std::size_t bytes) {
  constexpr std::size_t kFloat = 4;
  std::string remark;
  const std::size_t fit = bytes < kLeastHapticBytes ? 0 : (bytes - kLeastHapticBytes) / kFloat;
  if (fit < robot.joint_names.size()) {
    const auto left_out = std::span(robot.joint_names).subspan(fit);
    remark = fmt::format(
        "{} bytes hold the force and {} of {} joint torques; there is no room for {}: {} bytes hold all", bytes, fit,
        robot.joint_names.size(), fmt::join(left_out, ", "), kLeastHapticBytes + kFloat * robot.joint_names.size());
  }
  if (!has_masses(cell, robot)) {
    if (!remark.empty()) remark += "; ";
    remark += fmt::format(
        "the model of {} has no masses, so its values are zero unless a haptic device moves it or it "
        "touches tissue",
        robot.id);
  }
  return remark;
}

RobotForceService::~RobotForceService() {
  for (auto& [robot, buffer] : buffers_) buffer.memory->close();
}

Result<std::string> RobotForceService::set_memory(const std::string& robot, std::int32_t key, std::size_t bytes) {
  const RobotModel* model = parts_.cell.robot(robot);
  if (model == nullptr) return std::unexpected(parts_.cell.explain_robot(robot));
  const auto compiled = parts_.cell.compile();
  std::string remark = force_memory_remark(*compiled, *compiled->robot(model->slot()), bytes);
  const auto found = buffers_.find(robot);
  if (found != buffers_.end() && found->second.key == key) {
    if (found->second.bytes == bytes) return remark;
    release(robot, key);
  }
  auto segment = SharedSegment::make({.purpose = "forces of " + robot,
                                      .key = key,
                                      .bytes = bytes,
                                      .mode = parts_.mode,
                                      .instance = parts_.instance,
                                      .guard = parts_.guard,
                                      .block = GuardedBlock::haptic});
  if (!segment) return std::unexpected(segment.error());
  Buffer& buffer = buffers_[robot];
  if (buffer.memory) buffer.memory->close();
  const std::uint64_t attached = (*segment)->users().attached;
  buffer = {key, bytes, attached, std::make_shared<RobotForceMemory>(std::move(*segment))};
  // A buffer that a killed gateway left holds its last forces.
  buffer.memory->write(Eigen::Vector3d::Zero(), {});
  return remark;
}

void RobotForceService::release(std::string_view robot, std::int32_t key) {
  const auto found = buffers_.find(robot);
  if (found == buffers_.end() || found->second.key != key) return;
  found->second.memory->close();
  buffers_.erase(found);
}

std::string RobotForceService::robot_with_key(std::int32_t key) const {
  const auto found = std::ranges::find_if(buffers_, [&](const auto& entry) { return entry.second.key == key; });
  return found == buffers_.end() ? std::string() : found->first;
}

void RobotForceService::follow() {
  if (buffers_.empty()) return;
  const Timestamp now = parts_.clock.now();
  if (last_check_.known() && now - last_check_ < kFollowEvery) return;
  last_check_ = now;
  for (auto& [robot, buffer] : buffers_) {
    if (const auto users = buffer.memory->follow()) {
      buffer.attached = users->attached;
    } else {
      log_error("force.memory", "the memory {} with the forces of {} was removed: {}", buffer.key, robot,
                users.error().text());
    }
  }
}

std::vector<RobotForceSnapshot> RobotForceService::snapshots() const {
  std::vector<RobotForceSnapshot> out;
  for (const auto& [robot, buffer] : buffers_)
    out.push_back({robot, buffer.key, buffer.bytes, buffer.attached, buffer.memory->renewed(), buffer.memory});
  return out;
}

}  // namespace cellmirror::app
