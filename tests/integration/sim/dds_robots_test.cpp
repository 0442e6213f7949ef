// sim_robot's JointState as Cyclone DDS hears it: an independent implementation with types from its own IDL compiler.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "cyclone_peer.hpp"
#include "own_network.hpp"

namespace cellmirror::sim {
namespace {

using dds::test::CyclonePeer;
using dds::test::PlainJointState;
using ::testing::ElementsAre;

// Runs sim_robot to its end; the report that it prints.
std::string output_of(const std::string& arguments) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "sim_robot";
  FILE* pipe = popen((program.string() + " " + arguments).c_str(), "r");
  if (pipe == nullptr) return {};
  std::string output;
  std::array<char, 4096> buffer{};
  while (fgets(buffer.data(), buffer.size(), pipe) != nullptr) output += buffer.data();
  pclose(pipe);
  return output;
}

class DdsRobotsTest : public ::testing::Test {
 public:
  // All that the reader gets while sim_robot runs, and what sim_robot says it sent. What is sent before the reader has
  // found the writer too is lost, as DDS has it for volatile data; then it runs once more.
  void run(const std::string& arguments, const std::string& topic = "rt/joint_states") {
    for (int attempt = 0; attempt < 5; ++attempt) {
      heard.clear();
      run_once(arguments, topic);
      if (HasFatalFailure() || all_arrived()) return;
    }
  }

  void run_once(const std::string& arguments, const std::string& topic) {
    const dds_entity_t reader = peer.joint_state_reader(topic, true);
    auto output = std::async(
        std::launch::async, output_of,
        "dds --domain " + std::to_string(domain) + " --wait-for-reader 60 --json --no-input --quiet " + arguments);
    const auto take = [&] {
      for (PlainJointState& message : CyclonePeer::take_joint_states(reader)) heard.push_back(std::move(message));
    };
    while (output.wait_for(std::chrono::milliseconds(2)) != std::future_status::ready) take();
    report = nlohmann::json::parse(output.get(), nullptr, false);
    ASSERT_TRUE(report.is_object());
    // What was sent last may still be on its way.
    for (int i = 0; i < 500 && !all_arrived(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      take();
    }
  }

  [[nodiscard]] bool all_arrived() const {
    return heard.size() >= report["sent"]["sample"].get<std::size_t>() + report["sent"]["foreign"].get<std::size_t>();
  }

  [[nodiscard]] std::uint64_t applied(std::size_t fault) const {
    return report["channels"][0]["faults"][fault]["applied"].get<std::uint64_t>();
  }

  int domain = dds::test::test_domain(0);
  CyclonePeer peer{domain};
  std::vector<PlainJointState> heard;
  nlohmann::json report;
};

double stamp_s(const PlainJointState& message) { return message.sec + 1e-9 * message.nanosec; }

TEST_F(DdsRobotsTest, EachSampleArrivesAndPositionsBelongToTheirStamps) {
  run("--joint-names a,b --rate 200 --for 1 --motion ramp:velocity=0.5");
  ASSERT_GT(heard.size(), 10U);  // 200, if the machine is never late
  EXPECT_EQ(heard.size(), report["sent"]["sample"].get<std::size_t>());
  EXPECT_EQ(report["refused"], 0);
  for (const PlainJointState& message : heard) {
    EXPECT_THAT(message.name, ElementsAre("a", "b"));
    ASSERT_EQ(message.position.size(), 2U);
    EXPECT_DOUBLE_EQ(message.velocity.at(1), 0.5);
    EXPECT_EQ(message.effort.size(), 2U);
    const double moved = message.position[0] - heard.front().position[0];
    EXPECT_NEAR(moved, 0.5 * (stamp_s(message) - stamp_s(heard.front())), 1e-4);
  }
}

TEST_F(DdsRobotsTest, SeveralRobotsShareATopicWithNamesOfTheirOwn) {
  run("--robots 3 --joints 2 --rate 50 --for 0.5 --motion hold:position=1");
  std::map<std::string, int> samples;
  for (const PlainJointState& message : heard) ++samples[message.name.at(0)];
  EXPECT_THAT(samples,
              ::testing::UnorderedElementsAre(::testing::Key("robot1_joint_1"), ::testing::Key("robot2_joint_1"),
                                              ::testing::Key("robot3_joint_1")));
  EXPECT_EQ(heard.size(), report["sent"]["sample"].get<std::size_t>());
}

TEST_F(DdsRobotsTest, ATopicARobotWhereTheNameSaysSo) {
  run("--robots 1 --first-robot 7 --topic 'rt/robot{}/joint_states' --joint-names a --for 0.3",
      "rt/robot7/joint_states");
  ASSERT_FALSE(heard.empty());
  EXPECT_THAT(heard.front().name, ElementsAre("a"));
}

TEST_F(DdsRobotsTest, NanStrikesAsOftenAsItsCounterSays) {
  run("--joints 3 --rate 100 --for 1 --fault nan:joint=2,every=4");
  std::uint64_t spoilt = 0;
  for (const PlainJointState& message : heard) {
    EXPECT_TRUE(std::isfinite(message.position.at(0)));
    spoilt += std::isnan(message.position.at(1)) ? 1 : 0;
  }
  EXPECT_GT(spoilt, 0U);
  EXPECT_EQ(spoilt, applied(0));
}

TEST_F(DdsRobotsTest, LostSamplesAreCountedAndMissing) {
  run("--joints 1 --rate 100 --for 1 --fault loss:every=2");
  EXPECT_EQ(heard.size(), report["sent"]["sample"].get<std::size_t>());
  EXPECT_NEAR(static_cast<double>(applied(0)), static_cast<double>(heard.size()), 1.0);
}

TEST_F(DdsRobotsTest, WrongLengthWrongNameAndStrangers) {
  run("--joints 3 --rate 100 --for 1 --fault wrong-length:by=-1,every=3 --fault wrong-id:every=5 "
      "--fault insert:rate=20,count=7");
  std::uint64_t shorter = 0;
  std::uint64_t renamed = 0;
  std::uint64_t strangers = 0;
  for (const PlainJointState& message : heard) {
    const bool stranger = message.name.at(0).starts_with("stranger_");
    strangers += stranger ? 1 : 0;
    renamed += message.name.at(0).starts_with("wrong_") ? 1 : 0;
    shorter += !stranger && message.position.size() == 2 ? 1 : 0;
  }
  EXPECT_EQ(shorter, applied(0));
  EXPECT_EQ(renamed, applied(1));
  EXPECT_EQ(strangers, 7U);
}

TEST_F(DdsRobotsTest, DelayedSamplesKeepTheirStamps) {
  run("--joints 1 --rate 100 --for 1 --motion ramp:velocity=1 --fault reorder:every=4,n=2");
  int backwards = 0;
  for (std::size_t i = 1; i < heard.size(); ++i) backwards += stamp_s(heard[i]) < stamp_s(heard[i - 1]) ? 1 : 0;
  EXPECT_GT(backwards, 0);
}

TEST_F(DdsRobotsTest, ADeadRobotIsSilentForItsWindow) {
  run("--joints 1 --rate 100 --for 1.2 --fault death@0.4..0.8");
  double longest = 0;
  for (std::size_t i = 1; i < heard.size(); ++i) longest = std::max(longest, stamp_s(heard[i]) - stamp_s(heard[i - 1]));
  EXPECT_GE(longest, 0.38);
}

}  // namespace
}  // namespace cellmirror::sim

int main(int argc, char** argv) {
  if (!cellmirror::dds::test::enter_own_network()) {
    std::printf("no network namespace of our own on this machine: using its loopback\n");
  }
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
