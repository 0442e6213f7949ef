#include <gtest/gtest.h>
#include <sys/msg.h>

#include <map>
#include <optional>
#include <vector>

#include "ipc/sysv/sensor_queue_output.hpp"
#include "ipc/wire/robot_record.hpp"
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

std::optional<RobotRecord> next_record(std::int32_t key) {
  struct {
    long type;
    std::byte text[8192];
  } message;
  const ssize_t got = ::msgrcv(::msgget(key, 0), &message, sizeof message.text, 5, IPC_NOWAIT);
  if (got < 0) return std::nullopt;
  auto record = decode_robot_record(std::span(message.text).first(static_cast<std::size_t>(got)));
  EXPECT_TRUE(record) << record.error().text();
  return record ? std::optional(*record) : std::nullopt;
}

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
  EXPECT_NEAR(static_cast<double>(first->header.wall_time_ns), static_cast<double>(to_wall_clock_ns(now)), 1e9);
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

TEST_F(SensorQueue, IsRemovedAtTheEnd) {
  EXPECT_TRUE(sut_->name().starts_with("sensor queue 0x71"));
  sut_.reset();
  EXPECT_FALSE(queue_exists(queues_.sensor_key));
}

}  // namespace
}  // namespace cellmirror
