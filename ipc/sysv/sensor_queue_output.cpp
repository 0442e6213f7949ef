#include "ipc/sysv/sensor_queue_output.hpp"

#include <array>
#include <atomic>
#include <utility>

#include "ipc/sysv/owned_queue.hpp"
#include "ipc/wire/robot_record.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {
namespace {

// A record has the room of at most this many of the smallest records.
constexpr int kMostPushedOut = 64;
constexpr Nanoseconds kBetweenRepairs{1'000'000'000};

}  // namespace

struct SensorQueueOutput::Impl {
  std::unique_ptr<OwnedQueue> queue;
  std::uint64_t sequence = 0;
  Timestamp repair_again;
  std::atomic<std::uint64_t> sent{0};
  std::atomic<std::uint64_t> dropped{0};
  std::atomic<std::uint64_t> refused{0};

  void send(std::span<const char> record, Timestamp time);
  bool make_room();
  bool repair(Timestamp time);
};

// Of the records only: what others put there with another type goes first where no record is left.
bool SensorQueueOutput::Impl::make_room() {
  if (queue->discard_oldest(kSensorMessageType) != QueueOutcome::done &&
      queue->discard_oldest(0) != QueueOutcome::done) {
    return false;
  }
  dropped.fetch_add(1, std::memory_order_relaxed);
  return true;
}

// At most once a second where it fails, since it looks at files.
bool SensorQueueOutput::Impl::repair(Timestamp time) {
  if (time < repair_again) return false;
  const std::uint64_t before = queue->recreated();
  const auto made = queue->recreate();
  if (!made) {
    repair_again = time + kBetweenRepairs;
    log_error("ipc.queue-lost", "{}", made.error().text());
    return false;
  }
  if (queue->recreated() != before) {
    log_warning("ipc.queue-removed", "the SENSOR queue {} was removed from outside and is made anew",
                key_text(queue->options().key));
  }
  return true;
}

void SensorQueueOutput::Impl::send(std::span<const char> record, Timestamp time) {
  bool repaired = false;
  for (int pushed_out = 0; pushed_out <= kMostPushedOut;) {
    const QueueOutcome outcome = queue->send_now(kSensorMessageType, record);
    if (outcome == QueueOutcome::done) {
      sent.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    if (outcome == QueueOutcome::full && make_room()) {
      ++pushed_out;
    } else if (outcome == QueueOutcome::gone && !repaired && repair(time)) {
      repaired = true;
    } else {
      break;
    }
  }
  refused.fetch_add(1, std::memory_order_relaxed);
}

Result<std::unique_ptr<SensorQueueOutput>> SensorQueueOutput::open(const QueueConfig& config,
                                                                   const std::string& instance) {
  auto queue = OwnedQueue::make({"SENSOR", config.sensor_key, config.mode, instance});
  if (!queue) return std::unexpected(queue.error());
  auto impl = std::make_unique<Impl>();
  impl->queue = std::move(*queue);
  return std::unique_ptr<SensorQueueOutput>(new SensorQueueOutput(std::move(impl)));
}

SensorQueueOutput::SensorQueueOutput(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SensorQueueOutput::~SensorQueueOutput() = default;

void SensorQueueOutput::publish(Timestamp time, std::span<const RobotState> robots,
                                std::span<const FramePose> /*frames*/) {
  std::array<std::byte, kMaxRobotRecordBytes> bytes;
  const std::int64_t wall_time_ns = robots.empty() ? 0 : to_wall_clock_ns(time);
  for (const RobotState& robot : robots) {
    RobotRecord record = robot_record_of(robot, time);
    record.header.sequence = ++impl_->sequence;
    record.header.wall_time_ns = wall_time_ns;
    const auto length = encode_robot_record(record, bytes);
    if (!length) {
      impl_->refused.fetch_add(1, std::memory_order_relaxed);
      log_error("ipc.record", "{}", length.error().text());
      continue;
    }
    impl_->send({reinterpret_cast<const char*>(bytes.data()), *length}, time);
  }
}

std::vector<std::pair<std::string, std::uint64_t>> SensorQueueOutput::counters() const {
  return {{"sent", impl_->sent.load(std::memory_order_relaxed)},
          {"dropped", impl_->dropped.load(std::memory_order_relaxed)},
          {"refused", impl_->refused.load(std::memory_order_relaxed)},
          {"recreated", impl_->queue->recreated()},
          {"discarded", impl_->queue->discarded()},
          {"waiting", impl_->queue->waiting()}};
}

std::string SensorQueueOutput::name() const { return "sensor queue " + key_text(impl_->queue->options().key); }

}  // namespace cellmirror
