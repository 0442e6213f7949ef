// [[haptic]] in cell files; what is refused stands in tests/golden/config/bad/haptics.
#include <gtest/gtest.h>

#include "config/cell_file.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

struct HapticConfig : testing::Test {
  HapticConfig() {
    home.write(
        "envlib/arm.mpc",
        "format = 1\n[[node]]\nname = \"S\"\njoint = { type = \"prismatic\", axis = [0, 0, 1], range_m = [0, 1], "
        "velocity_m_s = 1 }\n[[node]]\nname = \"JAW\"\nparent = \"S\"\njoint = { type = \"revolute\", range_rad "
        "= [0, 1], velocity_rad_s = 1 }\n[robot]\nid = \"ARM\"\nflange = \"S\"\n");
  }
  std::optional<LoadedCell> load(const std::string& text) {
    diagnostics = {};
    return load_cell(home.write("cell.toml",
                                "format = 1\nname = \"c\"\n[[node]]\nname = \"A\"\nabstract = "
                                "\"arm.mpc\"\n" +
                                    text),
                     diagnostics);
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(HapticConfig, NeedsARobotAndNothingElse) {
  const auto sut = load("[[haptic]]\nrobot = \"ARM\"\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  ASSERT_EQ(sut->haptics.size(), 1U);
  const RobotHaptic& haptic = sut->haptics.front();
  const haptics::HapticSettings defaults;
  EXPECT_EQ(haptic.robot, "ARM");
  EXPECT_FALSE(haptic.key);
  EXPECT_EQ(haptic.bytes, 512U);
  EXPECT_EQ(haptic.mode, 0600U);
  EXPECT_FALSE(haptic.online);
  EXPECT_FALSE(haptic.placed);
  EXPECT_EQ(haptic.settings.stiffness, defaults.stiffness);
  EXPECT_EQ(haptic.settings.stale_after, defaults.stale_after);
  EXPECT_EQ(haptic.settings.clutch_button, -1);
  EXPECT_EQ(haptic.settings.gripper_joint, -1);
}

TEST_F(HapticConfig, DefaultsSurviveABusyMachineAndAProfileIsStrict) {
  const auto settings_of = [this](const std::string& more) {
    const auto sut = load("[[haptic]]\nrobot = \"ARM\"\n" + more);
    EXPECT_TRUE(sut) << diagnostics.text();
    return sut ? sut->haptics.at(0).settings : haptics::HapticSettings{};
  };
  const haptics::HapticSettings desktop = settings_of("");
  EXPECT_EQ(desktop.profile, haptics::HapticProfile::desktop);
  EXPECT_GE(desktop.stale_after, Nanoseconds(50'000'000));
  EXPECT_GE(desktop.model_stale_after, Nanoseconds(200'000'000));
  EXPECT_GE(desktop.allowed_missed_periods, 50U);
  EXPECT_TRUE(desktop.re_engage);
  const haptics::HapticSettings strict = settings_of("profile = \"strict\"\n");
  EXPECT_EQ(strict.profile, haptics::HapticProfile::strict);
  EXPECT_EQ(strict.stale_after, Nanoseconds(3'000'000));
  EXPECT_EQ(strict.model_stale_after, Nanoseconds(100'000'000));
  EXPECT_EQ(strict.allowed_missed_periods, 2U);
  EXPECT_FALSE(strict.re_engage);
  const haptics::HapticSettings mixed = settings_of("stale_after_s = 0.01\nre_engage = true\nprofile = \"strict\"\n");
  EXPECT_EQ(mixed.stale_after, Nanoseconds(10'000'000)) << "a key counts more than the profile";
  EXPECT_TRUE(mixed.re_engage);
  EXPECT_EQ(mixed.allowed_missed_periods, 2U);
  EXPECT_FALSE(load("[[haptic]]\nrobot = \"ARM\"\nprofile = \"loose\"\n"));
  EXPECT_NE(diagnostics.text().find("profile cannot be \"loose\"; it is one of desktop, strict"), std::string::npos)
      << diagnostics.text();
}

TEST_F(HapticConfig, TakesEveryKey) {
  const auto sut = load(R"(
[[haptic]]
robot = "ARM"
drive = "joints"
xyz_m = [1, 2, 3]
workspace_scale = 2
force_scale = 0.5
clutch_button = 3
gripper_joint = "JAW"
gripper_scale = -1
gripper_offset = 0.25
stiffness_n_m = 750
damping_n_s_m = 3
static_friction = 0.1
max_force_n = 4
max_slew_n_s = 900
max_speed_m_s = 1.5
engage_time_s = 0
stale_after_s = 0.01
model_stale_after_s = 0.2
allowed_missed_periods = 7
passivity_control = false
energy_allowance_j = 0.002
max_passivity_damping_n_s_m = 20
reach_m = 0.03
shm_key = 0x1234
shm_bytes = 4096
shm_mode = "0660"
online = true
[queues]
tcp_force_key = 99
)");
  ASSERT_TRUE(sut) << diagnostics.text();
  const RobotHaptic& haptic = sut->haptics.at(0);
  const haptics::HapticSettings& settings = haptic.settings;
  EXPECT_EQ(settings.drive, haptics::Drive::joints);
  EXPECT_EQ(settings.X_WD.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(settings.workspace_scale, 2);
  EXPECT_EQ(settings.force_scale, 0.5);
  EXPECT_EQ(settings.clutch_button, 3);
  EXPECT_EQ(settings.gripper_joint, 1);
  EXPECT_EQ(settings.gripper_scale, -1);
  EXPECT_EQ(settings.gripper_offset, 0.25);
  EXPECT_EQ(settings.stiffness, 750);
  EXPECT_EQ(settings.damping, 3);
  EXPECT_EQ(settings.static_friction, 0.1);
  EXPECT_EQ(settings.dynamic_friction, 0.1);  // never more than the static one
  EXPECT_EQ(settings.max_force, 4);
  EXPECT_EQ(settings.max_slew, 900);
  EXPECT_EQ(settings.max_speed, 1.5);
  EXPECT_EQ(settings.engage_time, Nanoseconds(0));
  EXPECT_EQ(settings.stale_after, Nanoseconds(10'000'000));
  EXPECT_EQ(settings.model_stale_after, Nanoseconds(200'000'000));
  EXPECT_EQ(settings.allowed_missed_periods, 7U);
  EXPECT_FALSE(settings.passivity_control);
  EXPECT_EQ(settings.energy_allowance, 0.002);
  EXPECT_EQ(settings.max_passivity_damping, 20);
  EXPECT_EQ(haptic.reach_m, 0.03);
  EXPECT_EQ(haptic.key, 0x1234);
  EXPECT_EQ(haptic.bytes, 4096U);
  EXPECT_EQ(haptic.mode, 0660U);
  EXPECT_TRUE(haptic.online);
  EXPECT_TRUE(haptic.placed);
  EXPECT_EQ(sut->queues.tcp_force_key, 99);
}

TEST_F(HapticConfig, IsForFourDevicesAtMost) {
  std::string five;
  for (int i = 0; i < 5; ++i) five += "[[haptic]]\nrobot = \"ARM\"\n";
  EXPECT_FALSE(load(five));
}

}  // namespace
}  // namespace cellmirror
