#include "drivers/dds/ros2_messages.hpp"

#include <limits>

namespace cellmirror::dds {

namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::size_t kLeastTextBytes = 4;  // the length alone
// Stamp, two strings, and from the first aligned position on seven doubles.
constexpr std::size_t kLeastTransformBytes = 8 + 2 * kLeastTextBytes + 7 * sizeof(double);

RosTime read_time(CdrReader& in) {
  RosTime time;
  time.sec = in.read<std::int32_t>();
  time.nanosec = in.read<std::uint32_t>();
  return time;
}

void read_header(CdrReader& in, Header& header) {
  header.stamp = read_time(in);
  header.frame_id.assign(in.read_text());
}

void copy(const DoubleSequenceView& from, std::vector<double>& to) {
  to.resize(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i];
}

}  // namespace

std::optional<std::int64_t> wall_clock_ns(RosTime time) {
  if (time == RosTime{} || time.sec < 0 || time.nanosec >= kNsPerSecond) return std::nullopt;
  return std::int64_t{time.sec} * kNsPerSecond + time.nanosec;
}

RosTime ros_time(std::int64_t wall_clock_ns) {
  const std::int64_t sec = wall_clock_ns / kNsPerSecond;
  if (wall_clock_ns < 0 || sec > std::numeric_limits<std::int32_t>::max()) return {};
  return {static_cast<std::int32_t>(sec), static_cast<std::uint32_t>(wall_clock_ns % kNsPerSecond)};
}

CdrFault decode(std::span<const std::byte> payload, JointStateView& message) {
  CdrReader in(payload);
  message.stamp = read_time(in);
  message.frame_id = in.read_text();
  const std::uint32_t names = in.read_count(kLeastTextBytes, kMaxJointsInMessage);
  message.name.clear();
  for (std::uint32_t i = 0; i < names && in.fault() == CdrFault::none; ++i) message.name.push_back(in.read_text());
  message.position = in.read_doubles();
  message.velocity = in.read_doubles();
  message.effort = in.read_doubles();
  return in.fault();
}

CdrFault decode(std::span<const std::byte> payload, JointState& message) {
  JointStateView view;
  if (const CdrFault fault = decode(payload, view); fault != CdrFault::none) return fault;
  message.header.stamp = view.stamp;
  message.header.frame_id.assign(view.frame_id);
  message.name.resize(view.name.size());
  for (std::size_t i = 0; i < view.name.size(); ++i) message.name[i].assign(view.name[i]);
  copy(view.position, message.position);
  copy(view.velocity, message.velocity);
  copy(view.effort, message.effort);
  return CdrFault::none;
}

CdrFault decode(std::span<const std::byte> payload, TfMessage& message) {
  CdrReader in(payload);
  const std::uint32_t count = in.read_count(kLeastTransformBytes, kMaxTransformsInMessage);
  message.transforms.resize(count);
  for (TransformStamped& transform : message.transforms) {
    read_header(in, transform.header);
    transform.child_frame_id.assign(in.read_text());
    for (double& value : transform.translation) value = in.read<double>();
    for (double& value : transform.rotation) value = in.read<double>();
    if (in.fault() != CdrFault::none) break;
  }
  return in.fault();
}

void encode(std::string_view text, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  writer.write_text(text);
}

CdrFault decode(std::span<const std::byte> payload, std::string_view& text) {
  CdrReader reader(payload);
  text = reader.read_text();
  return reader.fault();
}

void write(const Header& header, CdrWriter& out) {
  out.write(header.stamp.sec);
  out.write(header.stamp.nanosec);
  out.write_text(header.frame_id);
}

void encode(const JointState& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  write(message.header, writer);
  writer.write_count(message.name.size());
  for (const std::string& name : message.name) writer.write_text(name);
  writer.write_doubles(message.position);
  writer.write_doubles(message.velocity);
  writer.write_doubles(message.effort);
}

void encode(const TfMessage& message, std::vector<std::byte>& out) {
  CdrWriter writer(out);
  writer.write_count(message.transforms.size());
  for (const TransformStamped& transform : message.transforms) {
    write(transform.header, writer);
    writer.write_text(transform.child_frame_id);
    for (const double value : transform.translation) writer.write(value);
    for (const double value : transform.rotation) writer.write(value);
  }
}

}  // namespace cellmirror::dds
