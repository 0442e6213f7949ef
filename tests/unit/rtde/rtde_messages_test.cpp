// Packages of RTDE against bytes written by hand from the guide.
#include "drivers/rtde/rtde_messages.hpp"

#include <gtest/gtest.h>

#include <string>

namespace cellmirror::rtde {
namespace {

Bytes bytes(std::initializer_list<int> values) {
  Bytes out;
  for (const int value : values) out.push_back(static_cast<std::uint8_t>(value));
  return out;
}

TEST(RtdeMessages, RequestsAreThoseOfTheGuide) {
  EXPECT_EQ(version_request(2), bytes({0, 5, 86, 0, 2}));
  EXPECT_EQ(start_request(), bytes({0, 3, 83}));
  // 125 as a double of IEEE 754: 0x405F400000000000.
  EXPECT_EQ(outputs_request(125, "actual_q"),
            bytes({0, 19, 79, 0x40, 0x5F, 0x40, 0, 0, 0, 0, 0, 'a', 'c', 't', 'u', 'a', 'l', '_', 'q'}));
}

TEST(RtdeMessages, AnswersAreRead) {
  EXPECT_EQ(decode_accepted(bytes({1})), true);
  EXPECT_EQ(decode_accepted(bytes({0})), false);
  EXPECT_EQ(decode_accepted(bytes({})), std::nullopt);
  EXPECT_EQ(decode_accepted(bytes({1, 1})), std::nullopt);
  const auto outputs = decode_outputs(bytes({7, 'I', 'N', 'T', '3', '2'}));
  ASSERT_TRUE(outputs);
  EXPECT_EQ(outputs->recipe, 7);
  EXPECT_EQ(outputs->types, "INT32");
  EXPECT_FALSE(decode_outputs({}));
  EXPECT_EQ(decode_text(bytes({2, 'h', 'i', 3, 'U', 'R', 'C', 0})), "hi");
  EXPECT_EQ(decode_text(bytes({200, 'h', 'i'})), "hi");
}

TEST(RtdeMessages, DataComesBackAsItWasSent) {
  RobotData data{.timestamp_s = 12.25, .q = {0.1, -0.2, 0.3, -0.4, 0.5, -0.6}, .qd = {1, 2, 3, 4, 5, 6}};
  data.robot_mode = -1;
  data.safety_mode = 3;
  const Bytes sent = data_package(data, 9);
  ASSERT_EQ(sent.size(), 3U + 1 + 8 + 48 + 48 + 8);
  // 12.25: 0x4028800000000000.
  EXPECT_EQ(Bytes(sent.begin(), sent.begin() + 12), bytes({0, 116, 85, 9, 0x40, 0x28, 0x80, 0, 0, 0, 0, 0}));
  const auto read = decode_data(std::span(sent).subspan(3), 9);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->timestamp_s, data.timestamp_s);
  EXPECT_EQ(read->q, data.q);
  EXPECT_EQ(read->qd, data.qd);
  EXPECT_EQ(robot_mode_text(read->robot_mode), "no controller");
  EXPECT_EQ(safety_mode_text(read->safety_mode), "protective stop");
  EXPECT_FALSE(decode_data(std::span(sent).subspan(3), 8));
  EXPECT_FALSE(decode_data(std::span(sent).subspan(4), 9));
}

TEST(RtdeMessages, AllVariablesComeBackAsTheyWereSent) {
  RobotData data{.timestamp_s = 1.0};
  data.has_all = true;
  data.current = {1, 2, 3, 4, 5, 6};
  data.moment = {-1, -2, -3, -4, -5, -6};
  data.speed_scaling = 0.25;
  data.runtime_state = 4;
  const Bytes sent = data_package(data, 9);
  ASSERT_EQ(sent.size(), 3U + 1 + 8 + 48 + 48 + 8 + 48 + 48 + 8 + 4);
  EXPECT_EQ(Bytes(sent.end() - 12, sent.end()), bytes({0x3F, 0xD0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4}));
  const auto read = decode_data(std::span(sent).subspan(3), 9);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->current, data.current);
  EXPECT_EQ(read->moment, data.moment);
  EXPECT_EQ(read->speed_scaling, 0.25);
  EXPECT_EQ(runtime_state_text(read->runtime_state), "paused");
}

TEST(RtdeMessages, EveryModeOfTheRtdeGuideHasAText) {
  for (int mode = 1; mode <= 13; ++mode) EXPECT_EQ(safety_mode_text(mode).find("mode "), std::string::npos) << mode;
  EXPECT_EQ(safety_mode_text(10), "validating a joint");
  EXPECT_EQ(safety_mode_text(14), "safety mode 14");
  for (std::uint32_t state = 0; state < 6; ++state)
    EXPECT_EQ(runtime_state_text(state).find("runtime"), std::string::npos) << state;
}

TEST(RtdeMessages, PackagesAreDividedWhereverTheBytesAre) {
  Bytes stream = version_request(2);
  const Bytes more = outputs_request(500, kVariables);
  stream.insert(stream.end(), more.begin(), more.end());
  for (std::size_t chunk = 1; chunk <= stream.size(); ++chunk) {
    PackageSplitter splitter;
    std::string types;
    for (std::size_t at = 0; at < stream.size(); at += chunk) {
      splitter.add(std::span(stream).subspan(at, std::min(chunk, stream.size() - at)));
      while (const auto package = splitter.next()) types += static_cast<char>(package->type);
    }
    EXPECT_EQ(types, "VO") << chunk;
    EXPECT_FALSE(splitter.broken());
  }
}

TEST(RtdeMessages, ALengthThatCannotBeBreaksTheStream) {
  PackageSplitter splitter;
  splitter.add(bytes({0, 2, 86, 0}));
  EXPECT_FALSE(splitter.next());
  EXPECT_TRUE(splitter.broken());
  splitter.clear();
  EXPECT_FALSE(splitter.broken());
  splitter.add(start_request());
  EXPECT_TRUE(splitter.next());
}

TEST(RtdeMessages, TheControllersSideReadsRequests) {
  const Bytes version = version_request(2);
  EXPECT_EQ(decode_version_request(std::span(version).subspan(3)), 2);
  const Bytes outputs = outputs_request(250, "a,b");
  const auto request = decode_outputs_request(std::span(outputs).subspan(3));
  ASSERT_TRUE(request);
  EXPECT_EQ(request->rate_hz, 250);
  EXPECT_EQ(request->variables, "a,b");
  EXPECT_FALSE(decode_outputs_request(bytes({1, 2, 3})));
}

}  // namespace
}  // namespace cellmirror::rtde
