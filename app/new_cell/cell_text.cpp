#include "app/new_cell/cell_text.hpp"

#include <fmt/format.h>

#include <numbers>

#include "app/new_cell/names.hpp"

namespace cellmirror::app {

namespace {

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", number_text(v.x()), number_text(v.y()), number_text(v.z()));
}

const char* unit_of(JointKind kind) { return kind == JointKind::prismatic ? "m" : "rad"; }

std::string node_text(const PlannedRobot& robot) {
  std::string out = "\n[[node]]\n";
  out += fmt::format("name = {}\n", toml_text(robot.node));
  out += fmt::format("abstract = {}\n", toml_text(robot.file));
  if (!robot.base.empty()) out += fmt::format("robot_base = {}\n", toml_text(robot.base));
  out += fmt::format("xyz_m = {}   # DECIDE: where its {} stands, in metres\n", vector_text(robot.xyz_m),
                     robot.made_up ? "foot" : "root link");
  if (robot.rpy_rad != Eigen::Vector3d::Zero()) out += fmt::format("rpy_rad = {}\n", vector_text(robot.rpy_rad));
  return out;
}

std::string topic_stream(const PlannedRobot& robot) {
  std::string out = "kind = \"dds\"\n";
  out += fmt::format("topic = {}\n", toml_text(robot.topic));
  out +=
      "domain = 0                         # DECIDE: ROS_DOMAIN_ID of the robot\n"
      "interface_address = \"127.0.0.1\"    # DECIDE: this machine's address in the robot's network; loopback: only "
      "here\n"
      "# Joints are matched by their names in the URDF. If the messages use others, write for each joint:\n"
      "#   [[stream.joint]]\n"
      "#   joint = \"NAME IN THE URDF\"\n"
      "#   ros_name = \"NAME IN THE MESSAGES\"\n";
  return out;
}

std::string channel_text(const CellPlan& plan) {
  return fmt::format("channel = {}   # DECIDE: the CAN interface; without one e.g. udp:239.74.163.2:43113\n",
                     toml_text(plan.channel));
}

std::string drive_text(const PlannedRobot& robot, const PlannedDrive& drive) {
  const PlannedJoint& joint = robot.joints[drive.joint];
  std::string out = "[[stream.node]]\n";
  out += fmt::format("id = {}\njoint = {}\n", drive.node, toml_text(joint.name));
  out += fmt::format("increments_per_{} = {}   # {}\n", unit_of(joint.kind), number_text(drive.increments),
                     drive.increments_known ? "by 0x608F and 0x6091 of the EDS; DECIDE: is that at the joint?"
                                            : "DECIDE: a placeholder; increments of 0x6064 at the joint");
  out += "sign = 1             # DECIDE: -1 where the drive counts the other way round\n";
  out +=
      fmt::format("offset_{} = 0.0     # DECIDE: the joint's position where the drive counts 0\n", unit_of(joint.kind));
  if (!drive.eds.empty() && drive.position_mapped) out += fmt::format("eds = {}\n", toml_text(drive.eds));
  if (drive.eds.empty()) {
    out += "# DECIDE: no EDS was given, so TPDO1 is taken to be statusword and position, as it is by default\n";
  } else if (!drive.position_mapped) {
    out += fmt::format(
        "# DECIDE: {} has no TPDO in use with the position 0x6064,\n"
        "# or its COB-ID is that of another node. The gateway expects this TPDO, so the drive has to send it.\n"
        "# `configure = true` writes it to the drive: not on a bus with another master.\n"
        "configure = false\n"
        "[[stream.node.tpdo]]\n"
        "number = 1\n"
        "entries = [{{ index = 0x6041, bits = 16 }}, {{ index = 0x6064, bits = 32 }}]\n",
        toml_text(drive.eds));
  }
  return out;
}

std::string drives_stream(const CellPlan& plan, const PlannedRobot& robot) {
  std::string out = "kind = \"can-cia402\"\n" + channel_text(plan);
  out += "start_nodes = true       # DECIDE: false where another master starts the drives\n";
  out += "heartbeat_timeout_s = 0.5\n";
  for (const PlannedDrive& drive : robot.drives) out += drive_text(robot, drive);
  return out;
}

const char* quantity_word(JointQuantity quantity) {
  switch (quantity) {
    case JointQuantity::position:
      return "position";
    case JointQuantity::velocity:
      return "velocity";
    case JointQuantity::effort:
      break;
  }
  return "effort";
}

std::string signal_text(const PlannedRobot& robot, const PlannedSignal& signal) {
  const PlannedJoint& joint = robot.joints[signal.joint];
  std::string out = "[[stream.signal]]\n";
  out += fmt::format("message = {}\nsignal = {}\n", toml_text(signal.message), toml_text(signal.signal));
  out += fmt::format("joint = {}   # DECIDE: guessed by the order in the DBC\n", toml_text(joint.name));
  out += fmt::format("quantity = \"{}\"\n", quantity_word(signal.quantity));
  const std::string unit = signal.unit.empty() ? "no unit" : toml_text(signal.unit);
  out += fmt::format("scale = {}   # DECIDE: to rad or m; the DBC says {}{}\n", number_text(signal.scale), unit,
                     signal.multiplexed ? "; the signal is multiplexed" : "");
  return out;
}

std::string signals_stream(const CellPlan& plan, const PlannedRobot& robot) {
  std::string out = "kind = \"can-dbc\"\n" + channel_text(plan);
  out += fmt::format("dbc = {}\n", toml_text(robot.dbc));
  for (const PlannedSignal& signal : robot.signals) out += signal_text(robot, signal);
  return out;
}

// Of bytes from a DBC: one line, whatever they are.
std::string comment_line(const std::string& text) {
  const std::string quoted = toml_text(text);
  return "#   " + quoted.substr(1, quoted.size() - 2) + "\n";
}

std::string stream_text(const CellPlan& plan, const PlannedRobot& robot) {
  std::string out = "\n[[stream]]\n";
  out += fmt::format("robot = {}\n", toml_text(robot.id));
  if (!robot.topic.empty()) return out + topic_stream(robot);
  if (!robot.drives.empty()) return out + drives_stream(plan, robot);
  return out + signals_stream(plan, robot);
}

// What cannot be guessed is left as a comment.
std::string unguessed_text(const PlannedRobot& robot) {
  if (robot.other_signals.empty()) return {};
  std::string out = "\n# DECIDE: other signals of the DBC, which look like no joint's position:\n";
  for (const std::string& signal : robot.other_signals) out += comment_line(signal);
  return out;
}

}  // namespace

std::vector<PlannedJoint> made_up_joints(std::size_t count) {
  std::vector<PlannedJoint> joints;
  for (std::size_t i = 1; i <= count; ++i) {
    joints.push_back({fmt::format("J_{}", i), JointKind::revolute, -std::numbers::pi, std::numbers::pi, 0.0, 2.0});
  }
  return joints;
}

std::string axes_text(const PlannedRobot& robot) {
  std::string out = fmt::format(
      "# {}: axes of which only the bus is known, one above the other. Made by `cellmirror new`.\n"
      "# DECIDE: type (\"revolute\", or \"prismatic\" with range_m and velocity_m_s), axis, range, speed and place of "
      "each\n"
      "# joint, and what it looks like: geometry here is only drawn, since it touches nothing (collides = false).\n"
      "format = 1\n"
      "description = \"Axes whose model is a guess\"\n"
      "geometry = [{{ name = \"foot\", cylinder_m = [0.1, 0.1], xyz_m = [0.0, 0.0, 0.05], rgba = [0.4, 0.42, 0.45, "
      "1.0], "
      "collides = false }}]\n",
      robot.id);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const PlannedJoint& joint = robot.joints[i];
    out += fmt::format("\n[[node]]\nname = {}\n", toml_text(joint.name));
    if (i > 0) out += fmt::format("parent = {}\n", toml_text(robot.joints[i - 1].name));
    out += "xyz_m = [0.0, 0.0, 0.12]\n";
    out +=
        fmt::format("joint = {{ type = \"revolute\", axis = [0, 0, 1], range_rad = [{}, {}], velocity_rad_s = {} }}\n",
                    number_text(joint.min_position), number_text(joint.max_position), number_text(joint.max_velocity));
    out +=
        "geometry = [{ name = \"lever\", box_m = [0.24, 0.06, 0.06], xyz_m = [0.08, 0.0, 0.0], rgba = [0.25, 0.55, "
        "0.45, "
        "1.0], collides = false }]\n";
  }
  out += fmt::format("\n[[node]]\nname = \"TIP\"\nparent = {}\nxyz_m = [0.0, 0.0, 0.06]\n",
                     toml_text(robot.joints.back().name));
  out += fmt::format("\n[robot]\nid = {}\nflange = \"TIP\"\n", toml_text(robot.id));
  return out;
}

std::string cell_text(const CellPlan& plan) {
  std::string out = fmt::format(
      "# The cell {}, made by `cellmirror new`. Lines with DECIDE are guesses that a person has to confirm.\n"
      "# `cellmirror check cell.toml` says what is wrong; docs/cell-files.md explains the keys. All quantities are "
      "SI.\n"
      "format = 1\n"
      "name = {}\n"
      "description = \"DECIDE: one line about this cell\"\n"
      "geometry = [   # DECIDE: what stands around; without `collides = false` it is tested for collisions\n"
      "  {{ name = \"floor\", box_m = [4.0, 4.0, 0.02], xyz_m = [0.0, 0.0, -0.01], rgba = [0.55, 0.57, 0.55, 1.0], "
      "collides = false }},\n"
      "]\n",
      plan.name, toml_text(plan.name));
  for (const PlannedRobot& robot : plan.robots) out += node_text(robot);
  for (const PlannedRobot& robot : plan.robots) out += stream_text(plan, robot);
  for (const PlannedRobot& robot : plan.robots) out += unguessed_text(robot);
  out +=
      "\n# Joint states, frames, the robot's description, collisions and more for ROS 2 programs (RViz): docs/dds.md.\n"
      "[dds_output]\n"
      "rate_hz = 50\n"
      "\n# Executed when the cell is loaded: takes the robots on line.\n"
      "[startup]\n"
      "script = \"startup.spt\"\n";
  return out;
}

std::string startup_text(const CellPlan& plan) {
  std::string out = "# Mirrors every robot of the cell, and publishes it.\n";
  for (const PlannedRobot& robot : plan.robots) {
    out += fmt::format("ROBOT {} online;\nROBOT {} send_on;\n", robot.id, robot.id);
  }
  return out + fmt::format("ROBACT {};\nDRAW_SCENE\n", plan.robots.front().id);
}

}  // namespace cellmirror::app
