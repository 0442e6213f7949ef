// The whole device: records from a queue of its own, drives on a bus in memory, virtual time.
#include "sim_devices/camera/camera_head.hpp"

#include <gtest/gtest.h>
#include <sys/ipc.h>
#include <sys/msg.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "drivers/can/channel/virtual_bus.hpp"
#include "sim_devices/robot/control_command.hpp"

namespace cellmirror::sim {
namespace {

constexpr Timestamp kStart{1'000'000'000};
constexpr Nanoseconds kMs{1'000'000};

struct Message {
  long type = kSensorMessageType;
  std::byte text[kMaxRecordBytes]{};
};

class CameraHeadTest : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    key_ = 0x63000000 + static_cast<int>(::getpid());
    make_queue();
    CameraHeadConfig config;
    config.camera = "C";
    config.key = key_;
    config.take = GetParam();
    config.drives.endpoint = "virtual";
    config.drives.nodes = {{21, 22}};
    config.drives.increments_per_unit = {1000.0};
    config.drives.self_starting = true;
    sut_ = std::make_unique<CameraHead>(config, bus_.connect());
    sut_->start(kStart);
    now_ = kStart;
  }
  void TearDown() override { ::msgctl(queue_, IPC_RMID, nullptr); }

  void make_queue() {
    queue_ = ::msgget(key_, IPC_CREAT | IPC_EXCL | 0600);
    ASSERT_GE(queue_, 0);
    sequence_ = 0;
  }
  void send(const char* camera, double pan, double tilt) {
    CameraRecord record;
    record.header.sequence = ++sequence_;
    record.id = camera;
    record.tracks = "Hand";
    record.tracking = true;
    record.pan = pan;
    record.tilt = tilt;
    Message message;
    const auto length = encode_camera_record(record, message.text);
    ASSERT_EQ(::msgsnd(queue_, &message, *length, IPC_NOWAIT), 0);
  }
  void run_ms(int ms) {
    for (int i = 0; i < ms; ++i) {
      now_ = now_ + kMs;
      sut_->work(now_);
    }
  }
  std::size_t waiting() const {
    msqid_ds state{};
    ::msgctl(queue_, IPC_STAT, &state);
    return state.msg_qnum;
  }
  std::uint64_t counted(const char* name) const {
    const auto status = sut_->status(now_);
    const auto found =
        std::ranges::find_if(status.details, [name](const auto& detail) { return detail.first == name; });
    return found == status.details.end() ? 0 : found->second;
  }
  // The newest position that drive `node` sent.
  std::int32_t position_of(std::uint32_t node) {
    std::int32_t position = -1;
    ReceivedCanFrame received;
    while (master_->receive(received, Nanoseconds(0)) == CanReceive::frame) {
      if (received.frame.id == 0x180 + node) std::memcpy(&position, received.frame.data.data() + 2, sizeof position);
    }
    return position;
  }

  int key_ = 0;
  int queue_ = -1;
  std::uint64_t sequence_ = 0;
  can::VirtualCanBus bus_{100'000};
  std::unique_ptr<CanChannel> master_ = bus_.connect();
  std::unique_ptr<CameraHead> sut_;
  Timestamp now_;
};

TEST_P(CameraHeadTest, FollowsTheNewestRecordAndItsDrivesTell) {
  send("C", -1, 0);
  send("C", 0.5, -0.25);
  run_ms(3000);
  EXPECT_EQ(position_of(21), 500);
  run_ms(20);
  EXPECT_EQ(position_of(22), -250);
  EXPECT_EQ(counted("followed"), 1U);
}

TEST_P(CameraHeadTest, LeavesRecordsOfOthersAlone) {
  send("other", 1, 1);
  Message junk;
  ASSERT_EQ(::msgsnd(queue_, &junk, 50, IPC_NOWAIT), 0);
  run_ms(500);
  EXPECT_EQ(sut_->head().axis(0).position(), 0);
  EXPECT_EQ(counted("records"), 0U);
  EXPECT_GE(counted("records_of_others"), 1U);
  EXPECT_GE(counted("records_malformed"), 1U);
  EXPECT_EQ(waiting(), GetParam() ? 0U : 2U) << "only --take takes them";
}

TEST_P(CameraHeadTest, AGatewayThatCameBackIsFollowedAgain) {
  send("C", 0.25, 0);
  run_ms(2000);
  ASSERT_EQ(::msgctl(queue_, IPC_RMID, nullptr), 0);
  run_ms(300);
  EXPECT_EQ(sut_->head().axis(0).position(), 0.25) << "it stays where it is";
  make_queue();
  send("C", -0.25, 0);  // sequence 1 again
  run_ms(2000);
  EXPECT_EQ(sut_->head().axis(0).position(), -0.25);
  EXPECT_EQ(counted("queue_attachments"), 2U);
}

TEST_P(CameraHeadTest, FaultsOfTheHeadAndOfItsDrivesCanBeOrdered) {
  const auto stuck = sut_->execute_own("fault stuck:joint=1", now_);
  ASSERT_TRUE(stuck && *stuck);
  EXPECT_EQ(**stuck, "fault 1001");
  EXPECT_FALSE(sut_->execute_own("fault jump:by=0.5,joint=2", now_)) << "of the drives";
  EXPECT_FALSE(sut_->execute_own("status", now_));
  EXPECT_FALSE(*sut_->execute_own("fault stuck:joint=7", now_));
  ASSERT_TRUE(sut_->execute(*parse_control_command("fault jump:by=0.5,joint=2"), now_));
  send("C", 0.5, 0.25);
  run_ms(2000);
  EXPECT_EQ(sut_->head().axis(0).position(), 0);
  EXPECT_EQ(position_of(22), 750) << "the drive is off by the jump";
  EXPECT_EQ(sut_->status(now_).faults.size(), 2U);
  ASSERT_TRUE(sut_->execute(*parse_control_command("clear"), now_));
  run_ms(2000);
  EXPECT_EQ(position_of(21), 500);
}

TEST_P(CameraHeadTest, HoldStopsIt) {
  ASSERT_TRUE(sut_->execute(*parse_control_command("hold"), now_));
  send("C", 0.5, 0);
  run_ms(500);
  EXPECT_EQ(sut_->head().axis(0).position(), 0);
  ASSERT_TRUE(sut_->execute(*parse_control_command("go"), now_));
  run_ms(2000);
  EXPECT_EQ(sut_->head().axis(0).position(), 0.5);
}

INSTANTIATE_TEST_SUITE_P(Reading, CameraHeadTest, ::testing::Values(false, true),
                         [](const auto& of) { return of.param ? "taking" : "looking"; });

}  // namespace
}  // namespace cellmirror::sim
