// What the gateway tells programs of ROS 2 of itself.
#include "drivers/dds/ros_graph.hpp"

#include <gtest/gtest.h>

#include "drivers/dds/controller_messages.hpp"
#include "drivers/dds/ros2_messages.hpp"
#include "drivers/dds/type_hashes.hpp"

namespace cellmirror::dds {
namespace {

TEST(TypeHashes, AreAnnouncedAsRmwDoes) {
  EXPECT_EQ(type_user_data(kJointStateType, RosDistribution::jazzy),
            "typehash=RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e;");
  EXPECT_EQ(type_user_data(kJointStateType, RosDistribution::humble), "") << "it has none";
  EXPECT_EQ(type_user_data("x::msg::dds_::Y_", RosDistribution::jazzy), "");
  EXPECT_NE(type_hash(kFeedbackType, RosDistribution::jazzy), type_hash(kFeedbackType, RosDistribution::kilted));
  for (const std::string_view type :
       {kTfMessageType, kControllerStateType, kSendGoalRequestType, kCancelReplyType, kGoalStatusType, kRosGraphType})
    EXPECT_EQ(type_hash(type, RosDistribution::kilted).size(), 64U) << type;
}

TEST(RosGraph, HasGidsOfTheDistribution) {
  RosGraph graph;
  graph.participant.fill(1);
  graph.node = "n";
  graph.readers.push_back(Guid{2});
  graph.writers.resize(2);
  std::vector<std::byte> jazzy;
  std::vector<std::byte> humble;
  encode(graph, RosDistribution::jazzy, jazzy);
  encode(graph, RosDistribution::humble, humble);
  // Header, participant, one node, "/", "n", one reader, two writers.
  const std::size_t texts = 4 + (4 + 2) + 2 + (4 + 2) + 2;
  EXPECT_EQ(jazzy.size(), 4 + 16 + texts + 4 + 16 + 4 + 2 * 16U);
  EXPECT_EQ(humble.size(), 4 + 24 + texts + 4 + 24 + 4 + 2 * 24U);
  EXPECT_EQ(humble[4 + 15], std::byte{1});
  EXPECT_EQ(humble[4 + 16], std::byte{0}) << "the rest of a Gid is zero";
}

// Lengths of the two layouts, counted by hand: each point of n joints with accelerations takes 4 + 8n three times, 4
// for no effort and 8 for the time.
TEST(ControllerMessages, DifferByTheDistribution) {
  const std::vector<std::string> joints = {"abc"};
  ControllerState state;
  state.reference = {{1, 2, 3}};
  state.feedback = {{4, 5, 6}};
  const ControllerMessage message{{1, 2}, joints, state};
  std::vector<std::byte> humble;
  std::vector<std::byte> jazzy;
  encode(message, RosDistribution::humble, humble);
  encode(message, RosDistribution::jazzy, jazzy);
  EXPECT_GT(humble.size(), jazzy.size());
  std::vector<std::byte> feedback;
  std::vector<std::byte> with_index;
  encode_feedback({}, message, RosDistribution::jazzy, feedback);
  encode_feedback({}, message, RosDistribution::kilted, with_index);
  EXPECT_EQ(with_index.size(), feedback.size() + 8);
}

}  // namespace
}  // namespace cellmirror::dds
