#include "drivers/dds/wrench_message.hpp"

namespace cellmirror::dds {

void encode(const WrenchStamped& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  write(message.header, writer);
  for (const double value : message.force) writer.write(value);
  for (const double value : message.torque) writer.write(value);
}

bool fill_tcp_wrench(RosTime stamp, const RobotForces& robot, WrenchStamped& message) {
  const auto& [force, torque] = robot.tcp_T;
  if (!robot.tcp_known || !force.allFinite() || !torque.allFinite()) return false;
  message.header.stamp = stamp;
  message.header.frame_id = robot.id + "/tcp";
  message.force = {force.x(), force.y(), force.z()};
  message.torque = {torque.x(), torque.y(), torque.z()};
  return true;
}

}  // namespace cellmirror::dds
