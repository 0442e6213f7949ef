// Values of a recording over time as a figure: which lines there are, and what is refused.
#include "app/recording/recording_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "app/recorder/output_messages.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "ipc/record/writer.hpp"

namespace cellmirror::app {
namespace {

using testing::HasSubstr;

class RecordingPlot : public testing::Test {
 protected:
  void SetUp() override {
    mcap::Writer writer(out_, {});
    ASSERT_TRUE(writer.begin());
    const TopicPtr joints = OutputTopics::joint_states({});
    ASSERT_TRUE(writer.put(mcap::Schema{1, joints->schema_name, joints->schema_encoding, joints->schema}));
    ASSERT_TRUE(writer.put(
        mcap::Channel{1, 1, "/joint_states", "cdr", {{"joint:turn", "ARM.J_1"}, {"joint:lift", "AXIS.J_1"}}}));
    ASSERT_TRUE(writer.put(mcap::Channel{2, 0, "/json", "json"}));
    for (std::uint64_t i = 0; i < kMessages; ++i) {
      dds::JointState state;
      state.name = {"turn", "lift"};
      state.position = {0.001 * static_cast<double>(i), i == 7000 ? 5.0 : 1.0};
      std::vector<std::byte> bytes;
      encode(state, bytes);
      put(writer, 1, i, bytes);
      const std::string text = R"({"near":)" + std::to_string(i) + R"(,"word":"x","on":true,"list":[1,2]})";
      put(writer, 2, i, mcap::view_of(text));
    }
    ASSERT_TRUE(writer.finish());
  }
  static void put(mcap::Writer& writer, std::uint16_t channel, std::uint64_t i, mcap::View data) {
    ASSERT_TRUE(writer.put(mcap::Message{channel, 0, kStart + i * 1'000'000, 0, data}));
  }
  Result<plot::Figure> figure(const std::string& topic, const std::vector<std::string>& fields,
                              const mcap::Filter& filter = {}) {
    const mcap::MemorySource source(out_.bytes);
    auto reader = mcap::Reader::open(source);
    EXPECT_TRUE(reader);
    return recording_figure(*reader, topic, fields, filter);
  }

  static constexpr std::uint64_t kStart = 1'700'000'000'000'000'000;
  static constexpr std::uint64_t kMessages = 10'000;  // a millisecond apart
  mcap::MemorySink out_;
};

TEST_F(RecordingPlot, JointsHaveTheirNamesAndTimesBeginAtZero) {
  const auto sut = figure("/joint_states", {"position"});
  ASSERT_TRUE(sut) << sut.error().text();
  ASSERT_EQ(sut->panels.size(), 1U);
  const auto& lines = sut->panels[0].lines;
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].label, "turn");
  EXPECT_EQ(lines[1].label, "lift");
  EXPECT_DOUBLE_EQ(lines[0].x.front(), 0.0);
  EXPECT_NEAR(lines[0].x.back(), 9.999, 1e-9);
  EXPECT_EQ(lines[0].x.size(), lines[0].y.size());
  EXPECT_LE(lines[0].x.size(), 3200U) << "no more than a picture shows";
  EXPECT_TRUE(std::ranges::is_sorted(lines[0].x));
  EXPECT_EQ(std::ranges::max(lines[1].y), 5.0) << "a single peak is not lost";
  EXPECT_THAT(sut->subtitle, HasSubstr("10000 messages"));
}

TEST_F(RecordingPlot, JointsAreChosenByTheirNameOrTheirRobot) {
  const auto labels = [&](const std::string& field) {
    std::string out;
    const auto sut = figure("/joint_states", {field, "position"});
    if (!sut) return sut.error().text();
    for (const plot::Line& line : sut->panels[0].lines) out += std::to_string(line.y.front()).substr(0, 1);
    return out;
  };
  EXPECT_EQ(labels("position[turn]"), "0");
  EXPECT_EQ(labels("position[AXIS]"), "1");
  EXPECT_EQ(labels("position[1]"), "1");
  EXPECT_THAT(labels("position[AX]"), HasSubstr("no number"));
  EXPECT_THAT(labels("velocity[AXIS]"), HasSubstr("no number"));
}

TEST_F(RecordingPlot, AFieldIsAValueOrAllBelowIt) {
  const auto sut = figure("/json", {"near", "list", "list[1]", "on"}, {.topics = {}, .from = kStart + 5'000'000'000});
  ASSERT_TRUE(sut) << sut.error().text();
  ASSERT_EQ(sut->panels.size(), 4U);
  EXPECT_EQ(sut->panels[0].lines.size(), 1U);
  EXPECT_EQ(sut->panels[0].lines[0].y.front(), 5000.0);
  EXPECT_NEAR(sut->panels[0].lines[0].x.front(), 5.0, 1e-9) << "after the start of the recording";
  EXPECT_EQ(sut->panels[1].lines.size(), 2U);
  EXPECT_EQ(sut->panels[1].lines[1].label, "list[1]");
  EXPECT_EQ(sut->panels[2].lines.size(), 1U);
  EXPECT_EQ(sut->panels[3].lines[0].y.front(), 1.0);
}

TEST_F(RecordingPlot, IsRefusedWhereThereIsNothingToShow) {
  const auto why = [&](const std::string& topic, const std::vector<std::string>& fields) {
    const auto sut = figure(topic, fields);
    return sut ? std::string() : sut.error().text();
  };
  EXPECT_THAT(why("/jason", {"near"}), HasSubstr("/json"));
  EXPECT_THAT(why("/json", {"word"}), HasSubstr("no number word"));
  EXPECT_THAT(why("/json", {"nea"}), HasSubstr("near"));
  EXPECT_THAT(why("/json", {}), HasSubstr("1 to 12"));
  EXPECT_THAT(why("/json", std::vector<std::string>(13, "near")), HasSubstr("1 to 12"));
}

TEST_F(RecordingPlot, APanelHasABoundedNumberOfLines) {
  mcap::MemorySink out;
  mcap::Writer writer(out, {});
  ASSERT_TRUE(writer.begin());
  ASSERT_TRUE(writer.put(mcap::Channel{1, 0, "/json", "json"}));
  std::string text = R"({"v":[0)";
  for (std::size_t i = 0; i < kMostLines; ++i) text += ",1";
  text += "]}";
  put(writer, 1, 0, mcap::view_of(text));
  ASSERT_TRUE(writer.finish());
  out_.bytes = out.bytes;
  const auto sut = figure("/json", {"v"});
  ASSERT_FALSE(sut);
  EXPECT_THAT(sut.error().text(), HasSubstr("more than 32"));
  EXPECT_TRUE(figure("/json", {"v[3]"}));
}

}  // namespace
}  // namespace cellmirror::app
