// [dds] of a cell file: how peers are found, and partitions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/config/two_joint_arm.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

struct DdsNetworkConfigTest : testing::Test {
  DdsNetworkConfigTest() { home.write("envlib/arm.mpc", kTwoJointArm); }
  std::optional<LoadedCell> load(const std::string& tables) {
    diagnostics = {};
    const std::string node = "format = 1\nname = \"c\"\n[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n";
    return load_cell(home.write("cell.toml", node + tables), diagnostics);
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(DdsNetworkConfigTest, PeersFindEachOtherByMulticastUnlessSaidOtherwise) {
  const auto cell = load("[dds_output]\n");
  ASSERT_TRUE(cell) << diagnostics.text();
  EXPECT_EQ(cell->dds_network, DdsNetworkConfig{});
  EXPECT_TRUE(cell->dds_network.multicast);
  EXPECT_EQ(cell->dds.summary_topic, "rt/cellmirror/summary");
  EXPECT_EQ(cell->dds.partition, "");
}

TEST_F(DdsNetworkConfigTest, TheNumberOfAServerIsItsPlace) {
  const auto cell = load("[dds]\ndiscovery_servers = [\"10.0.0.5\", \"\", \"10.0.0.6:14520\"]\nlink = \"lossy\"\n");
  ASSERT_TRUE(cell) << diagnostics.text();
  const std::vector<DdsServer> expected = {{"10.0.0.5", 11811, 0}, {"10.0.0.6", 14520, 2}};
  EXPECT_EQ(cell->dds_network.discovery_servers, expected);
  EXPECT_EQ(cell->dds_network.link, DdsLink::lossy);
}

TEST_F(DdsNetworkConfigTest, PeersMayHaveAPort) {
  const auto cell = load("[dds]\npeers = [\"10.0.0.5\", \"10.0.0.6:7410\"]\nmulticast = false\n");
  ASSERT_TRUE(cell) << diagnostics.text();
  const std::vector<DdsPeer> expected = {{"10.0.0.5", 0}, {"10.0.0.6", 7410}};
  EXPECT_EQ(cell->dds_network.peers, expected);
  EXPECT_FALSE(cell->dds_network.multicast);
}

TEST_F(DdsNetworkConfigTest, PartitionsOfOutputsAndStreams) {
  const auto cell = load(
      "[dds_output]\npartition = \"cell_7\"\nsummary_topic = \"/plant/summary\"\n"
      "[[stream]]\nrobot = \"ARM\"\nkind = \"dds\"\npartition = \"robots\"\n");
  ASSERT_TRUE(cell) << diagnostics.text();
  EXPECT_EQ(cell->dds.partition, "cell_7");
  EXPECT_EQ(cell->dds.summary_topic, "rt/plant/summary");
  EXPECT_EQ(std::get<DdsStreamConfig>(cell->streams.at(0).config).partition, "robots");
}

TEST_F(DdsNetworkConfigTest, WrongAddressesAreNamedWithTheirPlace) {
  EXPECT_FALSE(load("[dds]\ndiscovery_servers = [\"plant-server\"]\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("cell.toml:7:"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("\"plant-server\" is no IPv4 address"));
  for (const char* wrong :
       {"10.0.0.5:0", "10.0.0.5:65536", "10.0.0.5:", "10.0.0:1", "10.0.0.5:+1", "10.0.0.5:0x10", ""}) {
    EXPECT_FALSE(load(std::string("[dds]\npeers = [\"") + wrong + "\"]\n")) << wrong;
  }
}

TEST_F(DdsNetworkConfigTest, AClientOfServersHasNoOtherPeers) {
  EXPECT_FALSE(load("[dds]\ndiscovery_servers = [\"10.0.0.5\"]\npeers = [\"10.0.0.6\"]\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("a client of discovery servers finds its peers by them alone"));
  EXPECT_FALSE(load("[dds]\ndiscovery_servers = [\"10.0.0.5\"]\nmulticast = false\n"));
}

TEST_F(DdsNetworkConfigTest, ListsAreBounded) {
  std::string many = "[";
  for (int i = 0; i < 65; ++i) many += "\"10.0.0.5\", ";
  EXPECT_FALSE(load("[dds]\npeers = " + many + "]\n"));
  EXPECT_THAT(diagnostics.text(), HasSubstr("65 entries; the limit is 64"));
}

TEST_F(DdsNetworkConfigTest, APartitionHasNoWildcards) {
  for (const char* wrong : {"", "cell*", "cell?", "cell[1]", "a\\nb"})
    EXPECT_FALSE(load(std::string("[dds_output]\npartition = \"") + wrong + "\"\n")) << wrong;
}

}  // namespace
}  // namespace cellmirror
