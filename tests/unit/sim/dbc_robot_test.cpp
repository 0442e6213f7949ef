// The device of a DBC in virtual time on a bus in memory.
#include "sim_devices/robot/dbc_robot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "drivers/can/channel/virtual_bus.hpp"

namespace cellmirror::sim {
namespace {

constexpr Timestamp kStart{1'000'000'000};
constexpr Nanoseconds kPeriod{10'000'000};
// 16 bits of 0.01 deg end at 327.67.
constexpr const char* kAxis = "BO_ 256 ArmA: 8 R\n SG_ A1 : 0|16@1- (0.01,0) [0|0] \"deg\" M\n";

struct DbcRobotTest : ::testing::Test {
  // What was said while the robot told `position` rad ten times.
  std::string said_at(const std::string& position) {
    Diagnostics diagnostics;
    const can::Dbc dbc = can::parse_dbc(kAxis, "arm.dbc", diagnostics);
    EXPECT_EQ(diagnostics.text(), "");
    DbcRobotConfig config;
    config.endpoint = "virtual";
    config.joints = 1;
    config.signals = {{"ArmA", "A1", 0, "1", JointQuantity::position, 0.017453292519943295, 0.0}};
    auto made = DbcRobot::make(config, dbc, std::move(*make_motion("hold:position=" + position, 1)), bus.connect());
    EXPECT_TRUE(made);
    sut = std::move(*made);
    testing::internal::CaptureStderr();
    sut->start(kStart);
    for (int i = 0; i < 10; ++i) sut->work(kStart + i * kPeriod);
    return testing::internal::GetCapturedStderr();
  }
  std::uint64_t did_not_fit() const {
    for (const auto& [name, count] : sut->status(kStart).details) {
      if (name == "values_that_did_not_fit") return count;
    }
    return ~std::uint64_t{0};
  }
  can::VirtualCanBus bus;
  std::unique_ptr<DbcRobot> sut;
};

TEST_F(DbcRobotTest, TellsOnceThatAValueDoesNotFitAndWhatIsSent) {
  EXPECT_EQ(said_at("6"), "sim_robot: 343.775 does not fit into ArmA.A1, 327.67 is sent\n");
  EXPECT_EQ(did_not_fit(), 10U);
}

TEST_F(DbcRobotTest, SaysNothingOfValuesThatAreRounded) {
  EXPECT_EQ(said_at("-1.2345678"), "");
  EXPECT_EQ(did_not_fit(), 0U);
}

}  // namespace
}  // namespace cellmirror::sim
