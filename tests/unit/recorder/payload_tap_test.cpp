// Payloads on their way from a stream to a recording: the same bytes, in order, those without room counted.
#include "app/io/payload_tap.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace cellmirror::app {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) { return std::as_bytes(std::span(text)); }

class PayloadTapTest : public testing::Test {
 protected:
  // "robot time payload" of each; those without room are counted.
  std::vector<std::string> drained() {
    std::vector<std::string> out;
    tap_.drain(
        [&](PayloadKind kind, const std::string& robot, Timestamp time, std::span<const std::byte> payload) {
          out.push_back(std::string(kind == PayloadKind::dds ? "dds " : "rtde ") + robot + " " +
                        std::to_string(time.ns) + " " +
                        std::string(reinterpret_cast<const char*>(payload.data()), payload.size()));
        },
        [&](PayloadKind, const std::string&, std::uint64_t payloads) { missed_ += payloads; });
    return out;
  }

  PayloadTap tap_;
  std::uint64_t missed_ = 0;
};

TEST_F(PayloadTapTest, NothingIsKeptBeforeItIsOn) {
  const auto sink = tap_.sink_for(DdsStreamConfig{}, "ARM");
  sink->take(bytes_of("early"), Timestamp{1});
  tap_.set_on(true);
  sink->take(bytes_of("one"), Timestamp{2});
  sink->take(bytes_of(""), Timestamp{3});
  EXPECT_EQ(drained(), (std::vector<std::string>{"dds ARM 2 one", "dds ARM 3 "}));
  EXPECT_TRUE(drained().empty());
}

TEST_F(PayloadTapTest, EachStreamHasItsName) {
  tap_.set_on(true);
  const auto a = tap_.sink_for(DdsStreamConfig{}, "A");
  const auto b = tap_.sink_for(RtdeStreamConfig{}, "B");
  EXPECT_EQ(tap_.sink_for(Cia402StreamConfig{}, "C"), nullptr);
  b->take(bytes_of("2"), Timestamp{1});
  a->take(bytes_of("1"), Timestamp{2});
  EXPECT_EQ(drained(), (std::vector<std::string>{"dds A 2 1", "rtde B 1 2"}));
}

TEST_F(PayloadTapTest, WithoutRoomNewOnesAreLeftOutAndCounted) {
  tap_.set_on(true);
  const auto sink = tap_.sink_for(DdsStreamConfig{}, "ARM");
  const std::string large(PayloadTap::kBytes / 4, 'x');
  for (int i = 0; i < 10; ++i) sink->take(bytes_of(large), Timestamp{i});
  const std::size_t there = drained().size();
  EXPECT_EQ(there, 3U);
  EXPECT_EQ(missed_, 7U);
  sink->take(bytes_of(std::string(2 * PayloadTap::kBytes, 'x')), Timestamp{1});
  EXPECT_TRUE(drained().empty());
  EXPECT_EQ(missed_, 8U);
}

TEST_F(PayloadTapTest, AStreamThatIsGoneLeavesWhatItHad) {
  tap_.set_on(true);
  auto sink = tap_.sink_for(RtdeStreamConfig{}, "ARM");
  sink->take(bytes_of("last"), Timestamp{4});
  sink.reset();
  EXPECT_EQ(drained(), (std::vector<std::string>{"rtde ARM 4 last"}));
  EXPECT_TRUE(drained().empty());
}

TEST_F(PayloadTapTest, StreamsDoNotWaitForTheReader) {
  tap_.set_on(true);
  constexpr int kPayloads = 20'000;
  std::thread stream([sink = tap_.sink_for(DdsStreamConfig{}, "ARM")] {
    for (int i = 0; i < kPayloads; ++i) sink->take(bytes_of(std::to_string(i)), Timestamp{i});
  });
  std::vector<std::string> all;
  const auto collect = [&] {
    for (std::string& one : drained()) all.push_back(std::move(one));
  };
  while (all.size() + missed_ < kPayloads) collect();
  stream.join();
  collect();
  EXPECT_EQ(all.size() + missed_, static_cast<std::size_t>(kPayloads));
  int last = -1;
  for (const std::string& one : all) {
    const int number = std::stoi(one.substr(one.rfind(' ') + 1));
    EXPECT_GT(number, std::exchange(last, number));
  }
}

}  // namespace
}  // namespace cellmirror::app
