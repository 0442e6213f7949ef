// What check and start say about the streams of a cell.
#include "app/io/robot_streams.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cellmirror::app {
namespace {

std::string findings_of(const RobotStream& stream) {
  Diagnostics found;
  check_robot_stream(stream, found);
  return found.text();
}

TEST(RobotStreams, WarnOfJointsWithoutAPosition) {
  RobotStream sut;
  sut.robot = "ABB";
  sut.config = DbcStreamConfig{};
  sut.place = {"cell.toml", 16, 1};
  EXPECT_EQ(findings_of(sut), "");
  sut.joints_without_position = {"joint_6"};
  EXPECT_EQ(
      findings_of(sut),
      "cell.toml:16:1: warning: stream of ABB: nothing gives the position of joint_6; it stays at its start position; "
      "add a [[stream.signal]]\n");
  sut.config = Cia402StreamConfig{};
  sut.joints_without_position = {"joint_5", "joint_6"};
  EXPECT_THAT(findings_of(sut),
              testing::HasSubstr("of joint_5, joint_6; they stay at their start positions; add a [[stream.node]]"));
}

TEST(RobotStreams, TellTheMistakesThatTheDriverFindsAtTheirPlace) {
  Cia402StreamConfig config;
  Cia402NodeConfig node;
  node.node_id = 3;
  node.joint_name = "J_1";
  node.place = {"cell.toml", 20, 1};
  node.tpdos = {{.number = 1, .entries = {{0x6041, 0, 16}}}};
  config.nodes = {node};
  RobotStream sut;
  sut.robot = "ABB";
  sut.config = config;
  EXPECT_THAT(findings_of(sut),
              testing::HasSubstr("cell.toml:20:1: error: stream of ABB: node 3 (J_1): no TPDO holds"));
}

}  // namespace
}  // namespace cellmirror::app
