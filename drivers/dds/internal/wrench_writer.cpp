#include "drivers/dds/internal/wrench_writer.hpp"

#include "drivers/dds/sensor_ranges.hpp"
#include "rt_core/base/capacity.hpp"
#include "rt_core/base/log.hpp"

namespace cellmirror::dds {

CountingWriter* WrenchWriter::writer_of(const std::string& robot) {
  if (const auto known = writers_.find(robot); known != writers_.end()) return known->second.get();
  if (writers_.size() >= kMaxRobots) return nullptr;
  auto made = CountingWriter::make(participant_, topic_of("robot", prefix_, robot), kWrenchStampedType, options_);
  if (!made) log_error("dds.wrench-topic", "robot {}: {}", robot, made.error().text());
  const std::scoped_lock lock(mutex_);
  return writers_.emplace(robot, made ? std::move(*made) : nullptr).first->second.get();
}

void WrenchWriter::publish(const ForceState& state) {
  if (prefix_.empty()) return;
  const RosTime stamp = ros_time(to_wall_clock_ns(state.posture_time));
  for (const RobotForces& robot : state.robots) {
    if (!fill_tcp_wrench(stamp, robot, message_)) continue;
    CountingWriter* writer = writer_of(robot.id);
    if (writer == nullptr) continue;
    encode(message_, writer->payload());
    writer->write();
  }
}

void WrenchWriter::add_counters(std::vector<std::pair<std::string, std::uint64_t>>& counters, std::uint64_t& sent,
                                std::uint64_t& dropped) const {
  std::uint64_t its_sent = 0;
  std::uint64_t its_dropped = 0;
  std::uint64_t readers = 0;
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& [robot, writer] : writers_) {
      if (writer == nullptr) continue;
      its_sent += writer->sent();
      its_dropped += writer->dropped();
      readers += writer->readers();
    }
  }
  counters.insert(counters.end(),
                  {{"wrenches_sent", its_sent}, {"wrenches_dropped", its_dropped}, {"wrenches_readers", readers}});
  sent += its_sent;
  dropped += its_dropped;
}

}  // namespace cellmirror::dds
