// What asks for a stream's status does not hold up its frames, and reads what belongs together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

#include "drivers/can/channel/virtual_bus.hpp"
#include "drivers/can/stream/streams.hpp"
#include "tests/unit/can/frames.hpp"
#include "tests/unit/can/test_data.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

struct CountingSink : JointSampleSink {
  bool push(const JointSample& /*sample*/) noexcept override {
    ++count;
    return true;
  }
  std::atomic<std::uint64_t> count{0};
};

// Stops the threads that say so where they read it, which is in the middle of status().
class StoppingClock final : public Clock {
 public:
  static thread_local bool stops_this_thread;

  [[nodiscard]] Timestamp now() const CELL_RT override {
    if (stops_this_thread) {
      reached.release();
      go_on.acquire();
    }
    return system_.now();
  }
  mutable std::binary_semaphore reached{0};
  mutable std::binary_semaphore go_on{0};

 private:
  SystemClock system_;
};
thread_local bool StoppingClock::stops_this_thread = false;

bool becomes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 20'000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

// On a busy machine a drive's silence is told beside what was rejected.
bool all_differ(std::vector<std::string> texts) {
  std::ranges::sort(texts);
  return std::ranges::adjacent_find(texts) == texts.end();
}

struct Kind {
  const char* name;
  std::function<Result<std::unique_ptr<JointStream>>(const Clock&, const CanStreamOptions&)> make;
  CanFrame good;  // makes a sample
  CanFrame bad;   // is rejected
};

Kind cia402_kind() {
  const auto make = [](const Clock& clock, const CanStreamOptions& options) {
    Cia402StreamConfig config;
    Cia402NodeConfig node;
    node.node_id = 3;
    node.joint_name = "J_1";
    node.scale = 0.001;
    config.channel.endpoint = "virtual";
    config.nodes = {node};
    return make_cia402_stream(config, clock, options);
  };
  return {"cia402", make, frame(0x183, {0x37, 0x02, 1, 0, 0, 0}), frame(0x183, {0x37, 0x02, 1})};
}

Kind dbc_kind() {
  const auto make = [](const Clock& clock, const CanStreamOptions& options) {
    DbcStreamConfig config;
    config.dbc_file = can_data("axes.dbc");
    config.signals = {{"Axis_1", "Position", 0, "J_1", JointQuantity::position, 0.01, 0.0}};
    return make_dbc_stream(config, clock, options);
  };
  return {"dbc", make, frame(0x100, {0, 0, 0, 0, 0, 0, 0, 0}), frame(0x100, {0, 0, 0})};
}

class StatusThreads : public testing::TestWithParam<Kind (*)()> {
 protected:
  void SetUp() override {
    CanStreamOptions options;
    options.open_channel = [this](const CanChannelConfig&) {
      return Result<std::unique_ptr<CanChannel>>(bus_.connect());
    };
    auto made = kind_.make(clock_, options);
    ASSERT_TRUE(made) << made.error().text();
    sut_ = std::move(*made);
    ASSERT_TRUE(sut_->open(sink_));
  }

  const Kind kind_ = GetParam()();
  VirtualCanBus bus_;
  std::unique_ptr<CanChannel> robot_ = bus_.connect();
  StoppingClock clock_;
  CountingSink sink_;
  std::unique_ptr<JointStream> sut_;
};

TEST_P(StatusThreads, SamplesArriveWhileACallerOfStatusStandsStill) {
  std::thread caller([this] {
    StoppingClock::stops_this_thread = true;
    static_cast<void>(sut_->status());
  });
  clock_.reached.acquire();
  for (int i = 0; i < 100; ++i) robot_->send(kind_.good);
  EXPECT_TRUE(becomes_true([this] { return sink_.count == 100; })) << sink_.count << " samples";
  clock_.go_on.release();
  caller.join();
}

// A good frame before each bad one: what was published together differs by one at most.
TEST_P(StatusThreads, EveryStatusIsOfOneInstant) {
  constexpr std::uint64_t kPairs = 2'000;
  std::atomic<bool> stop{false};
  const auto watch = [&] {
    JointStreamStatus before;
    while (!stop) {
      const JointStreamStatus status = sut_->status();
      ASSERT_LE(status.rejected, status.received);
      ASSERT_LE(status.received, status.rejected + 1);
      ASSERT_GE(status.received, before.received);
      ASSERT_GE(status.rejected, before.rejected);
      ASSERT_TRUE(all_differ(status.last_errors)) << "the same text is kept once";
      before = status;
    }
  };
  std::vector<std::thread> callers;
  for (int i = 0; i < 3; ++i) callers.emplace_back(watch);
  for (std::uint64_t i = 0; i < kPairs; ++i) {
    robot_->send(kind_.good);
    robot_->send(kind_.bad);
    if (i % 500 == 499) {  // the bus holds 4096 frames
      EXPECT_TRUE(becomes_true([&] { return sink_.count == i + 1; }));
    }
  }
  EXPECT_TRUE(becomes_true([this] { return sut_->status().rejected == kPairs; })) << sut_->status().rejected;
  stop = true;
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(sut_->status().received, kPairs);
  const std::vector<std::string> told = sut_->status().last_errors;
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(all_differ(told));
}

TEST_P(StatusThreads, AStreamOpensAndClosesWhileItsStatusIsAskedFor) {
  std::atomic<bool> stop{false};
  std::thread caller([&] {
    while (!stop) {
      const JointStreamStatus status = sut_->status();
      ASSERT_EQ(status.open, status.condition != "closed") << status.condition;
    }
  });
  for (int i = 0; i < 20; ++i) {
    sut_->close();
    ASSERT_TRUE(sut_->open(sink_));
    robot_->send(kind_.good);
    EXPECT_TRUE(becomes_true([this] { return sut_->status().received == 1; })) << "counted anew";
  }
  stop = true;
  caller.join();
}

INSTANTIATE_TEST_SUITE_P(Can, StatusThreads, testing::Values(&cia402_kind, &dbc_kind),
                         [](const auto& kind) { return std::string(kind.param().name); });

}  // namespace
}  // namespace cellmirror::can
