#include "drivers/mqtt/payloads.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cellmirror::mqtt {
namespace {

TEST(MqttPayloads, BirthAndLastWill) {
  EXPECT_EQ(
      birth_text({"c1", "default", "pc", "1.0"}, false, 1234),
      R"({"online":true,"cell":"c1","instance":"default","host":"pc","version":"1.0","commands":false,"time_ms":1234})");
  EXPECT_EQ(death_text("lost"), R"({"online":false,"reason":"lost"})");
}

TEST(MqttPayloads, Events) {
  ProximityEvent event;
  event.change = ProximityChange::touched;
  event.a = "x.R1.hand";
  event.b = "x.table";
  event.short_a = "R1.hand";
  EXPECT_EQ(
      collision_text({1, 1000}, event),
      R"({"event":"collision","number":1,"time_ms":1000,"change":"touched","a":"R1.hand","b":"x.table","distance_m":0})");
  const RobotSummary robot{.id = "R1", .mirrored = true, .state = DataState::lost, .age_s = 1.5};
  EXPECT_EQ(stream_text({2, 1001}, robot, DataState::fresh),
            R"({"event":"stream","number":2,"time_ms":1001,"robot":"R1","state":"lost","was":"fresh","age_s":1.5})");
  CellSummary summary;
  summary.loop.faults = 2;
  summary.loop.missed = 40;
  summary.reasons = {"the loop \"stood\" still"};
  EXPECT_EQ(
      fault_text({3, 1002}, summary),
      R"({"event":"fault","number":3,"time_ms":1002,"faults":2,"missed":40,"reasons":["the loop \"stood\" still"]})");
  EXPECT_EQ(alarm_text({4, 1003}, R"({"id":7})"), R"({"event":"alarm","number":4,"time_ms":1003,"alarm":{"id":7}})");
}

TEST(MqttPayloads, JointStates) {
  RobotState robot;
  robot.id = "R1";
  robot.online = true;
  robot.state = DataState::fresh;
  robot.joints.resize(2);
  robot.joints[0].name = "J1";
  robot.joints[0].position = 0.25;
  robot.joints[1].name = "J2";
  robot.joints[1].velocity = -1;
  robot.joints[1].effort = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(joint_states_text(robot, 5),
            R"({"time_ms":5,"robot":"R1","mode":"mirrored","state":"fresh","name":["J1","J2"],"position":[0.25,0],)"
            R"("velocity":[0,-1],"effort":[0,null]})");
}

TEST(MqttPayloads, AnswersCarryTheIdOfTheirCommand) {
  EXPECT_EQ(reply_text("\"a\"", true, "", 9), R"({"done":true,"text":"","time_ms":9,"id":"a"})");
  EXPECT_EQ(reply_text("", false, "why", 9), R"({"done":false,"text":"why","time_ms":9})");
  EXPECT_LT(reply_text("1", false, std::string(100'000, 'x'), 9).size(), 5000U);
}

}  // namespace
}  // namespace cellmirror::mqtt
