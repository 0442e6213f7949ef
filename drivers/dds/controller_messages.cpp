#include "drivers/dds/controller_messages.hpp"

#include <utility>

#include "drivers/dds/trajectory_messages.hpp"

namespace cellmirror::dds {

namespace {

constexpr std::size_t kLeastMultiDofBytes = 4;
constexpr std::size_t kLeastToleranceBytes = 28;  // a length and three doubles
constexpr std::uint32_t kMostTolerances = 4 * kMaxTrajectoryJoints;

enum class Part : std::uint8_t { reference, feedback, error };

AxisState axis_of(const ControllerState& state, Part part, std::size_t i) {
  const AxisState& wanted = state.reference[i];
  const AxisState& is = state.feedback[i];
  if (part == Part::reference) return wanted;
  if (part == Part::feedback) return is;
  return {wanted.position - is.position, wanted.velocity - is.velocity, wanted.acceleration - is.acceleration};
}

// trajectory_msgs/JointTrajectoryPoint. Nobody measures accelerations.
void write_point(const ControllerState& state, Part part, CdrWriter& out) {
  const std::size_t joints = state.reference.size();
  out.write_count(joints);
  for (std::size_t i = 0; i < joints; ++i) out.write(axis_of(state, part, i).position);
  out.write_count(joints);
  for (std::size_t i = 0; i < joints; ++i) out.write(axis_of(state, part, i).velocity);
  const bool has_acceleration = part == Part::reference;
  out.write_count(has_acceleration ? joints : 0);
  for (std::size_t i = 0; has_acceleration && i < joints; ++i) out.write(axis_of(state, part, i).acceleration);
  out.write_count(0);  // effort
  write_duration(Nanoseconds(static_cast<std::int64_t>(state.elapsed * 1e9)), out);
}

void write_empty_point(CdrWriter& out) { write(TrajectoryPoint{}, out); }

// trajectory_msgs/MultiDOFJointTrajectoryPoint without joints.
void write_empty_multi_dof(CdrWriter& out) {
  for (int i = 0; i < 3; ++i) out.write_count(0);
  write_duration(Nanoseconds(0), out);
}

void write_head(const ControllerMessage& message, CdrWriter& out) {
  write(Header{message.stamp, {}}, out);
  out.write_count(message.joints.size());
  for (const std::string& joint : message.joints) out.write_text(joint);
}

void write_id(const GoalId& id, CdrWriter& out) { out.write_bytes(id); }

void write_time(RosTime time, CdrWriter& out) {
  out.write(time.sec);
  out.write(time.nanosec);
}

RosTime read_stamp(CdrReader& in) {
  RosTime time;
  time.sec = in.read<std::int32_t>();
  time.nanosec = in.read<std::uint32_t>();
  return time;
}

void read_tolerances(CdrReader& in, std::vector<TrajectoryTolerance>& out) {
  const std::uint32_t count = in.read_count(kLeastToleranceBytes, kMostTolerances);
  out.clear();
  for (std::uint32_t i = 0; i < count && in.fault() == CdrFault::none; ++i) {
    TrajectoryTolerance& one = out.emplace_back();
    one.joint = in.read_text();
    one.position = in.read<double>();
    one.velocity = in.read<double>();
    one.acceleration = in.read<double>();
  }
}

// control_msgs/JointComponentTolerance, of joints with several axes: passed over.
void skip_component_tolerances(CdrReader& in) {
  const std::uint32_t count = in.read_count(kLeastToleranceBytes, kMostTolerances);
  for (std::uint32_t i = 0; i < count && in.fault() == CdrFault::none; ++i) {
    static_cast<void>(in.read_text());
    static_cast<void>(in.read<std::uint16_t>());
    for (int value = 0; value < 3; ++value) static_cast<void>(in.read<double>());
  }
}

// trajectory_msgs/MultiDOFJointTrajectory. False where it has joints or points.
bool read_no_multi_dof(CdrReader& in) {
  static_cast<void>(read_stamp(in));
  static_cast<void>(in.read_text());
  const bool joints = in.read_count(kLeastMultiDofBytes, kMaxTrajectoryJoints) > 0;
  if (joints) return false;
  return in.read_count(kLeastMultiDofBytes, kMaxTrajectoryPoints) == 0;
}

}  // namespace

void encode(const ControllerMessage& message, RosDistribution distribution, std::vector<std::byte>& out) {
  const bool humble = distribution == RosDistribution::humble;
  CdrWriter writer(out);
  write_head(message, writer);
  write_point(message.state, Part::reference, writer);
  write_point(message.state, Part::feedback, writer);
  write_point(message.state, Part::error, writer);
  write_empty_point(writer);  // output
  if (humble) {
    write_point(message.state, Part::reference, writer);  // desired
    write_point(message.state, Part::feedback, writer);   // actual
  }
  writer.write_count(0);
  for (int i = 0; i < (humble ? 6 : 4); ++i) write_empty_multi_dof(writer);
  if (!humble) writer.write(1.0);
}

void encode_feedback(const GoalId& goal, const ControllerMessage& message, RosDistribution distribution,
                     std::vector<std::byte>& out) {
  const bool has_index = distribution == RosDistribution::kilted;
  CdrWriter writer(out);
  write_id(goal, writer);
  write_head(message, writer);
  write_point(message.state, Part::reference, writer);
  write_point(message.state, Part::feedback, writer);
  write_point(message.state, Part::error, writer);
  if (has_index) writer.write(message.state.point);
  writer.write_count(0);
  for (int i = 0; i < 3; ++i) write_empty_multi_dof(writer);
  if (has_index) writer.write(std::int32_t{0});
}

CdrFault decode(CdrReader in, GoalRequest& request) {
  in.read_octets(request.goal.id);
  read(in, request.trajectory);
  request.goal.multi_dof = !read_no_multi_dof(in) && in.fault() == CdrFault::none;
  if (request.goal.multi_dof) return CdrFault::none;
  read_tolerances(in, request.goal.path);
  skip_component_tolerances(in);
  read_tolerances(in, request.goal.goal);
  skip_component_tolerances(in);
  request.goal.goal_time = read_duration(in);
  return in.fault();
}

CdrFault decode(CdrReader in, CancelRequest& request) {
  in.read_octets(request.id);
  request.stamp = read_stamp(in);
  return in.fault();
}

CdrFault decode(CdrReader in, GoalId& id) {
  in.read_octets(id);
  return in.fault();
}

void write_goal_reply(bool accepted, RosTime stamp, CdrWriter& out) {
  out.write(static_cast<std::uint8_t>(accepted ? 1 : 0));
  write_time(stamp, out);
}

void write_cancel_reply(CancelCode code, std::span<const GoalInfo> goals, CdrWriter& out) {
  out.write(std::to_underlying(code));
  out.write_count(goals.size());
  for (const GoalInfo& goal : goals) {
    write_id(goal.id, out);
    write_time(goal.stamp, out);
  }
}

void write_result_reply(GoalStatus status, const GoalResult& result, CdrWriter& out) {
  out.write(std::to_underlying(status));
  out.write(result.error_code);
  out.write_text(result.text);
}

void encode_status(std::span<const GoalInfo> goals, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  writer.write_count(goals.size());
  for (const GoalInfo& goal : goals) {
    write_id(goal.id, writer);
    write_time(goal.stamp, writer);
    writer.write(std::to_underlying(goal.status));
  }
}

}  // namespace cellmirror::dds
