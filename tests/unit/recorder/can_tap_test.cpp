// Frames on their way from a CAN stream's channel to a recording: the same frames, in order, those without room
// counted.
#include "app/io/can_tap.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/recorder/output_messages.hpp"
#include "app/recording/ros2_schema.hpp"
#include "drivers/can/channel/candump_line.hpp"

namespace cellmirror::app {
namespace {

class CanTapTest : public testing::Test {
 protected:
  CanTapTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tap.XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~CanTapTest() override { std::filesystem::remove_all(folder_); }

  std::unique_ptr<CanChannel> open(const std::string& log) {
    std::ofstream(folder_ / "a.log") << log;
    CanChannelConfig config;
    config.endpoint = "log:" + (folder_ / "a.log").string();
    config.fd = true;
    config.log_as_fast_as_possible = true;
    auto made = tap_.opener("ROBOT")(config);
    EXPECT_TRUE(made) << made.error().text();
    return made ? *std::move(made) : nullptr;
  }
  static std::size_t play(CanChannel& channel) {
    ReceivedCanFrame frame;
    std::size_t frames = 0;
    // Slow machines come to a frame after the time that a call has.
    for (int in_vain = 0; in_vain < 100;) {
      if (channel.receive(frame, Nanoseconds(1'000'000)) == CanReceive::frame) {
        ++frames;
        in_vain = 0;
      } else {
        ++in_vain;
      }
    }
    return frames;
  }
  // What the tap has: frames as candump writes them.
  std::vector<std::string> drained() {
    std::vector<std::string> out;
    tap_.drain(
        [&](const std::string& robot, const TappedCanFrame& tapped) {
          EXPECT_EQ(robot, "ROBOT");
          const auto values = flatten_json(can_frame_message(tapped.frame, 1, tapped.sent));
          EXPECT_TRUE(values);
          for (const FlatValue& value : *values)
            if (value.path == "frame") out.push_back(value.text);
        },
        [&](const std::string&, std::uint64_t frames) { missed_ += frames; });
    return out;
  }

  std::filesystem::path folder_;
  SystemClock clock_;
  CanTap tap_{clock_};
  std::uint64_t missed_ = 0;
};

TEST_F(CanTapTest, GivesTheFramesThatWereReceived) {
  tap_.set_on(true);
  auto channel = open("(1.000000) can0 123#DEADBEEF\n(1.100000) can0 1ABCDEF0##1DEADBEEF\n(1.200000) can0 123#R\n");
  ASSERT_EQ(play(*channel), 3U);
  EXPECT_EQ(drained(), (std::vector<std::string>{"123#DEADBEEF", "1ABCDEF0##1DEADBEEF", "123#R"}));
  EXPECT_TRUE(drained().empty());
  channel.reset();
  EXPECT_TRUE(drained().empty());
}

TEST_F(CanTapTest, GivesNothingWhileItIsOff) {
  auto channel = open("(1.000000) can0 123#00\n");
  ASSERT_EQ(play(*channel), 1U);
  EXPECT_TRUE(drained().empty());
}

TEST_F(CanTapTest, CountsFramesWithoutRoomAndKeepsThoseOfAChannelThatWasClosed) {
  tap_.set_on(true);
  std::string log;
  for (std::size_t i = 0; i < CanTap::kFrames + 10; ++i) log += "(1.000000) can0 123#00\n";
  auto channel = open(log);
  ASSERT_EQ(play(*channel), CanTap::kFrames + 10);
  channel.reset();
  EXPECT_EQ(drained().size(), CanTap::kFrames);
  EXPECT_EQ(missed_, 10U);
}

}  // namespace
}  // namespace cellmirror::app
