// [[io_node]] and [[light_barrier]] in cell files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/config/two_joint_arm.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

struct IoConfig : testing::Test {
  IoConfig() { home.write("envlib/arm.mpc", kTwoJointArm); }
  std::optional<LoadedCell> load(const std::string& text) {
    diagnostics = {};
    return load_cell(home.write("cell.toml",
                                "format = 1\nname = \"c\"\n"
                                "[[node]]\nname = \"Arm\"\nabstract = \"arm.mpc\"\n"
                                "[[node]]\nname = \"Left\"\n[[node]]\nname = \"Right\"\nparent = \"Left\"\n"
                                "xyz_m = [1, 0, 0]\n"
                                "[[node]]\nname = \"Echo\"\ntype = \"sensor\"\n" +
                                    text),
                     diagnostics);
  }
  void expect_error(const std::string& text, const std::string& message) {
    EXPECT_FALSE(load(text)) << text;
    EXPECT_THAT(diagnostics.text(), HasSubstr(message));
  }

  TemporaryHome home;
  Diagnostics diagnostics;
};

const std::string kBarrier = "[[light_barrier]]\nname = \"gate\"\nfrom = \"Left\"\nto = \"Right\"\n";
const std::string kNode = "[[io_node]]\nid = 20\nchannel = \"socketcan:can0\"\n";

TEST_F(IoConfig, ReadsANode) {
  const auto sut = load(kBarrier + "beam_m = 0.02\n" + kNode +
                        "heartbeat_s = 0.2\nperiod_s = 0.002\n"
                        "[[io_node.input]]\nbit = 0\nbarrier = \"gate\"\ninverted = true\n"
                        "[[io_node.input]]\nbit = 31\nrobot = \"ARM\"\njoint = \"J_1\"\nabove_rad = 1.5\n"
                        "[[io_node.input]]\nbit = 2\nrobot = \"ARM\"\njoint = \"J_2\"\nbelow_m = 0.1\n"
                        "[[io_node.analogue]]\nchannel = 8\nsensor = \"Echo\"\nfull_scale_m = 2.0\n"
                        "[[io_node.output]]\nbit = 0\nrobot = \"ARM\"\njoint = \"J_2\"\non_m = 0.8\noff_m = 0.2\n"
                        "[[io_node.output]]\nbit = 1\non = \"CONNECT Left TO Arm\"\noff = \"DISCONNECT Left\"\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  ASSERT_EQ(sut->barriers.size(), 1U);
  EXPECT_EQ(sut->barriers[0].name, "gate");
  EXPECT_EQ(sut->barriers[0].from, "Left");
  EXPECT_EQ(sut->barriers[0].to, "Left.Right") << "the full path";
  EXPECT_EQ(sut->barriers[0].radius, 0.01);
  ASSERT_EQ(sut->io_nodes.size(), 1U);
  const IoNodeConfig& node = sut->io_nodes[0];
  EXPECT_EQ(node.node_id, 20);
  EXPECT_EQ(node.channel.endpoint, "socketcan:can0");
  EXPECT_EQ(node.heartbeat_ms, 200);
  EXPECT_EQ(node.period, Nanoseconds(2'000'000));
  ASSERT_EQ(node.inputs.size(), 3U);
  EXPECT_EQ(std::get<BarrierInput>(node.inputs[0].source).barrier, "gate");
  EXPECT_TRUE(node.inputs[0].inverted);
  const auto& above = std::get<JointInput>(node.inputs[1].source);
  EXPECT_EQ(node.inputs[1].bit, 31U);
  EXPECT_EQ(above.robot, "ARM");
  EXPECT_EQ(above.joint, 0U);
  EXPECT_TRUE(above.above);
  EXPECT_EQ(above.position, 1.5);
  EXPECT_FALSE(std::get<JointInput>(node.inputs[2].source).above);
  ASSERT_EQ(node.analogues.size(), 1U);
  EXPECT_EQ(node.analogues[0].channel, 7U);
  EXPECT_EQ(node.analogues[0].full_scale, 2);
  ASSERT_EQ(node.outputs.size(), 2U);
  const auto& joint = std::get<JointOutput>(node.outputs[0].target);
  EXPECT_EQ(joint.joint, 1U);
  EXPECT_EQ(joint.on, 0.8);
  EXPECT_EQ(joint.off, 0.2);
  EXPECT_EQ(std::get<CommandOutput>(node.outputs[1].target).off, "DISCONNECT Left");
}

TEST_F(IoConfig, RefusesWhatIsNotThere) {
  expect_error(kNode + "[[io_node.input]]\nbit = 0\nbarrier = \"gate\"\n", "there is no light barrier gate");
  expect_error(kNode + "[[io_node.input]]\nbit = 0\nrobot = \"ARN\"\njoint = \"J_1\"\nabove_rad = 1\n",
               "there is no robot ARN");
  expect_error(kNode + "[[io_node.output]]\nbit = 0\nrobot = \"ARM\"\njoint = \"J_3\"\non_rad = 1\noff_rad = 0\n",
               "no joint J_3");
  expect_error(kNode + "[[io_node.analogue]]\nchannel = 1\nsensor = \"Eco\"\nfull_scale_m = 1\n",
               "there is no ultrasonic sensor Eco");
  expect_error("[[light_barrier]]\nname = \"gate\"\nfrom = \"Left\"\nto = \"Rihgt\"\n", "Rihgt");
}

TEST_F(IoConfig, RefusesWhatContradicts) {
  expect_error(
      kNode + "[[io_node.output]]\nbit = 3\non = \"STOP_ALL\"\n[[io_node.output]]\nbit = 3\non = \"STOP_ALL\"\n",
      "another entry has the bit 3");
  expect_error(kNode + "[[io_node.output]]\nbit = 3\n", "the output does nothing");
  expect_error(kNode + "[[io_node.input]]\nbit = 0\nrobot = \"ARM\"\njoint = \"J_1\"\n", "above_rad or below_rad");
  expect_error(kNode + "[[io_node.input]]\nbit = 32\nbarrier = \"gate\"\n" + kBarrier, "bit");
  expect_error(kNode + kNode, "another I/O node on the channel has the id 20");
  expect_error(kBarrier + kBarrier, "another light barrier is called gate");
  expect_error("[[light_barrier]]\nname = \"gate\"\nfrom = \"Left\"\nto = \"Left\"\n", "the same frame");
  expect_error("[[io_node]]\nid = 20\nchannel = \"log:a.log\"\n", "log");
}

}  // namespace
}  // namespace cellmirror
