#include "drivers/dds/trajectory_messages.hpp"

#include <algorithm>
#include <limits>

namespace cellmirror::dds {

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::size_t kLeastNameBytes = 4;
// Four lengths and a duration.
constexpr std::size_t kLeastPointBytes = 24;

void read_doubles(CdrReader& in, std::vector<double>& out) {
  const DoubleSequenceView values = in.read_doubles();
  out.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = values[i];
}

void read_point(CdrReader& in, TrajectoryPoint& point) {
  read_doubles(in, point.positions);
  read_doubles(in, point.velocities);
  read_doubles(in, point.accelerations);
  read_doubles(in, point.effort);
  point.time_from_start = read_duration(in);
}

}  // namespace

Nanoseconds read_duration(CdrReader& in) {
  const auto sec = in.read<std::int32_t>();
  const auto nanosec = in.read<std::uint32_t>();
  if (nanosec >= kNanosecondsPerSecond) in.fail_with(CdrFault::time);
  return Nanoseconds(std::int64_t{sec} * kNanosecondsPerSecond + nanosec);
}

void write_duration(Nanoseconds duration, CdrWriter& out) {
  const std::int64_t ns = duration.count();
  const std::int64_t sec =
      ns >= 0 ? ns / kNanosecondsPerSecond : -((-ns + kNanosecondsPerSecond - 1) / kNanosecondsPerSecond);
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  out.write(static_cast<std::int32_t>(std::clamp(sec, -kMost, kMost)));
  out.write(static_cast<std::uint32_t>(ns - sec * kNanosecondsPerSecond));
}

void read(CdrReader& in, JointTrajectory& message) {
  RosTime stamp;
  stamp.sec = in.read<std::int32_t>();
  stamp.nanosec = in.read<std::uint32_t>();
  message.start_wall_ns = wall_clock_ns(stamp);
  if (!message.start_wall_ns && stamp != RosTime{}) in.fail_with(CdrFault::time);
  static_cast<void>(in.read_text());  // frame_id
  const std::uint32_t joints = in.read_count(kLeastNameBytes, kMaxTrajectoryJoints);
  message.joints.clear();
  for (std::uint32_t i = 0; i < joints && in.fault() == CdrFault::none; ++i)
    message.joints.emplace_back(in.read_text());
  const std::uint32_t points = in.read_count(kLeastPointBytes, kMaxTrajectoryPoints);
  message.points.resize(points);
  for (TrajectoryPoint& point : message.points) {
    if (in.fault() != CdrFault::none) return;
    read_point(in, point);
  }
}

CdrFault decode(std::span<const std::byte> payload, JointTrajectory& message) {
  CdrReader in(payload);
  read(in, message);
  return in.fault();
}

void write(const TrajectoryPoint& point, CdrWriter& out) {
  out.write_doubles(point.positions);
  out.write_doubles(point.velocities);
  out.write_doubles(point.accelerations);
  out.write_doubles(point.effort);
  write_duration(point.time_from_start, out);
}

void encode(const JointTrajectory& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  write(Header{message.start_wall_ns ? ros_time(*message.start_wall_ns) : RosTime{}, {}}, writer);
  writer.write_count(message.joints.size());
  for (const std::string& joint : message.joints) writer.write_text(joint);
  writer.write_count(message.points.size());
  for (const TrajectoryPoint& point : message.points) write(point, writer);
}

}  // namespace cellmirror::dds
