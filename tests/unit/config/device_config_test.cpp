// [[device]] in cell files: a robot as the drives of a controller.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/config/two_joint_arm.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

struct DeviceConfig : testing::Test {
  DeviceConfig() { home.write("envlib/arm.mpc", kTwoJointArm); }
  // The robot "ARM" as a device on a channel; `nodes` and more follow.
  std::optional<LoadedCell> load(const std::string& nodes, const std::string& channel = "socketcan:can0") {
    diagnostics = {};
    return load_cell(home.write("cell.toml",
                                "format = 1\nname = \"c\"\n[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n"
                                "[[device]]\nrobot = \"ARM\"\nprotocol = \"cia402\"\nchannel = \"" +
                                    channel + "\"\n" + nodes),
                     diagnostics);
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

constexpr const char* kNode1 = "[[device.node]]\nid = 11\njoint = \"J_1\"\nencoder_increments = 4096\n";

TEST_F(DeviceConfig, TakesLimitsFromTheJoint) {
  const auto sut = load(std::string("heartbeat_s = 0.1\n") + kNode1 + "gear_motor_turns = 100\ngear_shaft_turns = 2\n" +
                        "[[device.node]]\nid = 12\njoint = \"J_2\"\nencoder_increments = 1000\nfeed_m = 0.02\n" +
                        "wait_for_lss = true\nmass_kg = 5\nrated_force_n = 80\nhome_switch_m = [0.2, "
                        "0.3]\nsoftware_limits_m = [0.1, 0.9]\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  const auto& device = std::get<Cia402DeviceConfig>(sut->streams.at(0).config);
  EXPECT_EQ(sut->streams.at(0).robot, "ARM");
  EXPECT_EQ(device.heartbeat_ms, 100);
  EXPECT_EQ(device.period, Nanoseconds(1'000'000));
  const DriveConfig& turning = device.nodes.at(0);
  EXPECT_NEAR(turning.increments_per_unit(), 4096 * 50 / (2 * std::numbers::pi), 1e-9);
  EXPECT_EQ(turning.software_limits.lower, -1);
  EXPECT_EQ(turning.software_limits.upper, 2);
  ASSERT_TRUE(turning.stops);
  EXPECT_NEAR(turning.stops->upper, 2.06, 1e-12);
  EXPECT_EQ(turning.velocity, 3);
  EXPECT_EQ(turning.acceleration, 20);
  EXPECT_EQ(turning.rated_torque, 40) << "twice what 20 rad/s2 of 1 kg m2 need";
  const DriveConfig& sliding = device.nodes.at(1);
  EXPECT_EQ(sliding.joint, 1U);
  EXPECT_TRUE(sliding.waits_for_lss);
  EXPECT_FALSE(turning.waits_for_lss);
  EXPECT_NEAR(sliding.increments_per_unit(), 50'000, 1e-9);
  EXPECT_EQ(sliding.inertia, 5);
  EXPECT_EQ(sliding.rated_torque, 80);
  EXPECT_EQ(sliding.home_switch->upper, 0.3);
  EXPECT_EQ(sliding.software_limits.upper, 0.9);
}

TEST_F(DeviceConfig, RefusesWhatNoDriveCanBe) {
  const std::string node = kNode1;
  const std::pair<std::string, const char*> wrong[] = {
      {"", "no drives are given"},
      {"[[device.node]]\nid = 11\njoint = \"J_1\"\n", "encoder_increments"},
      {"[[device.node]]\nid = 11\njoint = \"J_2\"\nencoder_increments = 10\n", "feed_m"},
      {"[[device.node]]\nid = 128\njoint = \"J_1\"\nencoder_increments = 10\n", "id"},
      {node + "inertia_kg_m2 = 0\n", "inertia_kg_m2"},
      {node + "sign = 0\n", "sign is 0"},
      {node + "stops_rad = [1, -1]\n", "stops_rad ends before it begins"},
      {node + "encoder_turns = 3\n", "encoder_turns"},
      {node + "gear_motor_turns = 4000000000\n", "more increments than 32 bits"},
      {node + node, "two nodes have the id 11"},
      {"period_s = 0.0001\n" + node, "period_s is at least"},
      {node + "[[stream]]\nrobot = \"ARM\"\nkind = \"dds\"\n", "there is another stream or device of ARM"}};
  for (const auto& [text, expected] : wrong) {
    EXPECT_FALSE(load(text)) << text;
    EXPECT_THAT(diagnostics.text(), HasSubstr(expected)) << text;
  }
  EXPECT_FALSE(load(node, "log:none.log"));
}

TEST_F(DeviceConfig, RefusesANodeThatTwoTablesHaveOnOneChannel) {
  const std::string node = kNode1;
  const auto io_node = [](const std::string& channel, int id) {
    return "[[io_node]]\nid = " + std::to_string(id) + "\nchannel = \"" + channel + "\"\n";
  };
  EXPECT_FALSE(load(node + io_node("socketcan:can0", 11)));
  EXPECT_THAT(diagnostics.text(), HasSubstr("the drives of ARM have a node 11 on the channel socketcan:can0 too"));
  EXPECT_TRUE(load(node + io_node("socketcan:can0", 12))) << diagnostics.text();
  EXPECT_TRUE(load(node + io_node("socketcan:can1", 11))) << diagnostics.text();

  const std::string second =
      "[[node]]\nname = \"Arm2\"\nabstract = \"arm.mpc\"\nrobot_id = \"ARM_2\"\n"
      "[[device]]\nrobot = \"ARM_2\"\nprotocol = \"cia402\"\nchannel = \"socketcan:can0\"\n";
  EXPECT_FALSE(load(node + second + node));
  EXPECT_THAT(diagnostics.text(), HasSubstr("the drives of ARM have a node 11"));
}

}  // namespace
}  // namespace cellmirror
