// The transitions of CiA 402-2, 6.4.2, by their numbers.
#include "drivers/can/cia402/device/power_state.hpp"

#include <gtest/gtest.h>

namespace cellmirror::can {
namespace {

using enum Cia402State;

struct PowerStateTest : testing::Test {
  PowerState sut;
  ServoParameters parameters;

  void command(std::uint16_t word) { sut.command(word, parameters); }
  void to_operation_enabled() {
    sut.reset();
    sut.started();
    command(kControlwordShutdown);
    command(kControlwordSwitchOn);
    command(kControlwordEnableOperation);
    ASSERT_EQ(sut.state(), operation_enabled);
  }
};

TEST_F(PowerStateTest, Transitions0To4LeadToOperation) {
  sut.reset();
  EXPECT_EQ(sut.state(), not_ready_to_switch_on);  // 0
  command(kControlwordShutdown);
  EXPECT_EQ(sut.state(), not_ready_to_switch_on) << "a drive that tests itself obeys nobody";
  sut.started();
  EXPECT_EQ(sut.state(), switch_on_disabled);  // 1
  command(kControlwordShutdown);
  EXPECT_EQ(sut.state(), ready_to_switch_on);  // 2
  command(kControlwordSwitchOn);
  EXPECT_EQ(sut.state(), switched_on);  // 3
  EXPECT_FALSE(sut.is_powered());
  command(kControlwordEnableOperation);
  EXPECT_EQ(sut.state(), operation_enabled);  // 4
  EXPECT_TRUE(sut.is_powered());
}

TEST_F(PowerStateTest, Transition5StopsFirst) {
  to_operation_enabled();
  command(kControlwordSwitchOn);
  EXPECT_EQ(sut.state(), operation_enabled);
  EXPECT_EQ(sut.stopping(), StopRamp::slow_down);
  sut.stands(parameters);
  EXPECT_EQ(sut.state(), switched_on);
  EXPECT_FALSE(sut.stopping());

  parameters.disable_option = 0;
  to_operation_enabled();
  command(kControlwordSwitchOn);
  EXPECT_EQ(sut.state(), switched_on) << "without a ramp at once";
}

TEST_F(PowerStateTest, EnableOperationCallsTheStopOfTransition5Off) {
  to_operation_enabled();
  command(kControlwordSwitchOn);
  command(kControlwordEnableOperation);
  EXPECT_EQ(sut.state(), operation_enabled);
  EXPECT_FALSE(sut.stopping());
}

TEST_F(PowerStateTest, Transitions6And7GoBackStepByStep) {
  sut.started();
  command(kControlwordShutdown);
  command(kControlwordSwitchOn);
  command(kControlwordShutdown);
  EXPECT_EQ(sut.state(), ready_to_switch_on);  // 6
  command(kControlwordDisableVoltage);
  EXPECT_EQ(sut.state(), switch_on_disabled);  // 7
}

TEST_F(PowerStateTest, Transition8HasItsOptionCode) {
  to_operation_enabled();
  command(kControlwordShutdown);
  EXPECT_EQ(sut.state(), ready_to_switch_on) << "by default without a ramp";
  parameters.shutdown_option = 1;
  to_operation_enabled();
  command(kControlwordShutdown);
  EXPECT_EQ(sut.stopping(), StopRamp::slow_down);
  sut.stands(parameters);
  EXPECT_EQ(sut.state(), ready_to_switch_on);
}

TEST_F(PowerStateTest, Transitions9And10DisableTheVoltageAtOnce) {
  to_operation_enabled();
  command(kControlwordDisableVoltage);
  EXPECT_EQ(sut.state(), switch_on_disabled);  // 9
  command(kControlwordShutdown);
  command(kControlwordSwitchOn);
  command(kControlwordDisableVoltage);
  EXPECT_EQ(sut.state(), switch_on_disabled);  // 10
}

TEST_F(PowerStateTest, Transitions11And12StopQuicklyAndSwitchOff) {
  to_operation_enabled();
  command(kControlwordQuickStop);
  EXPECT_EQ(sut.state(), quick_stop_active);  // 11
  EXPECT_EQ(sut.stopping(), StopRamp::quick_stop);
  command(kControlwordEnableOperation);
  EXPECT_EQ(sut.state(), quick_stop_active) << "this option code has no transition 16";
  sut.stands(parameters);
  EXPECT_EQ(sut.state(), switch_on_disabled);  // 12

  parameters.quick_stop_option = 0;
  to_operation_enabled();
  command(kControlwordQuickStop);
  EXPECT_EQ(sut.state(), switch_on_disabled);
}

TEST_F(PowerStateTest, Transition16LeavesAQuickStopThatWasHeld) {
  for (const int option : {5, 6}) {
    parameters.quick_stop_option = option;
    to_operation_enabled();
    command(kControlwordQuickStop);
    EXPECT_EQ(sut.stopping(), option == 5 ? StopRamp::slow_down : StopRamp::quick_stop);
    sut.stands(parameters);
    EXPECT_EQ(sut.state(), quick_stop_active);
    EXPECT_TRUE(sut.is_powered()) << "the axis is held";
    command(kControlwordEnableOperation);
    EXPECT_EQ(sut.state(), operation_enabled);
    EXPECT_FALSE(sut.stopping());
  }
}

TEST_F(PowerStateTest, Transitions13To15PassThroughTheFaultReaction) {
  to_operation_enabled();
  sut.fault(parameters);
  EXPECT_EQ(sut.state(), fault_reaction_active);  // 13
  EXPECT_EQ(sut.stopping(), StopRamp::quick_stop);
  command(kControlwordFaultReset);
  EXPECT_EQ(sut.state(), fault_reaction_active) << "no reset before the reaction is over";
  sut.stands(parameters);
  EXPECT_EQ(sut.state(), fault);  // 14
  EXPECT_FALSE(sut.is_powered());
  command(kControlwordFaultReset);
  EXPECT_EQ(sut.state(), fault) << "the bit was set already";
  command(0);
  command(kControlwordFaultReset);
  EXPECT_EQ(sut.state(), switch_on_disabled);  // 15
}

TEST_F(PowerStateTest, AFaultWithoutPowerNeedsNoReaction) {
  sut.started();
  sut.fault(parameters);
  EXPECT_EQ(sut.state(), fault);
}

}  // namespace
}  // namespace cellmirror::can
