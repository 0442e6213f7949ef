// What programs of ROS 2 see of the gateway: type hashes and names of nodes, read by Cyclone DDS.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cyclone_peer.hpp"
#include "drivers/dds/dds_output.hpp"
#include "drivers/dds/presence.hpp"
#include "own_network.hpp"
#include "waiting.hpp"

namespace cellmirror::dds::test {
namespace {

class DdsPresenceTest : public testing::Test {
 protected:
  void TearDown() override { set_ros_presence({}); }
  [[nodiscard]] std::unique_ptr<DdsOutput> output() const {
    DdsOutputConfig config;
    config.enabled = true;
    config.domain = domain_;
    auto made = make_dds_output(config);
    EXPECT_TRUE(made.has_value()) << made.error().text();
    return std::move(*made);
  }
  int domain_ = test_domain(6);
};

TEST_F(DdsPresenceTest, WritersAnnounceTheHashOfTheirType) {
  const auto sut = output();
  CyclonePeer peer(domain_);
  std::vector<std::string> data;
  ASSERT_TRUE(eventually([&] {
    data = peer.user_data_of_writers("rt/cellmirror/joint_states");
    return !data.empty();
  }));
  EXPECT_EQ(data.front(), "typehash=RIHS01_a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e;");
}

TEST_F(DdsPresenceTest, HumbleHasNoHashes) {
  set_ros_presence({.distribution = RosDistribution::humble});
  const auto sut = output();
  CyclonePeer peer(domain_);
  std::vector<std::string> data;
  ASSERT_TRUE(eventually([&] {
    data = peer.user_data_of_writers("rt/cellmirror/joint_states");
    return !data.empty() || !peer.guids_of_writers("rt/cellmirror/joint_states").empty();
  }));
  EXPECT_TRUE(data.empty() || data.front().empty());
}

TEST_F(DdsPresenceTest, TheNodeHasItsReadersAndWriters) {
  set_ros_presence({.distribution = RosDistribution::jazzy, .node_name = "my_cell"});
  const auto sut = output();
  CyclonePeer peer(domain_);
  const dds_entity_t reader = peer.node_reader();
  std::vector<PlainNode> nodes;
  ASSERT_TRUE(eventually([&] {
    nodes = CyclonePeer::take_nodes(reader);
    return !nodes.empty();
  }));
  EXPECT_EQ(nodes.back().space, "/");
  EXPECT_EQ(nodes.back().name, "my_cell");
  EXPECT_TRUE(nodes.back().readers.empty());
  std::vector<std::array<std::uint8_t, 16>> writers;
  ASSERT_TRUE(eventually([&] {
    writers = peer.guids_of_writers("rt/tf");
    return !writers.empty();
  }));
  EXPECT_NE(std::ranges::find(nodes.back().writers, writers.front()), nodes.back().writers.end());
}

TEST_F(DdsPresenceTest, NothingIsToldOfNodesWhereTheDistributionIsNotKnown) {
  const auto sut = output();
  CyclonePeer peer(domain_);
  ASSERT_TRUE(eventually([&] { return !peer.guids_of_writers("rt/tf").empty(); }));
  EXPECT_TRUE(peer.guids_of_writers("ros_discovery_info").empty());
}

}  // namespace
}  // namespace cellmirror::dds::test
