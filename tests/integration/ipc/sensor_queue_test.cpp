#include <gtest/gtest.h>
#include <sys/msg.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "ipc/sysv/sensor_queue_output.hpp"
#include "ipc/wire/barrier_record.hpp"
#include "ipc/wire/proximity_record.hpp"
#include "ipc/wire/range_record.hpp"
#include "ipc/wire/robot_record.hpp"
#include "ipc/wire/tissue_record.hpp"
#include "tests/integration/ipc/own_ipc.hpp"

namespace cellmirror {
namespace {

using test::own_queues;
using test::queue_exists;
using test::remove_queue;

RobotState robot_with(std::size_t joints, std::string id = "R1") {
  RobotState robot;
  robot.id = std::move(id);
  for (std::size_t i = 0; i < joints; ++i) {
    robot.joints.push_back({"J" + std::to_string(i), JointKind::revolute, 0.1, 0, 0, DataState::none, {}, {}});
  }
  return robot;
}

std::optional<std::vector<std::byte>> next_message(std::int32_t key) {
  struct {
    long type;
    std::byte text[8192];
  } message;
  const ssize_t got = ::msgrcv(::msgget(key, 0), &message, sizeof message.text, 5, IPC_NOWAIT);
  if (got < 0) return std::nullopt;
  return std::vector(message.text, message.text + got);
}

template <class Decode>
auto next_of(std::int32_t key, Decode decode) -> std::optional<typename decltype(decode({}))::value_type> {
  const auto message = next_message(key);
  if (!message) return std::nullopt;
  auto record = decode(*message);
  EXPECT_TRUE(record) << record.error().text();
  return record ? std::optional(*record) : std::nullopt;
}

std::optional<RobotRecord> next_record(std::int32_t key) { return next_of(key, decode_robot_record); }

std::map<std::string, std::uint64_t> counters_of(const SensorQueueOutput& output) {
  const auto counters = output.counters();
  return {counters.begin(), counters.end()};
}

class SensorQueue : public ::testing::Test {
 protected:
  void SetUp() override {
    auto opened = SensorQueueOutput::open(queues_, "test");
    ASSERT_TRUE(opened) << opened.error().text();
    sut_ = std::move(*opened);
  }
  QueueConfig queues_ = own_queues();
  std::unique_ptr<SensorQueueOutput> sut_;
};

TEST_F(SensorQueue, SendsOneRecordARobot) {
  const RobotState robots[] = {robot_with(6, "PUMA_762"), robot_with(0, "R2")};
  const Timestamp now = SystemClock().now();
  sut_->publish(now, robots, {});
  const auto first = next_record(queues_.sensor_key);
  const auto second = next_record(queues_.sensor_key);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->id, "PUMA_762");
  EXPECT_EQ(first->header.sequence, 1u);
  EXPECT_EQ(first->header.time_ns, now.ns);
  EXPECT_NEAR(static_cast<double>(first->header.wall_time_ns), static_cast<double>(to_wall_clock_ns(now)), 1e10);
  EXPECT_EQ(second->id, "R2");
  EXPECT_EQ(second->header.sequence, 2u);
  EXPECT_FALSE(next_record(queues_.sensor_key));
  EXPECT_EQ(counters_of(*sut_)["sent"], 2u);
}

TEST_F(SensorQueue, FullQueueLosesItsOldestRecordsAndNeverWaits) {
  const RobotState robots[] = {robot_with(16)};
  for (int i = 1; i <= 1000; ++i) sut_->publish(SystemClock().now(), robots, {});
  auto counters = counters_of(*sut_);
  EXPECT_EQ(counters["sent"], 1000u);
  EXPECT_EQ(counters["refused"], 0u);
  EXPECT_EQ(counters["dropped"] + counters["waiting"], 1000u);
  std::uint64_t newest = 0;
  std::uint64_t read = 0;
  while (const auto record = next_record(queues_.sensor_key)) {
    if (read++ > 0) {
      EXPECT_EQ(record->header.sequence, newest + 1);
    }
    newest = record->header.sequence;
  }
  EXPECT_EQ(newest, 1000u) << "what is left are the newest, in order";
  EXPECT_EQ(read, counters["waiting"]);
}

TEST_F(SensorQueue, WithoutAReaderNothingIsLost) {
  const RobotState robots[] = {robot_with(16)};
  const Timestamp now = SystemClock().now();
  for (int i = 0; i < 200; ++i) sut_->publish(now, robots, {});
  auto counters = counters_of(*sut_);
  EXPECT_GT(counters["dropped"], 0u);
  EXPECT_EQ(counters["unread"], counters["dropped"]);
}

// A process of its own takes records out, as a reader does; its own would count as ours.
std::uint64_t read_in_another_process(std::int32_t key, int count) {
  const pid_t child = ::fork();
  if (child == 0) {
    int got = 0;
    while (got < count && next_message(key)) ++got;
    ::_exit(got == count ? 0 : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  return status == 0 ? static_cast<std::uint64_t>(count) : 0;
}

TEST_F(SensorQueue, WhatAReaderMissesIsLostUntilItIsGone) {
  const RobotState robots[] = {robot_with(16)};
  const Timestamp now = SystemClock().now();
  for (int i = 0; i < 200; ++i) sut_->publish(now, robots, {});
  const auto before = counters_of(*sut_)["unread"];
  ASSERT_EQ(read_in_another_process(queues_.sensor_key, 3), 3u);
  for (int i = 0; i < 50; ++i) sut_->publish(now + std::chrono::seconds(1), robots, {});
  auto counters = counters_of(*sut_);
  EXPECT_EQ(counters["unread"], before) << "there is a reader, and it is too slow";
  EXPECT_GT(counters["dropped"], before);
  for (int i = 0; i < 50; ++i) sut_->publish(now + std::chrono::seconds(20), robots, {});
  EXPECT_EQ(counters_of(*sut_)["unread"], before + 50) << "it has not read for more than 10 s";
}

TEST_F(SensorQueue, MessagesOfOthersCannotFillItForGood) {
  struct {
    long type;
    char text[1];
  } message{9, {'x'}};
  while (::msgsnd(::msgget(queues_.sensor_key, 0), &message, 0, IPC_NOWAIT) == 0) {
  }
  const RobotState robots[] = {robot_with(1)};
  for (int i = 0; i < 400; ++i) sut_->publish(SystemClock().now(), robots, {});
  EXPECT_GT(counters_of(*sut_)["sent"], 0u);
}

TEST_F(SensorQueue, RemovedFromOutsideIsMadeAnew) {
  const RobotState robots[] = {robot_with(1)};
  sut_->publish(SystemClock().now(), robots, {});
  remove_queue(queues_.sensor_key);
  sut_->publish(SystemClock().now(), robots, {});
  const auto record = next_record(queues_.sensor_key);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->header.sequence, 2u);
  EXPECT_EQ(counters_of(*sut_)["recreated"], 1u);
  EXPECT_EQ(counters_of(*sut_)["refused"], 0u);
}

TEST_F(SensorQueue, TooManyJointsAreRefusedAndCounted) {
  const RobotState robots[] = {robot_with(17), robot_with(1, "R2")};
  sut_->publish(SystemClock().now(), robots, {});
  EXPECT_EQ(counters_of(*sut_)["refused"], 1u);
  const auto record = next_record(queues_.sensor_key);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->id, "R2") << "the others are sent";
}

std::vector<RangeReading> readings(int count, Timestamp time) {
  std::vector<RangeReading> made(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < made.size(); ++i) {
    made[i].id = "USS_" + std::to_string(i);
    made[i].posture_time = time;
    made[i].range_m = 3;
    if (i % 2 == 0) made[i].distance_m = 0.5;
  }
  return made;
}

TEST_F(SensorQueue, SendsOneRecordASensorOrOneForAll) {
  const Timestamp now = SystemClock().now();
  const auto sensors = readings(3, now);
  sut_->publish_ranges(sensors, RangeSendMode::one_message_a_sensor);
  for (const RangeReading& sensor : sensors) {
    const auto record = next_of(queues_.sensor_key, decode_range_record);
    ASSERT_TRUE(record);
    EXPECT_EQ(record->id, sensor.id);
    EXPECT_EQ(record->header.time_ns, now.ns);
  }
  sut_->publish_ranges(sensors, RangeSendMode::one_message_for_all);
  const auto all = next_of(queues_.sensor_key, decode_range_array);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->header.sequence, 4U);
  EXPECT_EQ(all->ranges.size(), 3U);
  EXPECT_FALSE(next_message(queues_.sensor_key));
  EXPECT_EQ(counters_of(*sut_)["ranges_sent"], 4U);
  sut_->publish_ranges({}, RangeSendMode::one_message_for_all);
  EXPECT_FALSE(next_message(queues_.sensor_key)) << "no sensor is active";
}

TEST_F(SensorQueue, SensorsThatDoNotFitInOneRecordGoInParts) {
  sut_->publish_ranges(readings(100, SystemClock().now()), RangeSendMode::one_message_for_all);
  const auto first = next_of(queues_.sensor_key, decode_range_array);
  const auto second = next_of(queues_.sensor_key, decode_range_array);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->ranges.size() + second->ranges.size(), 100U);
  EXPECT_EQ(first->header.wall_time_ns, second->header.wall_time_ns) << "one instant";
}

TEST_F(SensorQueue, AReadingThatIsNotFiniteIsRefusedAndTheOthersAreSent) {
  auto sensors = readings(3, SystemClock().now());
  sensors[0].distance_m = std::numeric_limits<double>::infinity();
  sensors[2].point_m.x() = std::numeric_limits<double>::quiet_NaN();
  sut_->publish_ranges(sensors, RangeSendMode::one_message_a_sensor);
  EXPECT_EQ(next_of(queues_.sensor_key, decode_range_record)->id, "USS_1");
  EXPECT_FALSE(next_message(queues_.sensor_key));
  EXPECT_EQ(counters_of(*sut_)["ranges_refused"], 2U);
}

ProximityState touching_state(std::uint64_t check, std::vector<ProximityEvent> events) {
  ProximityState state;
  state.posture_time = state.finished = SystemClock().now();
  state.sequence = check;
  state.names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"w.A", "w.B"});
  state.touching.resize(1);
  state.touching[0].b = 1;
  state.events = std::move(events);
  return state;
}

TEST_F(SensorQueue, EventsGoOnceAndTheStateWhenItIsDue) {
  const Timestamp seen = SystemClock().now();
  const auto state = touching_state(5, {{1, ProximityChange::entered_warning, "w.A", "w.B", 0.04, seen},
                                        {2, ProximityChange::touched, "w.A", "w.B", 0, seen}});
  sut_->publish_proximity(state);
  sut_->publish_proximity(state);
  EXPECT_EQ(next_of(queues_.sensor_key, decode_event_record)->change, ProximityChange::entered_warning);
  EXPECT_EQ(next_of(queues_.sensor_key, decode_event_record)->event, 2U);
  const auto record = next_of(queues_.sensor_key, decode_proximity_record);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->check, 5U);
  EXPECT_EQ(record->pairs.at(0).b, "w.B");
  EXPECT_FALSE(next_message(queues_.sensor_key)) << "nothing is sent twice";

  sut_->publish_proximity(touching_state(6, {{6, ProximityChange::parted, "w.A", "w.B", 0, seen}}));
  EXPECT_EQ(next_of(queues_.sensor_key, decode_event_record)->event, 6U);
  EXPECT_EQ(counters_of(*sut_)["events_missing"], 3U) << "3, 4 and 5 were never given to this output";
  sut_->publish_proximity(touching_state(1, {{1, ProximityChange::touched, "w.A", "w.B", 0, seen}}));
  EXPECT_EQ(next_of(queues_.sensor_key, decode_event_record)->event, 1U) << "a new checker counts anew";
  EXPECT_EQ(counters_of(*sut_)["events_sent"], 4U);
}

TEST_F(SensorQueue, EventsThatFindNoRoomLeaveAGapInTheirNumbers) {
  std::vector<ProximityEvent> events;
  for (std::uint64_t i = 1; i <= 500; ++i) {
    events.push_back({i, ProximityChange::touched, "w.A", "w.B", 0, SystemClock().now()});
  }
  sut_->publish_proximity(touching_state(1, events));
  const auto first = next_of(queues_.sensor_key, decode_event_record);
  ASSERT_TRUE(first);
  EXPECT_GT(first->event, 1U);
  EXPECT_EQ(first->header.sequence, first->event);
  EXPECT_EQ(counters_of(*sut_)["dropped"], first->event - 1);
}

BarrierReading barrier(const char* name, Timestamp time, std::uint64_t interruptions) {
  BarrierReading reading;
  reading.name = name;
  reading.posture_time = time;
  reading.interruptions = interruptions;
  return reading;
}

TEST_F(SensorQueue, LightBarriersGoWhenTheyChangeAndOnceASecond) {
  const Timestamp start = SystemClock().now();
  sut_->publish_barriers(std::array{barrier("gate", start, 0), barrier("door", start, 0)});
  EXPECT_EQ(next_of(queues_.sensor_key, decode_barrier_record)->id, "gate");
  EXPECT_EQ(next_of(queues_.sensor_key, decode_barrier_record)->id, "door");
  const Timestamp later = start + Nanoseconds(20'000'000);
  sut_->publish_barriers(std::array{barrier("gate", later, 0), barrier("door", later, 1)});
  const auto changed = next_of(queues_.sensor_key, decode_barrier_record);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->id, "door") << "an interruption between two records";
  EXPECT_EQ(changed->interruptions, 1U);
  EXPECT_FALSE(changed->interrupted);
  const Timestamp again = start + Nanoseconds(1'010'000'000);
  sut_->publish_barriers(std::array{barrier("gate", again, 0), barrier("door", again, 1)});
  EXPECT_EQ(next_of(queues_.sensor_key, decode_barrier_record)->id, "gate");
  EXPECT_EQ(counters_of(*sut_)["barriers_sent"], 4U);
  EXPECT_EQ(counters_of(*sut_)["waiting"], 0U);
}

NamedTissueEvent tissue_event(std::uint64_t number) {
  TissueEvent event;
  event.number = number;
  event.time = SystemClock().now();
  event.kind = TissueEventKind::grip;
  return {event, "GRASPER", "liver"};
}

TEST_F(SensorQueue, TissueEventsGoAtOnceAndThoseMissingAreCounted) {
  sut_->publish_tissue_events(std::array{tissue_event(1), tissue_event(2)});
  EXPECT_EQ(next_of(queues_.sensor_key, decode_tissue_record)->event, 1U);
  const auto second = next_of(queues_.sensor_key, decode_tissue_record);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->event, 2U);
  EXPECT_EQ(second->robot, "GRASPER");
  EXPECT_EQ(second->object, "liver");
  sut_->publish_tissue_events(std::array{tissue_event(6)});
  EXPECT_EQ(next_of(queues_.sensor_key, decode_tissue_record)->event, 6U);
  EXPECT_EQ(counters_of(*sut_)["tissue_events_missing"], 3U) << "3, 4 and 5 were never given to this output";
  auto wild = tissue_event(7);
  wild.event.at.y() = std::numeric_limits<double>::quiet_NaN();
  sut_->publish_tissue_events(std::array{wild, tissue_event(1)});
  EXPECT_EQ(next_of(queues_.sensor_key, decode_tissue_record)->event, 1U) << "a new simulation counts anew";
  EXPECT_EQ(counters_of(*sut_)["tissue_events_refused"], 1U);
  EXPECT_EQ(counters_of(*sut_)["tissue_events_sent"], 4U);
  EXPECT_EQ(counters_of(*sut_)["tissue_events_missing"], 3U);
}

TEST_F(SensorQueue, IsRemovedAtTheEnd) {
  EXPECT_TRUE(sut_->name().starts_with("sensor queue 0x71"));
  sut_.reset();
  EXPECT_FALSE(queue_exists(queues_.sensor_key));
}

}  // namespace
}  // namespace cellmirror
