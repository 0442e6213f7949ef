// Drives and I/O nodes that answer on one channel with one thread: a master sees as many nodes as if each had its own.
#include "drivers/can/stream/shared_channel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/channel/virtual_bus.hpp"
#include "drivers/can/stream/streams.hpp"
#include "tests/unit/can/frames.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr Nanoseconds kPatience = 60s;
constexpr std::uint8_t kIoNode = 20;

// The system's, and what a test has put on it.
struct AheadClock final : Clock {
  [[nodiscard]] Timestamp now() const CELL_RT override { return system.now() + Nanoseconds(ahead_ns.load()); }
  SystemClock system;
  std::atomic<std::int64_t> ahead_ns{0};
};

struct CountingSink : JointSampleSink {
  bool push(const JointSample& /*sample*/) noexcept override {
    ++count;
    return true;
  }
  std::atomic<int> count{0};
};

template <class Condition>
bool becomes_true(Condition condition) {
  const Timestamp end = SystemClock().now() + kPatience;
  while (SystemClock().now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

// Arm A has the drives 1 and 2, arm B the drive 3; the I/O node is 20.
struct SharedNodes : testing::Test {
  SharedNodes() {
    CanStreamOptions options;
    options.open_channel = [this](const CanChannelConfig&) -> Result<std::unique_ptr<CanChannel>> {
      ++opened;
      if (!can_open) return fail("no such bus");
      return bus.connect();
    };
    CanChannelConfig config;
    config.endpoint = "virtual";
    channel = make_shared_channel(config, clock, std::move(options));
    a = device({1, 2});
    b = device({3});
    io = io_node();
  }
  ~SharedNodes() override {
    for (JointStream* stream : {a.get(), b.get(), io.get()}) stream->close();
  }

  std::unique_ptr<JointStream> device(std::initializer_list<std::uint8_t> numbers) {
    Cia402DeviceConfig config;
    for (const std::uint8_t number : numbers) {
      DriveConfig drive;
      drive.node_id = number;
      drive.joint = config.nodes.size();
      config.nodes.push_back(drive);
    }
    return *make_cia402_device(config, clock, channel);
  }
  std::unique_ptr<JointStream> io_node() {
    IoNodeConfig config;
    config.node_id = kIoNode;
    config.heartbeat_ms = 1'000;
    return make_cia401_node(config, {inputs, std::make_shared<Latest<IoOutputs>>(), {}}, clock, channel);
  }
  void open_all() {
    ASSERT_TRUE(a->open(sink_a));
    ASSERT_TRUE(b->open(sink_b));
    ASSERT_TRUE(io->open(no_samples()));
  }

  // The next frame with the identifier; those before it are kept in `passed`.
  std::optional<CanFrame> await(std::uint32_t id, Nanoseconds patience = kPatience) {
    const Timestamp end = SystemClock().now() + patience;
    ReceivedCanFrame got;
    while (SystemClock().now() < end) {
      if (master->receive(got, 10ms) != CanReceive::frame) continue;
      passed.push_back(got.frame);
      if (got.frame.id == id) return got.frame;
    }
    return {};
  }
  std::size_t count_passed(std::uint32_t id) const {
    return static_cast<std::size_t>(std::ranges::count(passed, id, &CanFrame::id));
  }
  // Once every node has carried out what was sent before it; all frames up to then are in `passed`.
  void settle(std::initializer_list<std::uint8_t> nodes) {
    for (const std::uint8_t node : nodes) EXPECT_TRUE(read(node, 0x1000)) << int{node};
  }
  std::optional<std::uint32_t> read(std::uint32_t node, int index, int subindex = 0) {
    master->send(frame(0x600 + node, {0x40, index & 0xFF, index >> 8, subindex, 0, 0, 0, 0}));
    const auto answer = await(0x580 + node);
    if (!answer || answer->data[0] == 0x80) return {};
    return get_le32(std::span(answer->data).subspan(4));
  }
  void write(std::uint32_t node, int index, int subindex, std::uint32_t value, int bytes) {
    CanFrame request = frame(0x600 + node, {0x23 | (4 - bytes) << 2, index & 0xFF, index >> 8, subindex, 0, 0, 0, 0});
    put_le(std::span(request.data).subspan(4), value, 4);
    master->send(request);
    const auto answer = await(0x580 + node);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->data[0], 0x60) << std::hex << index << " " << get_le32(std::span(answer->data).subspan(4));
  }
  void start_all() {
    master->send(frame(0x000, {0x01, 0x00}));
    settle({1, 2, 3, kIoNode});
    passed.clear();
  }
  void set_inputs(std::uint32_t digital) {
    IoInputs values;
    values.digital = digital;
    inputs->write(values);
  }
  bool detail_tells(const JointStream& stream, const std::string& name, const std::string& part) {
    for (const auto& [key, text] : stream.status().details) {
      if (key == name && text.find(part) != std::string::npos) return true;
    }
    return false;
  }

  VirtualCanBus bus;
  std::unique_ptr<CanChannel> master = bus.connect();
  AheadClock clock;
  std::atomic<int> opened{0};
  bool can_open = true;
  std::shared_ptr<SharedChannel> channel;
  std::shared_ptr<Latest<IoInputs>> inputs = std::make_shared<Latest<IoInputs>>();
  CountingSink sink_a;
  CountingSink sink_b;
  std::unique_ptr<JointStream> a;
  std::unique_ptr<JointStream> b;
  std::unique_ptr<JointStream> io;
  Frames passed;
};

TEST_F(SharedNodes, OpenOneChannelForAllAndCloseItWithTheLast) {
  open_all();
  EXPECT_EQ(opened, 1);
  a->close();
  io->close();
  ASSERT_TRUE(a->open(sink_a));
  EXPECT_EQ(opened, 1);
  a->close();
  b->close();
  ASSERT_TRUE(b->open(sink_b));
  EXPECT_EQ(opened, 2);
}

TEST_F(SharedNodes, OneSyncIsAnsweredByAllOnce) {
  open_all();
  start_all();
  constexpr std::size_t kSyncs = 5;
  for (std::size_t i = 0; i < kSyncs; ++i) master->send(frame(0x080, {}));
  settle({1, 2, 3});
  for (const std::uint32_t node : {1U, 2U, 3U}) {
    EXPECT_EQ(count_passed(0x280 + node), kSyncs);
    EXPECT_EQ(count_passed(0x380 + node), kSyncs);
  }
}

TEST_F(SharedNodes, EachGivesItsSamples) {
  open_all();
  EXPECT_TRUE(becomes_true([&] { return sink_a.count > 3 && sink_b.count > 3; }));
}

TEST_F(SharedNodes, ADriveTakesThePdoOfAnIoNode) {
  open_all();
  write(3, 0x1400, 1, 0x8000'0203, 4);
  write(3, 0x1400, 1, 0x180 + kIoNode, 4);
  start_all();
  set_inputs(0x0006);
  ASSERT_TRUE(await(0x180 + kIoNode));
  EXPECT_TRUE(becomes_true([&] { return read(3, 0x6040) == 6U; }));
  EXPECT_EQ(read(1, 0x6040), 0U);

  write(3, 0x1400, 1, 0x8000'0194, 4);
  passed.clear();
  set_inputs(0x0007);
  ASSERT_TRUE(await(0x180 + kIoNode));
  set_inputs(0x0005);
  ASSERT_TRUE(await(0x180 + kIoNode));
  settle({3});
  EXPECT_EQ(read(3, 0x6040), 6U) << "the PDO does not exist any more";
}

TEST_F(SharedNodes, ADriveTakesThePdoOfAnotherOneOfItsArm) {
  open_all();
  write(1, 0x1400, 1, 0x8000'0201, 4);
  write(1, 0x1400, 1, 0x182, 4);  // the statusword of drive 2 as a controlword
  start_all();
  EXPECT_TRUE(becomes_true([&] {
    const auto status = read(2, 0x6041);
    return status && status != 0U && read(1, 0x6040) == status;
  }));
  EXPECT_EQ(read(2, 0x6040), 0U);
}

TEST_F(SharedNodes, ADriveWatchesTheHeartbeatOfAnother) {
  open_all();
  write(3, 0x1016, 1, kIoNode << 16 | 10'000, 4);  // 10 s
  start_all();
  for (int i = 0; i < 30; ++i) {
    clock.ahead_ns += Nanoseconds(1s).count();
    ASSERT_TRUE(await(0x700 + kIoNode));
  }
  settle({3});
  EXPECT_EQ(count_passed(0x083), 0U) << "it was heard for 30 s";
  io->close();
  clock.ahead_ns += Nanoseconds(11s).count();
  const auto emergency = await(0x083);
  ASSERT_TRUE(emergency);
  EXPECT_EQ(get_le16(emergency->data), 0x8130);
}

TEST_F(SharedNodes, ClosingOneKeepsTheOthers) {
  open_all();
  start_all();
  a->close();
  EXPECT_FALSE(a->status().open);
  EXPECT_EQ(a->status().condition, "closed");
  EXPECT_TRUE(b->status().open);
  const int samples = sink_a.count;
  master->send(frame(0x080, {}));
  settle({3});
  EXPECT_EQ(count_passed(0x283), 1U);
  EXPECT_EQ(count_passed(0x281), 0U);
  EXPECT_EQ(count_passed(0x703), 0U) << "it was not restarted";
  EXPECT_EQ(sink_a.count, samples);

  ASSERT_TRUE(a->open(sink_a));
  EXPECT_TRUE(await(0x701)) << "boots again";
  EXPECT_EQ(count_passed(0x703), 0U);
}

TEST_F(SharedNodes, AnotherNodeNumberIsInForceAfterAReset) {
  open_all();
  master->send(frame(0x7E5, {0x40, 0, 0, 0, 0, 0, 0, 0}));
  master->send(frame(0x7E5, {0x41, 0, 0, 0, 0, 0, 0, 0}));
  master->send(frame(0x7E5, {0x42, 0, 0, 0, 0, 0, 0, 0}));
  master->send(frame(0x7E5, {0x43, 3, 0, 0, 0, 0, 0, 0}));  // the serial number
  ASSERT_TRUE(await(0x7E4));
  master->send(frame(0x7E5, {0x11, 9, 0, 0, 0, 0, 0, 0}));
  ASSERT_TRUE(await(0x7E4));
  master->send(frame(0x000, {0x82, 0x03}));
  ASSERT_TRUE(await(0x709));
  EXPECT_EQ(read(9, 0x1018, 4), 3U);
  EXPECT_EQ(read(1, 0x1018, 4), 1U);
}

TEST_F(SharedNodes, TheStatusOfEachShowsTheChannel) {
  open_all();
  bus.set_state(CanBusState::down);
  for (const JointStream* stream : {a.get(), b.get(), io.get()}) {
    EXPECT_TRUE(becomes_true([&] { return detail_tells(*stream, "bus", "down"); }));
    EXPECT_THAT(stream->status().condition, HasSubstr("down"));
    EXPECT_EQ(stream->status().endpoint, "virtual");
  }
  bus.set_state(CanBusState::active);
  settle({1, 3, kIoNode});
}

TEST_F(SharedNodes, ARefusedFrameIsCountedForTheStreamThatSentIt) {
  open_all();
  start_all();
  bus.refuse_sends(4);  // TPDO2 and TPDO3 of both drives of arm A
  bus.inject(frame(0x080, {}));
  ASSERT_TRUE(await(0x283));
  EXPECT_TRUE(becomes_true([&] { return detail_tells(*a, "frames that the channel refused", ""); }));
  EXPECT_FALSE(detail_tells(*b, "frames that the channel refused", ""));
}

TEST_F(SharedNodes, AChannelThatCannotBeOpenedIsAnErrorOfEach) {
  can_open = false;
  EXPECT_FALSE(a->open(sink_a));
  EXPECT_FALSE(io->open(no_samples()));
  EXPECT_FALSE(a->status().open);
  EXPECT_EQ(a->status().condition, "closed");
  can_open = true;
  open_all();
  settle({1, 2, 3, kIoNode});
}

// A flood holds up no timer: heartbeats and samples go on.
TEST_F(SharedNodes, AFloodHoldsNothingUp) {
  open_all();
  std::atomic<bool> stop{false};
  std::thread flood([&] {
    const auto sender = bus.connect();
    while (!stop) {
      for (int i = 0; i < 50; ++i) {
        sender->send(frame(0x080, {}));
        for (const std::uint32_t id : {0x123U, 0x203U, 0x601U}) sender->send(frame(id, {0, 0, 0, 0, 0, 0, 0, 0}));
      }
      std::this_thread::sleep_for(100us);
    }
  });
  for (int i = 0; i < 3; ++i) {
    const int before_a = sink_a.count;
    const int before_b = sink_b.count;
    EXPECT_TRUE(becomes_true([&] { return sink_a.count > before_a && sink_b.count > before_b; }));
  }
  stop = true;
  flood.join();
}

TEST_F(SharedNodes, OpenAndCloseWhileTheOthersRunAndTheirStatusIsAskedFor) {
  ASSERT_TRUE(b->open(sink_b));
  std::atomic<bool> stop{false};
  const auto watch = [&] {
    while (!stop) {
      for (const JointStream* stream : {a.get(), b.get(), io.get()}) {
        const JointStreamStatus status = stream->status();
        ASSERT_EQ(status.open, status.condition != "closed") << status.condition;
      }
    }
  };
  std::thread one(watch);
  std::thread other(watch);
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(a->open(sink_a));
    ASSERT_TRUE(io->open(no_samples()));
    master->send(frame(0x080, {}));
    settle({1, 3, kIoNode});
    a->close();
    io->close();
  }
  stop = true;
  one.join();
  other.join();
  EXPECT_EQ(count_passed(0x703), 1U) << "the drive that stays was not restarted";
}

// Switches of a channel: its interface appears, its log is repeated, its queue is full.
struct StagedBus {
  std::atomic<bool> there{false};
  std::atomic<bool> refuses{false};
  std::atomic<int> passes{0};
  std::mutex mutex;
  std::vector<std::uint32_t> sent;  // identifiers

  std::size_t count(std::uint32_t id) {
    const std::lock_guard lock(mutex);
    return static_cast<std::size_t>(std::ranges::count(sent, id));
  }
};
class StagedChannel final : public CanChannel {
 public:
  explicit StagedChannel(StagedBus& bus) : bus_(&bus) { look(); }
  CanReceive receive(ReceivedCanFrame& /*frame*/, Nanoseconds /*timeout*/) override {
    std::this_thread::sleep_for(1ms);
    look();
    if (passes_ < bus_->passes) {
      ++passes_;
      return CanReceive::again;
    }
    return status_.waits_for.empty() ? CanReceive::timeout : CanReceive::down;
  }
  bool send(const CanFrame& frame) override {
    if (!status_.waits_for.empty()) return false;
    if (bus_->refuses) {
      ++status_.send_refused;
      status_.last_error = "the transmit queue of late0 is full";
      return false;
    }
    const std::lock_guard lock(bus_->mutex);
    bus_->sent.push_back(frame.id);
    return true;
  }
  [[nodiscard]] const CanChannelStatus& status() const override { return status_; }

 private:
  void look() {
    status_.waits_for = bus_->there ? "" : "late0";
    status_.bus = bus_->there ? CanBusState::active : CanBusState::down;
    if (!bus_->there) status_.last_error = "waits for late0: there is no network interface late0";
  }
  StagedBus* bus_;
  CanChannelStatus status_;
  int passes_ = 0;
};

struct SampleSink final : JointSampleSink {
  bool push(const JointSample& sample) noexcept override {
    if (sample.sequence == JointSample::kBeginsAnew) ++beginnings;
    ++count;
    return true;
  }
  std::atomic<int> count{0};
  std::atomic<int> beginnings{0};
};

struct StagedNodes : testing::Test {
  StagedNodes() {
    CanStreamOptions options;
    options.open_channel = [this](const CanChannelConfig&) -> Result<std::unique_ptr<CanChannel>> {
      return std::make_unique<StagedChannel>(bus);
    };
    CanChannelConfig config;
    config.endpoint = "staged";
    Cia402DeviceConfig device;
    device.nodes.resize(1);
    device.nodes[0].node_id = 9;
    stream = *make_cia402_device(device, clock, make_shared_channel(config, clock, std::move(options)));
  }
  ~StagedNodes() override { stream->close(); }
  bool error_tells(const std::string& part) {
    return std::ranges::any_of(stream->status().last_errors,
                               [&](const std::string& text) { return text.find(part) != std::string::npos; });
  }
  SystemClock clock;
  StagedBus bus;
  SampleSink sink;
  std::unique_ptr<JointStream> stream;
};

TEST_F(StagedNodes, BootWhenTheMissingInterfaceAppears) {
  ASSERT_TRUE(stream->open(sink));
  EXPECT_TRUE(becomes_true([&] { return sink.count > 0; })) << "the drive runs without the bus";
  EXPECT_EQ(stream->status().waits_for, "late0");
  EXPECT_THAT(stream->status().condition, testing::StartsWith("waits for late0"));
  EXPECT_EQ(bus.count(0x709), 0U);
  bus.there = true;
  EXPECT_TRUE(becomes_true([&] { return bus.count(0x709) == 1; })) << "the boot-up message is sent again";
  EXPECT_TRUE(becomes_true([&] { return stream->status().waits_for.empty(); }));
}

TEST_F(StagedNodes, MarkTheFirstSampleOfEachPassOfALog) {
  bus.there = true;
  ASSERT_TRUE(stream->open(sink));
  EXPECT_TRUE(becomes_true([&] { return sink.count > 1; }));
  EXPECT_EQ(sink.beginnings, 1) << "the stream was opened";
  bus.passes = 1;
  EXPECT_TRUE(becomes_true([&] { return sink.beginnings == 2; }));
}

TEST_F(StagedNodes, ReportFramesThatTheKernelRefusesWithTheReason) {
  bus.there = true;
  bus.refuses = true;
  ASSERT_TRUE(stream->open(sink));
  EXPECT_TRUE(becomes_true([&] { return error_tells("not sent: the transmit queue of late0 is full"); }));
}

}  // namespace
}  // namespace cellmirror::can
