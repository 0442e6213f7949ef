// Faults and control commands as people write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_devices/base/pacer.hpp"
#include "sim_devices/faults/fault_spec.hpp"
#include "sim_devices/robot/control_command.hpp"

namespace cellmirror::sim {
namespace {

using ::testing::HasSubstr;

TEST(FaultSpec, ReadsKindKeysAndWindow) {
  const auto sut = parse_fault("delay:s=0.05,jitter=0.01,p=0.5,robot=2,joint=3,only=sample@5..8");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->kind, FaultKind::delay);
  EXPECT_DOUBLE_EQ(sut->seconds, 0.05);
  EXPECT_DOUBLE_EQ(sut->jitter_s, 0.01);
  EXPECT_DOUBLE_EQ(sut->probability, 0.5);
  EXPECT_EQ(sut->robot, 2);
  EXPECT_EQ(sut->joint, 3);
  EXPECT_EQ(sut->only, MessageKind::sample);
  EXPECT_DOUBLE_EQ(sut->from_s, 5);
  EXPECT_DOUBLE_EQ(sut->until_s, 8);
}

TEST(FaultSpec, WindowsMayBeOpen) {
  EXPECT_DOUBLE_EQ(parse_fault("loss@5..")->from_s, 5);
  EXPECT_DOUBLE_EQ(parse_fault("loss@5")->from_s, 5);
  EXPECT_DOUBLE_EQ(parse_fault("loss@..8")->until_s, 8);
  for (const char* bad : {"loss@", "loss@..", "loss@8..5", "loss@5..5", "loss@x..y", "loss@-1..2", "loss@nan"}) {
    ASSERT_FALSE(parse_fault(bad)) << bad;
    EXPECT_THAT(parse_fault(bad).error().text(), HasSubstr("@START..END")) << bad;
  }
}

TEST(FaultSpec, EveryKindOfTheHelpPageIsReadByItsOwnExample) {
  const std::string help = fault_help();
  std::size_t examples = 0;
  for (std::size_t at = 0; (at = help.find("e.g. ", at)) != std::string::npos; ++examples) {
    at += 5;
    const std::string example = help.substr(at, help.find('\n', at) - at);
    EXPECT_TRUE(parse_fault(example)) << example;
  }
  EXPECT_EQ(examples, kFaultKinds);
}

TEST(FaultSpec, RefusesWithWhatWouldBeRight) {
  EXPECT_THAT(parse_fault("los").error().text(), HasSubstr("loss"));
  EXPECT_THAT(parse_fault("").error().text(), HasSubstr("faults: loss"));
  EXPECT_THAT(parse_fault("loss:q=1").error().text(), HasSubstr("its keys: p, every"));
  EXPECT_THAT(parse_fault("loss:p=2").error().text(), HasSubstr("from 0 to 1"));
  EXPECT_THAT(parse_fault("loss:p").error().text(), HasSubstr("from 0 to 1"));
  EXPECT_THAT(parse_fault("loss:every=1.5").error().text(), HasSubstr("whole number"));
  EXPECT_THAT(parse_fault("loss:only=tpdo").error().text(), HasSubstr("kinds: sample"));
  EXPECT_THAT(parse_fault("delay").error().text(), HasSubstr("delay needs s="));
  EXPECT_THAT(parse_fault("jump:joint=1").error().text(), HasSubstr("jump needs by="));
  EXPECT_THAT(parse_fault("frozen:p=0.5").error().text(), HasSubstr("robot, joint"));
  EXPECT_FALSE(parse_fault(std::string(2000, 'x')));
}

TEST(ControlCommand, ReadsEveryVerb) {
  EXPECT_TRUE(std::holds_alternative<AddFault>(*parse_control_command(" fault  loss:p=0.5@0..3 ")));
  EXPECT_TRUE(std::holds_alternative<EndFaults>(*parse_control_command("clear")));
  EXPECT_EQ(std::get<EndFaults>(*parse_control_command("clear 3")).id, 3);
  EXPECT_EQ(std::get<EndFaults>(*parse_control_command("clear wrong-id")).kind, FaultKind::wrong_id);
  EXPECT_EQ(std::get<EndFaults>(*parse_control_command("return")).kind, FaultKind::death);
  const auto emergency = std::get<SendEmergency>(*parse_control_command("emcy 0x8611 register=0x21 joint=3"));
  EXPECT_EQ(emergency.code, 0x8611);
  EXPECT_EQ(emergency.error_register, 0x21);
  EXPECT_EQ(emergency.source.joint, 3);
  const auto dead = std::get<AddFault>(*parse_control_command("die robot=2"));
  EXPECT_EQ(dead.spec.kind, FaultKind::death);
  EXPECT_EQ(dead.spec.robot, 2);
  EXPECT_TRUE(std::get<SetHeld>(*parse_control_command("hold")).held);
  EXPECT_FALSE(std::get<SetHeld>(*parse_control_command("go")).held);
  EXPECT_TRUE(std::holds_alternative<AskStatus>(*parse_control_command("status")));
  EXPECT_TRUE(std::holds_alternative<AskHelp>(*parse_control_command("help")));
  EXPECT_TRUE(std::holds_alternative<Quit>(*parse_control_command("quit\r")));
}

TEST(ControlCommand, RefusesWithWhatWouldBeRight) {
  EXPECT_THAT(parse_control_command("fualt loss").error().text(), HasSubstr("fault"));
  EXPECT_THAT(parse_control_command("fault").error().text(), HasSubstr("e.g. fault"));
  EXPECT_THAT(parse_control_command("fault los").error().text(), HasSubstr("loss"));
  EXPECT_THAT(parse_control_command("emcy").error().text(), HasSubstr("0x8611"));
  EXPECT_THAT(parse_control_command("emcy 0x10000").error().text(), HasSubstr("16 bits"));
  EXPECT_THAT(parse_control_command("die node=3").error().text(), HasSubstr("joint=N"));
  EXPECT_THAT(parse_control_command("clear x").error().text(), HasSubstr("clear KIND"));
  EXPECT_THAT(parse_control_command("quit now").error().text(), HasSubstr("no more parameters"));
  EXPECT_FALSE(parse_control_command(""));
  EXPECT_FALSE(parse_control_command(std::string(5000, 'a')));
  EXPECT_THAT(parse_control_command("\x01\xff").error().text(), HasSubstr("\\x01"));
}

TEST(Pacer, KeepsItsPhaseAndCountsWhatItMissed) {
  Pacer sut(Timestamp{1000}, Nanoseconds(100));
  EXPECT_FALSE(sut.due(Timestamp{999}));
  EXPECT_TRUE(sut.due(Timestamp{1000}));
  sut.advance(Timestamp{1030});
  EXPECT_EQ(sut.next(), Timestamp{1100});
  EXPECT_EQ(sut.missed(), 0U);
  sut.advance(Timestamp{1350});
  EXPECT_EQ(sut.next(), Timestamp{1400});
  EXPECT_EQ(sut.missed(), 2U);
}

}  // namespace
}  // namespace cellmirror::sim
