#include "ipc/sysv/sensor_queue_output.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "ipc/sysv/owned_queue.hpp"
#include "ipc/sysv/proximity_pacing.hpp"
#include "ipc/wire/barrier_record.hpp"
#include "ipc/wire/camera_record.hpp"
#include "ipc/wire/proximity_record.hpp"
#include "ipc/wire/range_record.hpp"
#include "ipc/wire/robot_record.hpp"
#include "ipc/wire/tissue_record.hpp"
#include "rt_core/base/log.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {
namespace {

// A record has the room of at most this many of the smallest records.
constexpr int kMostPushedOut = 64;
constexpr Nanoseconds kBetweenRepairs{1'000'000'000};
// A program that has taken nothing out for so long is no reader any more.
constexpr Nanoseconds kReaderGone{10'000'000'000};
// More sensors than a cell has; a part's numbers are 16 bits wide.
constexpr std::size_t kMostReadings = 4096;
// After so long a light barrier is reported again, though nothing has changed.
constexpr Nanoseconds kBarrierAgain{1'000'000'000};

// Of one kind of record. Relaxed: counters for people, each on its own.
struct Count {
  std::atomic<std::uint64_t> value{0};
  void add(std::uint64_t n = 1) { value.fetch_add(n, std::memory_order_relaxed); }
  [[nodiscard]] std::uint64_t get() const { return value.load(std::memory_order_relaxed); }
};
struct SentAndRefused {
  Count sent;
  Count refused;
};

// Nothing in the cone is a reading, too.
bool has_finite_values(const RangeReading& reading) {
  return !reading.distance_m || (std::isfinite(*reading.distance_m) && reading.point_m.allFinite());
}

bool is_news(const BarrierReading& before, const BarrierReading& now) {
  const Nanoseconds since = now.posture_time - before.posture_time;
  return before.interrupted != now.interrupted || before.interruptions != now.interruptions ||
         before.doubtful != now.doubtful || before.object != now.object || since >= kBarrierAgain ||
         since < Nanoseconds(0);
}

bool has_finite_values(const CameraState& camera) {
  return camera.X_WC.matrix().allFinite() && camera.X_WM.matrix().allFinite() && std::isfinite(camera.pan_rad) &&
         std::isfinite(camera.tilt_rad) && std::isfinite(camera.focal_distance_m) && std::isfinite(camera.fovy_rad);
}

}  // namespace

struct SensorQueueOutput::Impl {
  std::unique_ptr<OwnedQueue> queue;
  std::array<std::byte, kMaxRecordBytes> bytes;  // of the record in work
  std::uint64_t sequence = 0;
  Timestamp repair_again;
  Timestamp look_again;
  Timestamp instant;  // of the record before, and what the wall clock showed then
  std::int64_t instant_wall_ns = 0;
  ProximityPacing pacing;
  std::uint64_t last_check = 0;  // number of the state whose events were sent last
  std::uint64_t last_event = 0;
  std::vector<RangeReading> finite;      // reused
  std::vector<BarrierReading> reported;  // light barriers as they were sent last
  Timestamp read_at;                     // when another program was last seen to read
  Count dropped;
  Count unread;  // of these, those that nobody was there to read
  Count events_missing;
  std::uint64_t last_tissue_event = 0;
  Count tissue_events_missing;
  SentAndRefused robots;
  SentAndRefused ranges;
  SentAndRefused proximity;
  SentAndRefused events;
  SentAndRefused cameras;
  SentAndRefused barriers;
  SentAndRefused tissue_events;

  template <class Record, class Encode>
  void send(Record record, Timestamp time, Encode encode, SentAndRefused& counters);
  void send_events(const ProximityState& state);
  bool deliver(std::span<const std::byte> record, Timestamp time);
  bool make_room(Timestamp time);
  bool repair(Timestamp time);
  [[nodiscard]] std::array<const SentAndRefused*, 7> kinds() const {
    return {&robots, &ranges, &proximity, &events, &cameras, &barriers, &tissue_events};
  }
};

// Of the records only: what others put there with another type goes first where no record is left.
bool SensorQueueOutput::Impl::make_room(Timestamp time) {
  if (queue->last_read_by_another()) read_at = time;
  if (queue->discard_oldest(kSensorMessageType) != QueueOutcome::done &&
      queue->discard_oldest(0) != QueueOutcome::done) {
    return false;
  }
  dropped.add();
  if (!read_at.known() || time - read_at > kReaderGone) unread.add();
  return true;
}

// At most once a second on failure, since it accesses files.
bool SensorQueueOutput::Impl::repair(Timestamp time) {
  if (time < repair_again) return false;
  const std::uint64_t before = queue->recreated();
  const std::string problem_before = queue->problem();
  const auto made = queue->recreate();
  if (!made) {
    repair_again = time + kBetweenRepairs;
    if (made.error().text() != problem_before)
      log_error("ipc.queue-lost", "{}; it is tried again until it succeeds", made.error().text());
    return false;
  }
  if (queue->recreated() != before) {
    log_warning("ipc.queue-removed", "the SENSOR queue {} was removed by another program and is recreated",
                key_text(queue->options().key));
  }
  return true;
}

// `time`: of the record. False where it found no room.
bool SensorQueueOutput::Impl::deliver(std::span<const std::byte> record, Timestamp time) {
  const std::span text(reinterpret_cast<const char*>(record.data()), record.size());
  bool repaired = false;
  for (int pushed_out = 0; pushed_out <= kMostPushedOut;) {
    const QueueOutcome outcome = queue->send_now(kSensorMessageType, text);
    if (outcome == QueueOutcome::done) return true;
    if (outcome == QueueOutcome::full && make_room(time)) {
      ++pushed_out;
    } else if (outcome == QueueOutcome::gone && !repaired && repair(time)) {
      repaired = true;
    } else {
      return false;
    }
  }
  return false;
}

template <class Record, class Encode>
void SensorQueueOutput::Impl::send(Record record, Timestamp time, Encode encode, SentAndRefused& counters) {
  record.header.sequence = ++sequence;
  // Once for all records of an instant, so that they agree to the nanosecond.
  if (time != instant) instant_wall_ns = to_wall_clock_ns(time);
  instant = time;
  record.header.wall_time_ns = instant_wall_ns;
  const auto length = encode(record, bytes);
  if (!length) log_error("ipc.record", "{}", length.error().text());
  const bool sent = length && deliver(std::span(bytes).first(*length), time);
  (sent ? counters.sent : counters.refused).add();
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
  for (const RobotState& robot : robots) {
    impl_->send(robot_record_of(robot, time), time, encode_robot_record, impl_->robots);
  }
}

void SensorQueueOutput::publish_ranges(std::span<const RangeReading> readings, RangeSendMode mode) {
  std::vector<RangeReading>& finite = impl_->finite;
  finite.clear();
  std::copy_if(readings.begin(), readings.end(), std::back_inserter(finite),
               [](const RangeReading& reading) { return has_finite_values(reading); });
  if (finite.size() > kMostReadings) finite.resize(kMostReadings);
  impl_->ranges.refused.add(readings.size() - finite.size());
  if (mode == RangeSendMode::one_message_a_sensor) {
    for (const RangeReading& reading : finite) {
      impl_->send(range_record_of(reading), reading.posture_time, encode_range_record, impl_->ranges);
    }
    return;
  }
  for (const RangeArrayRecord& part : range_arrays_of(finite)) {
    impl_->send(part, finite.front().posture_time, encode_range_array, impl_->ranges);
  }
}

void SensorQueueOutput::publish_barriers(std::span<const BarrierReading> barriers) {
  std::vector<BarrierReading>& reported = impl_->reported;
  const bool anew = reported.size() != barriers.size();
  if (anew) reported.assign(barriers.begin(), barriers.end());
  for (std::size_t i = 0; i < barriers.size(); ++i) {
    if (!anew && !is_news(reported[i], barriers[i])) continue;
    reported[i] = barriers[i];
    impl_->send(barrier_record_of(barriers[i]), barriers[i].posture_time, encode_barrier_record, impl_->barriers);
  }
}

// Restarted numbers are those of a new checker; nothing is skipped then.
void SensorQueueOutput::Impl::send_events(const ProximityState& state) {
  if (state.sequence == last_check) return;
  last_check = state.sequence;
  for (const ProximityEvent& event : state.events) {
    if (event.sequence > last_event) events_missing.add(event.sequence - last_event - 1);
    last_event = event.sequence;
    send(event_record_of(event), event.posture_time, encode_event_record, events);
  }
}

void SensorQueueOutput::publish_proximity(const ProximityState& state) {
  impl_->send_events(state);
  ProximityRecord record = proximity_record_of(state);
  if (!impl_->pacing.is_due(record)) return;
  impl_->send(std::move(record), state.posture_time, encode_proximity_record, impl_->proximity);
}

void SensorQueueOutput::publish_cameras(Timestamp time, std::span<const CameraState> cameras) {
  for (const CameraState& camera : cameras) {
    if (has_finite_values(camera)) {
      impl_->send(camera_record_of(camera, time), time, encode_camera_record, impl_->cameras);
    } else {
      impl_->cameras.refused.add();
    }
  }
}

// Restarted numbers are those of a new simulation; nothing is missing then.
void SensorQueueOutput::publish_tissue_events(std::span<const NamedTissueEvent> events) {
  for (const NamedTissueEvent& event : events) {
    const std::uint64_t number = event.event.number;
    if (number > impl_->last_tissue_event) impl_->tissue_events_missing.add(number - impl_->last_tissue_event - 1);
    impl_->last_tissue_event = number;
    if (event.event.at.allFinite() && std::isfinite(event.event.value)) {
      impl_->send(tissue_record_of(event), event.event.time, encode_tissue_record, impl_->tissue_events);
    } else {
      impl_->tissue_events.refused.add();
    }
  }
}

std::vector<std::pair<std::string, std::uint64_t>> SensorQueueOutput::counters() const {
  std::uint64_t sent = 0;
  std::uint64_t refused = 0;
  for (const SentAndRefused* kind : impl_->kinds()) {
    sent += kind->sent.get();
    refused += kind->refused.get();
  }
  return {{"sent", sent},
          {"dropped", impl_->dropped.get()},
          {"unread", impl_->unread.get()},
          {"refused", refused},
          {"ranges_sent", impl_->ranges.sent.get()},
          {"ranges_refused", impl_->ranges.refused.get()},
          {"barriers_sent", impl_->barriers.sent.get()},
          {"barriers_refused", impl_->barriers.refused.get()},
          {"proximity_sent", impl_->proximity.sent.get()},
          {"proximity_refused", impl_->proximity.refused.get()},
          {"events_sent", impl_->events.sent.get()},
          {"events_refused", impl_->events.refused.get()},
          {"events_missing", impl_->events_missing.get()},
          {"cameras_sent", impl_->cameras.sent.get()},
          {"cameras_refused", impl_->cameras.refused.get()},
          {"tissue_events_sent", impl_->tissue_events.sent.get()},
          {"tissue_events_refused", impl_->tissue_events.refused.get()},
          {"tissue_events_missing", impl_->tissue_events_missing.get()},
          {"recreated", impl_->queue->recreated()},
          {"discarded", impl_->queue->discarded()},
          {"waiting", impl_->queue->waiting()}};
}

std::string SensorQueueOutput::problem() const { return impl_->queue->problem(); }

void SensorQueueOutput::keep(Timestamp now) {
  if (now < impl_->look_again) return;
  impl_->look_again = now + kBetweenRepairs;
  impl_->repair(now);
}

std::string SensorQueueOutput::name() const { return "sensor queue " + key_text(impl_->queue->options().key); }

}  // namespace cellmirror
