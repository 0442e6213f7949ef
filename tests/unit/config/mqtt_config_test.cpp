// [mqtt] of cell files: which broker, with what protection, and what it may do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"
#include "tests/unit/config/two_joint_arm.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

struct MqttConfigTest : testing::Test {
  MqttConfigTest() {
    for (const char* file : {"sec/ca.pem", "sec/own.pem", "sec/own.key", "sec/words"})
      std::filesystem::permissions(home.write(file, "x"), std::filesystem::perms{0600});
  }
  std::optional<LoadedCell> load(const std::string& keys) {
    diagnostics = {};
    return load_cell(home.write("cell.toml", "format = 1\nname = \"c\"\n" + keys), diagnostics);
  }
  MqttConfig accepted(const std::string& keys) {
    const auto sut = load("[mqtt]\n" + keys);
    EXPECT_TRUE(sut) << diagnostics.text();
    return sut ? sut->mqtt : MqttConfig();
  }
  std::string refusal(const std::string& keys) {
    EXPECT_FALSE(load("[mqtt]\n" + keys + "\n")) << keys;
    return diagnostics.text();
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(MqttConfigTest, IsOffWithoutTheTableAndTakesNoCommandsUnlessToldSo) {
  EXPECT_FALSE(load("")->mqtt.enabled);
  const MqttConfig config = accepted("broker = \"localhost\"");
  EXPECT_TRUE(config.enabled);
  EXPECT_FALSE(config.commands);
  EXPECT_FALSE(config.sparkplug);
  EXPECT_EQ(config.joint_states_hz, 0);
  EXPECT_FALSE(accepted("broker = \"localhost\"\nenabled = false").enabled);
}

TEST_F(MqttConfigTest, AnotherMachineMeansTls) {
  const MqttConfig elsewhere = accepted("broker = \"broker.example\"");
  EXPECT_TRUE(elsewhere.tls);
  EXPECT_EQ(elsewhere.port, 8883);
  const MqttConfig open = accepted("broker = \"10.0.0.1\"\ninsecure = true");
  EXPECT_FALSE(open.tls);
  EXPECT_EQ(open.port, 1883);
  for (const char* here : {"localhost", "127.0.0.1", "::1"})
    EXPECT_FALSE(accepted("broker = \"" + std::string(here) + "\"").tls);
  EXPECT_TRUE(accepted("broker = \"localhost\"\nca_file = \"sec/ca.pem\"").tls);
  EXPECT_THAT(refusal("broker = \"10.0.0.1\"\nport = 1883"), HasSubstr("insecure = true"));
  EXPECT_THAT(refusal("broker = \"localhost\"\nca_file = \"sec/ca.pem\"\ninsecure = true"), HasSubstr("remove one"));
}

TEST_F(MqttConfigTest, FilesAreInTheCellFolderAndSecretsTheOwnersAlone) {
  const std::string keys =
      "broker = \"b\"\nca_file = \"sec/ca.pem\"\ncertificate = \"sec/own.pem\"\nkey = \"sec/own.key\"\n"
      "credentials = \"sec/words\"\n";
  const MqttConfig config = accepted(keys);
  EXPECT_EQ(config.ca_file, (home.root() / "sec/ca.pem").string());
  EXPECT_EQ(config.credentials, (home.root() / "sec/words").string());
  for (const char* secret : {"sec/own.key", "sec/words"}) {
    const auto file = home.root() / secret;
    std::filesystem::permissions(file, std::filesystem::perms{0640});
    EXPECT_THAT(refusal(keys), HasSubstr("chmod 600 " + file.string()));
    std::filesystem::permissions(file, std::filesystem::perms{0600});
  }
  EXPECT_THAT(refusal("broker = \"b\"\ncertificate = \"sec/own.pem\""), HasSubstr("belong together"));
  EXPECT_FALSE(refusal("broker = \"b\"\ncredentials = \"../words\"").empty());
  EXPECT_FALSE(refusal("broker = \"b\"\ncredentials = \"sec/none\"").empty());
}

TEST_F(MqttConfigTest, NamesCannotChangeTheTopics) {
  for (const char* prefix : {"", "/a", "a/", "a//b", "a/+", "#", "$SYS", "a\\u0001"})
    EXPECT_THAT(refusal("broker = \"localhost\"\nprefix = \"" + std::string(prefix) + "\""),
                HasSubstr("cannot begin a topic"));
  EXPECT_EQ(accepted("broker = \"localhost\"\nprefix = \"plant/hall 2\"").prefix, "plant/hall 2");
  EXPECT_THAT(refusal("broker = \"localhost\"\nsparkplug = { group = \"a/b\", edge_node = \"n\" }"),
              HasSubstr("Sparkplug"));
  EXPECT_THAT(refusal("broker = \"localhost\"\nsparkplug = { group = \"a\" }"), HasSubstr("edge_node"));
  EXPECT_EQ(accepted("broker = \"localhost\"\nsparkplug = { group = \"a\", edge_node = \"n\" }").sparkplug->edge_node,
            "n");
}

// Hosts of Sparkplug may compare ids and names of metrics without regard to case.
TEST_F(MqttConfigTest, SparkplugNeedsNamesThatDifferByMoreThanCase) {
  std::string arm(kTwoJointArm);
  home.write("envlib/a.mpc", arm);
  arm.replace(arm.find("ARM"), 3, "Arm");
  home.write("envlib/b.mpc", arm);
  const std::string robots =
      "[[node]]\nname = \"A\"\nabstract = \"a.mpc\"\n[[node]]\nname = \"B\"\nabstract = \"b.mpc\"\n";
  const std::string mqtt = "broker = \"localhost\"\n";
  const std::string sparkplug = "sparkplug = { group = \"g\", edge_node = \"n\" }\n";
  accepted(mqtt + robots);
  const std::string text = refusal(mqtt + sparkplug + robots);
  EXPECT_THAT(text, HasSubstr("the robots ARM and Arm differ by case only"));
  EXPECT_THAT(text, HasSubstr("rename one of them"));
  accepted(mqtt + "enabled = false\n" + sparkplug + robots);
}

TEST_F(MqttConfigTest, SparkplugNeedsJointsThatDifferByMoreThanCaseWhereTheyAreSent) {
  std::string arm(kTwoJointArm);
  for (std::size_t at; (at = arm.find("J_1")) != std::string::npos;) arm.replace(at, 3, "j_2");
  home.write("envlib/a.mpc", arm);
  const std::string robots = "[[node]]\nname = \"A\"\nabstract = \"a.mpc\"\n";
  const std::string keys = "broker = \"localhost\"\nsparkplug = { group = \"g\", edge_node = \"n\" }\n";
  accepted(keys + robots);
  EXPECT_THAT(refusal(keys + "joint_states_hz = 5\n" + robots), HasSubstr("the joints j_2 and J_2 of ARM differ"));
}

}  // namespace
}  // namespace cellmirror
