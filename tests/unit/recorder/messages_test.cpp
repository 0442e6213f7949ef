// The messages of a recording fit the schemas that it has for them.
#include <gtest/gtest.h>

#include "app/recorder/output_messages.hpp"
#include "app/recording/ros2_schema.hpp"
#include "drivers/dds/range_message.hpp"
#include "drivers/dds/wrench_message.hpp"

namespace cellmirror::app {
namespace {

FlatMessage flat(const TopicPtr& topic, const std::vector<std::byte>& message) {
  const auto schema = Ros2Schema::parse(topic->schema_name, topic->schema);
  EXPECT_TRUE(schema) << schema.error().text();
  if (!schema) return {};
  const auto values = schema->flatten(message);
  EXPECT_TRUE(values) << values.error().text();
  return values ? *values : FlatMessage{};
}

std::string value(const FlatMessage& message, std::string_view path) {
  for (const FlatValue& one : message)
    if (one.path == path) return one.text;
  return "none";
}

TEST(RecordedMessages, JointStatesFitTheirSchema) {
  dds::JointState state;
  state.header = {{12, 34}, "world"};
  state.name = {"a", "b2"};
  state.position = {0.25, -1.5};
  state.velocity = {0.1, 0.2};
  state.effort = {3, 4};
  std::vector<std::byte> bytes;
  encode(state, bytes);
  const FlatMessage message = flat(OutputTopics::joint_states({}), bytes);
  EXPECT_EQ(value(message, "header.stamp.sec"), "12");
  EXPECT_EQ(value(message, "header.stamp.nanosec"), "34");
  EXPECT_EQ(value(message, "header.frame_id"), "world");
  EXPECT_EQ(value(message, "name[1]"), "b2");
  EXPECT_EQ(value(message, "position[1]"), "-1.5");
  EXPECT_EQ(value(message, "effort[0]"), "3");
  EXPECT_EQ(message.size(), 3U + 2 + 2 + 2 + 2);
}

TEST(RecordedMessages, FramesFitTheirSchema) {
  dds::TfMessage frames;
  frames.transforms.resize(2);
  frames.transforms[1] = {{{1, 2}, "world"}, "tool", {1, 2, 3}, {0, 0, 0, 1}};
  std::vector<std::byte> bytes;
  encode(frames, bytes);
  const FlatMessage message = flat(OutputTopics::tf(), bytes);
  EXPECT_EQ(value(message, "transforms[1].child_frame_id"), "tool");
  EXPECT_EQ(value(message, "transforms[1].transform.translation.z"), "3");
  EXPECT_EQ(value(message, "transforms[1].transform.rotation.w"), "1");
}

TEST(RecordedMessages, RangesForcesAndLogFitTheirSchemas) {
  dds::Range range;
  range.range = 1.25F;
  range.max_range = 3;
  range.variance = 0.5F;
  std::vector<std::byte> bytes;
  encode(range, bytes);
  FlatMessage message = flat(OutputTopics::range("US_1"), bytes);
  EXPECT_EQ(value(message, "range"), "1.25");
  EXPECT_EQ(value(message, "variance"), "0.5");
  EXPECT_EQ(value(message, "radiation_type"), "0");
  dds::WrenchStamped wrench;
  wrench.torque = {4, 5, 6};
  encode(wrench, bytes);
  message = flat(OutputTopics::wrench("PUMA"), bytes);
  EXPECT_EQ(value(message, "wrench.torque.z"), "6");
  encode_log({5, 6}, LogLevel::warning, "kind", "what", bytes);
  message = flat(OutputTopics::log(), bytes);
  EXPECT_EQ(value(message, "level"), "30");
  EXPECT_EQ(value(message, "name"), "kind");
  EXPECT_EQ(value(message, "msg"), "what");
  EXPECT_EQ(value(message, "line"), "0");
}

TEST(RecordedMessages, CollisionsAreJsonWithTheNamesOfBodies) {
  ProximityState state;
  state.names = std::make_shared<const std::vector<std::string>>(std::vector<std::string>{"A", "B \"x\""});
  NearPair near;
  near.b = 1;
  near.distance_m = 0.25;
  state.near.push_back(near);
  TouchingPair touching;
  touching.b = 1;
  touching.depth_m = 0.01;
  state.touching.push_back(touching);
  const auto values = flatten_json(collisions_message(state));
  ASSERT_TRUE(values);
  EXPECT_EQ(value(*values, "near[0].b"), "B \"x\"");
  EXPECT_EQ(value(*values, "nearest_m"), "0.25");
  EXPECT_EQ(value(*values, "touching[0].depth_m"), "0.01");
}

TEST(RecordedMessages, SchemasOfJsonAreJson) {
  for (const TopicPtr& topic : {OutputTopics::collisions(), OutputTopics::collision_events(), OutputTopics::forces(),
                                OutputTopics::commands(), OutputTopics::status()}) {
    const auto values = flatten_json(topic->schema);
    ASSERT_TRUE(values) << topic->name;
    EXPECT_EQ(value(*values, "type"), "object");
  }
}

}  // namespace
}  // namespace cellmirror::app
