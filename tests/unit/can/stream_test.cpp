// Streams with their threads on the virtual bus: what they survive, and what they say about it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <thread>

#include "drivers/can/channel/virtual_bus.hpp"
#include "drivers/can/cia402/drive.hpp"
#include "drivers/can/stream/streams.hpp"
#include "tests/unit/can/frames.hpp"
#include "tests/unit/can/test_data.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

struct Sink : JointSampleSink {
  bool push(const JointSample& sample) noexcept override {
    const std::lock_guard lock(mutex);
    last = sample;
    ++count;
    return true;
  }
  JointSample newest() {
    const std::lock_guard lock(mutex);
    return last;
  }
  std::mutex mutex;
  JointSample last;
  std::atomic<int> count{0};
};

// A drive with a thread on the bus.
class LiveDrive : Cia402DriveOutput {
 public:
  LiveDrive(VirtualCanBus& bus, const Cia402DriveConfig& config) : channel_(bus.connect()), drive_(config, *this) {
    thread_ = std::thread([this] { run(); });
  }
  ~LiveDrive() override {
    stop_ = true;
    thread_.join();
  }
  void with(const std::function<void(Cia402Drive&, Timestamp)>& action) {
    const std::lock_guard lock(mutex_);
    action(drive_, clock_.now());
  }

 private:
  void send(const CanFrame& frame) override { channel_->send(frame); }
  void run() {
    while (!stop_) {
      ReceivedCanFrame got;
      const CanReceive received = channel_->receive(got, 1ms);
      const std::lock_guard lock(mutex_);
      if (received == CanReceive::frame) drive_.receive(got.frame, got.receive_time);
      drive_.advance(clock_.now());
    }
  }

  std::unique_ptr<CanChannel> channel_;
  SystemClock clock_;
  std::mutex mutex_;
  Cia402Drive drive_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

template <class Condition>
bool becomes_true(Condition condition) {
  for (int i = 0; i < 5000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

struct StreamTest : testing::Test {
  StreamTest() {
    Cia402NodeConfig node;
    node.node_id = 3;
    node.joint_name = "J_1";
    node.scale = 0.001;
    config.channel.endpoint = "virtual";
    config.nodes = {node};
    config.sync_period = 5ms;
    config.heartbeat_timeout = 300ms;
    drive_config.node_id = 3;
    drive_config.heartbeat_ms = 20;
    options.open_channel = [this](const CanChannelConfig&) {
      return Result<std::unique_ptr<CanChannel>>(bus.connect());
    };
  }
  void open() {
    auto made = make_cia402_stream(config, clock, options);
    ASSERT_TRUE(made) << made.error().text();
    sut = std::move(*made);
    ASSERT_TRUE(sut->open(sink));
  }
  bool condition_becomes(const std::string& part) {
    const bool came = becomes_true([&] { return sut->status().condition.find(part) != std::string::npos; });
    EXPECT_TRUE(came) << sut->status().condition << " instead of " << part;
    return came;
  }
  bool has_detail(const std::string& part) {
    for (const auto& [name, text] : sut->status().details) {
      if (text.find(part) != std::string::npos) return true;
    }
    return false;
  }
  bool samples_flow() {
    const int before = sink.count;
    return becomes_true([&] { return sink.count >= before + 3; });
  }

  VirtualCanBus bus;
  SystemClock clock;
  Sink sink;
  Cia402StreamConfig config;
  Cia402DriveConfig drive_config;
  CanStreamOptions options;
  std::unique_ptr<JointStream> sut;
};

TEST_F(StreamTest, MirrorsADriveFromBootUpToClose) {
  LiveDrive drive(bus, drive_config);
  open();
  EXPECT_THAT(sut->status().condition, HasSubstr("node 3 (J_1): not heard yet"));
  drive.with([](Cia402Drive& d, Timestamp now) {
    d.power_on(now);
    d.set_actual(1500, 0, 0, now);
  });
  ASSERT_TRUE(samples_flow());
  EXPECT_DOUBLE_EQ(sink.newest().position[0], 1.5);
  EXPECT_TRUE(condition_becomes("operational"));
  const JointStreamStatus status = sut->status();
  EXPECT_EQ(status.kind, "can-cia402");
  EXPECT_TRUE(status.open);
  EXPECT_GT(status.received, 0U);
  sut->close();
  const int after_close = sink.count;
  std::this_thread::sleep_for(30ms);
  EXPECT_EQ(sink.count, after_close);
  EXPECT_FALSE(sut->status().open);
  EXPECT_EQ(sut->status().condition, "closed");
  ASSERT_TRUE(sut->open(sink)) << "a stream opens again";
  EXPECT_TRUE(samples_flow());
}

TEST_F(StreamTest, SurvivesBusOff) {
  LiveDrive drive(bus, drive_config);
  drive.with([](Cia402Drive& d, Timestamp now) { d.power_on(now); });
  open();
  ASSERT_TRUE(samples_flow());
  bus.set_state(CanBusState::bus_off);
  EXPECT_TRUE(condition_becomes("bus-off: waiting for the bus"));
  bus.set_state(CanBusState::active);
  EXPECT_TRUE(samples_flow());
  EXPECT_TRUE(condition_becomes("operational"));
  EXPECT_TRUE(becomes_true([&] {
    for (const std::string& text : sut->status().last_errors) {
      if (text.find("bus: bus-off") != std::string::npos) return true;
    }
    return false;
  }));
}

TEST_F(StreamTest, SurvivesAnInterfaceThatGoesDown) {
  LiveDrive drive(bus, drive_config);
  drive.with([](Cia402Drive& d, Timestamp now) { d.power_on(now); });
  open();
  ASSERT_TRUE(samples_flow());
  bus.set_state(CanBusState::down);
  EXPECT_TRUE(becomes_true([&] { return sut->status().condition != "operational"; }));
  bus.set_state(CanBusState::active);
  EXPECT_TRUE(samples_flow());
}

TEST_F(StreamTest, SurvivesADriveThatDiesAndReturns) {
  LiveDrive drive(bus, drive_config);
  drive.with([](Cia402Drive& d, Timestamp now) { d.power_on(now); });
  open();
  ASSERT_TRUE(samples_flow());
  ASSERT_TRUE(becomes_true([&] { return has_detail("operational"); })) << "its heartbeat was heard";
  drive.with([](Cia402Drive& d, Timestamp) { d.power_off(); });
  EXPECT_TRUE(condition_becomes("no heartbeat since"));
  EXPECT_GT(sut->status().lost, 0U);
  drive.with([](Cia402Drive& d, Timestamp now) { d.power_on(now); });
  EXPECT_TRUE(samples_flow());
  EXPECT_TRUE(condition_becomes("operational"));
}

TEST_F(StreamTest, CountsLossCorruptionAndEmcy) {
  LiveDrive drive(bus, drive_config);
  drive.with([](Cia402Drive& d, Timestamp now) { d.power_on(now); });
  open();
  ASSERT_TRUE(samples_flow());
  std::atomic<int> tpdos{0};
  bus.set_filter([&](const CanFrame& f) -> std::vector<CanFrame> {
    if (f.id != 0x183) return {f};
    const int n = ++tpdos;
    if (n % 4 == 1) return {};  // lost
    CanFrame corrupt = f;
    corrupt.length = 3;
    return n % 4 == 2 ? std::vector<CanFrame>{corrupt, f} : std::vector<CanFrame>{f};
  });
  EXPECT_TRUE(becomes_true([&] { return sut->status().lost >= 2 && sut->status().rejected >= 2; }));
  drive.with([](Cia402Drive& d, Timestamp now) { d.raise_fault(0x7121, 0x81, now); });
  EXPECT_TRUE(condition_becomes("fault"));
  const auto details = sut->status().details;
  EXPECT_THAT(details,
              testing::Contains(testing::Pair("last EMCY of node 3", "node 3 0x7121 motor blocked, register 0x81")));
}

TEST_F(StreamTest, ErrorFramesShowInTheStatus) {
  open();
  bus.inject_error(CAN_ERR_ACK);
  EXPECT_TRUE(becomes_true([&] { return has_detail("no acknowledgement"); }));
}

// A bus with a clock of its own. Nodes 3 and 4 answer each SYNC after 1 ms and send heartbeats; the stream is on time
// but after its third SYNC, when it comes back only after the stall, to all that arrived meanwhile.
struct StallingBus {
  static constexpr int kSyncs = 5;

  struct StreamClock final : Clock {
    [[nodiscard]] Timestamp now() const CELL_RT override { return {ns}; }
    std::atomic<std::int64_t> ns{1'000'000'000};
  };

  class Channel final : public CanChannel {
   public:
    explicit Channel(StallingBus& bus) : bus_(&bus) {}

    CanReceive receive(ReceivedCanFrame& got, Nanoseconds timeout) override {
      if (!arriving_.empty()) {
        got = arriving_.front();
        arriving_.pop_front();
        bus_->clock.ns = std::max({bus_->clock.ns.load(), got.receive_time.ns, back_.ns});
        return CanReceive::frame;
      }
      if (syncs_ == kSyncs) {
        bus_->finished = true;
        std::this_thread::sleep_for(1ms);
        return CanReceive::timeout;
      }
      bus_->clock.ns += timeout.count();
      return CanReceive::timeout;
    }

    bool send(const CanFrame& sent) override {
      if (sent.id != 0x080) return true;
      const Timestamp sync = bus_->clock.now();
      answer(sync + 1ms, 0x180, {0x37, 0x02, 1, 0, 0, 0});
      if (++syncs_ != 3) return true;
      back_ = sync + bus_->stall;
      for (Timestamp t = sync + 100ms; t < back_; t = t + 100ms) answer(t, 0x700, {0x05});
      return true;
    }

    [[nodiscard]] const CanChannelStatus& status() const override { return status_; }

   private:
    void answer(Timestamp time, std::uint32_t base, std::initializer_list<int> bytes) {
      for (const std::uint32_t node : {3U, 4U}) arriving_.push_back({frame(base + node, bytes), time});
    }

    StallingBus* bus_;
    std::deque<ReceivedCanFrame> arriving_;
    Timestamp back_;
    int syncs_ = 0;
    CanChannelStatus status_;
  };

  StreamClock clock;
  Nanoseconds stall{0};
  std::atomic<bool> finished{false};
};

struct StallTest : StreamTest {
  JointStreamStatus status_after(Nanoseconds stall) {
    stalling.stall = stall;
    config.nodes.push_back(config.nodes[0]);
    config.nodes[1].node_id = 4;
    config.nodes[1].joint = 1;
    config.nodes[1].joint_name = "J_2";
    options.open_channel = [this](const CanChannelConfig&) {
      return Result<std::unique_ptr<CanChannel>>(std::make_unique<StallingBus::Channel>(stalling));
    };
    const auto made = make_cia402_stream(config, stalling.clock, options);
    if (!made || !(*made)->open(sink)) return {};
    EXPECT_TRUE(becomes_true([&] { return stalling.finished.load(); }));
    return (*made)->status();
  }
  StallingBus stalling;
};

TEST_F(StallTest, AnswersThatCameInTimeBelongToTheirCycleThoughTheStreamIsLate) {
  const JointStreamStatus status = status_after(6ms);
  EXPECT_EQ(status.lost, 0U);
  EXPECT_THAT(status.last_errors, testing::IsEmpty());
  EXPECT_EQ(status.received, 2U + StallingBus::kSyncs - 1U) << "one a cycle, two of the first, which waits for nobody";
  EXPECT_EQ(sink.newest().present, 3U);
}

TEST_F(StallTest, HeartbeatsThatCameInTimeCountThoughTheStreamIsLate) {
  const JointStreamStatus status = status_after(450ms);
  EXPECT_THAT(status.last_errors, testing::IsEmpty());
  EXPECT_EQ(status.condition, "operational");
}

TEST_F(StreamTest, AChannelThatCannotBeOpenedIsAnError) {
  options.open_channel = {};
  config.channel.endpoint = "log:/does/not/exist.log";
  auto made = make_cia402_stream(config, clock, options);
  ASSERT_TRUE(made);
  EXPECT_FALSE((*made)->open(sink));
  EXPECT_FALSE((*made)->status().open);
}

TEST_F(StreamTest, AWrongConfigurationIsRefusedWithAllMistakes) {
  config.nodes[0].scale = -1;
  config.nodes[0].sign = 0;
  const auto made = make_cia402_stream(config, clock, options);
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().what, HasSubstr("the scale has to be positive"));
  EXPECT_THAT(made.error().what, HasSubstr("the sign is 1 or -1"));
}

class DbcStream : public testing::Test {
 protected:
  // The position of the first joint, from axes.dbc.
  void open(const std::string& message, double scale) {
    DbcStreamConfig config;
    config.dbc_file = can_data("axes.dbc");
    config.signals = {{message, "Position", 0, "J_1", JointQuantity::position, scale, 0.0}};
    CanStreamOptions options;
    options.open_channel = [this](const CanChannelConfig&) {
      return Result<std::unique_ptr<CanChannel>>(bus.connect());
    };
    auto made = make_dbc_stream(config, clock, options);
    ASSERT_TRUE(made) << made.error().text();
    sut = std::move(*made);
    ASSERT_TRUE(sut->open(sink));
  }

  VirtualCanBus bus;
  std::unique_ptr<CanChannel> robot = bus.connect();
  SystemClock clock;
  Sink sink;
  std::unique_ptr<JointStream> sut;
};

TEST_F(DbcStream, MirrorsSignals) {
  ASSERT_NO_FATAL_FAILURE(open("Axis_3", 1.0));
  EXPECT_THAT(sut->status().condition, HasSubstr("no frame of the DBC's messages"));
  robot->send(frame(0x101, {0, 0, 0}));
  CanFrame good = frame(0x101, {0, 0, 0, 0, 0, 0, 0xF8, 0x3F, 0, 0, 0, 0});
  good.fd = true;
  robot->send(good);
  ASSERT_TRUE(becomes_true([&] { return sink.count == 1; }));
  EXPECT_DOUBLE_EQ(sink.newest().position[0], 1.5);
  EXPECT_EQ(sut->status().rejected, 1U);
  EXPECT_EQ(sut->status().kind, "can-dbc");
}

TEST(StreamCheck, LeavesOutWhatTheReaderOfTheCellFileRefused) {
  DbcStreamConfig dbc;
  dbc.dbc_file = can_data("axes.dbc");
  dbc.signals = {{"", "Position", 0, "J_1", JointQuantity::position, 1.0, 0.0},
                 {"Axis_3", "Angle", 1, "J_2", JointQuantity::position, 1.0, 0.0}};
  Diagnostics found;
  check_stream(dbc, found);
  EXPECT_EQ(found.errors(), 1U) << found.text();
  EXPECT_THAT(found.text(), HasSubstr("the message Axis_3 has no signal Angle"));
  dbc.dbc_file.clear();
  found = {};
  check_stream(dbc, found);
  EXPECT_EQ(found.text(), "");

  Cia402StreamConfig drives;
  Cia402NodeConfig known;
  known.node_id = 3;
  known.joint_name = "J_1";
  Cia402NodeConfig unknown_joint = known;
  unknown_joint.node_id = 4;
  unknown_joint.joint_name.clear();
  Cia402NodeConfig faulty = known;
  faulty.node_id = 5;
  faulty.joint = 1;
  faulty.joint_name = "J_2";
  faulty.tpdos = {{.number = 1, .entries = {{0x6041, 0, 16}}}};
  drives.nodes = {known, unknown_joint, known, faulty};
  check_stream(drives, found);
  EXPECT_EQ(found.errors(), 1U) << found.text();
  EXPECT_THAT(found.text(), HasSubstr("node 5 (J_2): no TPDO holds"));
}

TEST_F(DbcStream, TellsValuesBeyondTheLimitsOfTheDbc) {
  ASSERT_NO_FATAL_FAILURE(open("Axis_1", 0.01));
  robot->send(frame(0x100, {0x40, 0x0D, 0x03, 0, 0, 0, 0, 0}));  // 200 deg
  ASSERT_TRUE(becomes_true([&] { return sut->status().received == 1; }));
  const JointStreamStatus status = sut->status();
  EXPECT_THAT(status.last_errors, testing::ElementsAre(HasSubstr("Axis_1.Position is 200 deg, beyond -180 .. 180")));
  EXPECT_THAT(status.details, testing::Contains(testing::Pair("beyond the DBC's limits", "1 value")));
}

}  // namespace
}  // namespace cellmirror::can
