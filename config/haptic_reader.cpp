#include "config/haptic_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/stream_reader.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

using haptics::Drive;
using haptics::HapticProfile;
using haptics::HapticSettings;

// Beyond these no device is built, and no loop of some kHz stays stable.
constexpr Range kScale{0.0, 1000.0, true};
constexpr Range kStiffness{0.0, 100'000.0, true};
constexpr Range kDamping{0.0, 1000.0};
constexpr Range kPassivityDamping{0.0, 100'000.0};
constexpr Range kFriction{0.0, 10.0};
constexpr Range kForce{0.0, 200.0, true};
constexpr Range kSlew{0.0, 1e6, true};
constexpr Range kSpeed{0.0, 100.0, true};
constexpr Range kEnergy{0.0, 10.0};
constexpr double kLongestEngaging = 60.0;
constexpr double kLongestStale = 10.0;
constexpr std::int64_t kMostMissed = 10'000;  // as long at 1 kHz

void read_mapping(TableReader& reader, const RobotFacts* robot, HapticSettings& settings) {
  settings.drive =
      reader.choice<Drive>("drive", {{"pose", Drive::pose}, {"joints", Drive::joints}}).value_or(settings.drive);
  settings.X_WD = reader.pose();
  settings.workspace_scale = reader.number("workspace_scale", kScale).value_or(settings.workspace_scale);
  settings.force_scale = reader.number("force_scale", kScale).value_or(settings.force_scale);
  settings.clutch_button = static_cast<int>(reader.integer("clutch_button", 0, 31).value_or(settings.clutch_button));
  settings.gripper_scale = reader.number("gripper_scale", {-1000.0, 1000.0}).value_or(settings.gripper_scale);
  settings.gripper_offset = reader.number("gripper_offset", {-1000.0, 1000.0}).value_or(settings.gripper_offset);
  const auto gripper = reader.text("gripper_joint");
  if (!gripper || robot == nullptr) return;
  const auto at = std::ranges::find(robot->joint_names, *gripper);
  if (at != robot->joint_names.end()) {
    settings.gripper_joint = static_cast<int>(at - robot->joint_names.begin());
    return;
  }
  std::string remedy = did_you_mean(*gripper, robot->joint_names);
  if (remedy.empty()) remedy = fmt::format("its joints are {}", fmt::join(robot->joint_names, ", "));
  reader.error("gripper_joint", fmt::format("the robot has no joint {}", printable(*gripper)), remedy);
}

void read_rendering(TableReader& reader, HapticSettings& settings) {
  settings.stiffness = reader.number("stiffness_n_m", kStiffness).value_or(settings.stiffness);
  settings.damping = reader.number("damping_n_s_m", kDamping).value_or(settings.damping);
  settings.static_friction = reader.number("static_friction", kFriction).value_or(settings.static_friction);
  const auto dynamic = reader.number("dynamic_friction", kFriction);
  settings.dynamic_friction = dynamic.value_or(std::min(settings.dynamic_friction, settings.static_friction));
  if (dynamic && *dynamic > settings.static_friction) {
    reader.error("dynamic_friction", "sliding friction above static friction",
                 "dynamic_friction is at most static_friction");
  }
  settings.max_force = reader.number("max_force_n", kForce).value_or(settings.max_force);
  settings.max_slew = reader.number("max_slew_n_s", kSlew).value_or(settings.max_slew);
  settings.engage_time = read_seconds(reader, "engage_time_s", kLongestEngaging, true).value_or(settings.engage_time);
}

void read_guards(TableReader& reader, HapticSettings& settings) {
  haptics::apply(
      reader.choice<HapticProfile>("profile", {{"desktop", HapticProfile::desktop}, {"strict", HapticProfile::strict}})
          .value_or(settings.profile),
      settings);
  settings.re_engage = reader.boolean("re_engage").value_or(settings.re_engage);
  settings.max_speed = reader.number("max_speed_m_s", kSpeed).value_or(settings.max_speed);
  settings.stale_after = read_seconds(reader, "stale_after_s", kLongestStale, false).value_or(settings.stale_after);
  settings.model_stale_after =
      read_seconds(reader, "model_stale_after_s", kLongestStale, false).value_or(settings.model_stale_after);
  settings.allowed_missed_periods = static_cast<std::uint32_t>(
      reader.integer("allowed_missed_periods", 0, kMostMissed).value_or(settings.allowed_missed_periods));
  settings.passivity_control = reader.boolean("passivity_control").value_or(settings.passivity_control);
  settings.energy_allowance = reader.number("energy_allowance_j", kEnergy).value_or(settings.energy_allowance);
  settings.max_passivity_damping =
      reader.number("max_passivity_damping_n_s_m", kPassivityDamping).value_or(settings.max_passivity_damping);
}

void read_memory(TableReader& reader, RobotHaptic& haptic) {
  constexpr long long kLeastBytes = 12;  // three float32: the force alone, as in 1999
  constexpr long long kMostBlockBytes = 1 << 20;
  if (const auto key = reader.integer("shm_key", 1, 0x7FFF'FFFF)) haptic.key = static_cast<std::int32_t>(*key);
  haptic.bytes = static_cast<std::size_t>(
      reader.integer("shm_bytes", kLeastBytes, kMostBlockBytes).value_or(static_cast<long long>(haptic.bytes)));
  if (const auto mode = reader.text("shm_mode")) {
    if (const auto bits = octal(*mode)) {
      haptic.mode = *bits;
    } else {
      reader.error("shm_mode", fmt::format("shm_mode \"{}\" is not a valid mode", printable(*mode)),
                   "write e.g. shm_mode = \"0660\"");
    }
  }
  haptic.online = reader.boolean("online").value_or(false);
  if (haptic.online && !reader.has("shm_key")) {
    reader.error("online", "a device that is online at the start needs a shared memory",
                 "give it a shm_key, or use rob_ela_shm and ROBOT ... online in the startup script");
  }
}

}  // namespace

std::optional<RobotHaptic> read_haptic(TableReader& reader, const RobotDirectory& robots, bool complete) {
  RobotHaptic haptic;
  reader.require("robot");
  const auto robot = reader.text("robot");
  const RobotFacts* facts = nullptr;
  if (robot) {
    haptic.robot = *robot;
    reader.set_where("haptic device of " + printable(*robot));
    facts = find_robot(reader, *robot, robots, complete);
  }
  read_mapping(reader, facts, haptic.settings);
  read_rendering(reader, haptic.settings);
  read_guards(reader, haptic.settings);
  haptic.placed = reader.has("xyz_m");
  haptic.reach_m = reader.number("reach_m", {0.001, 1.0}).value_or(haptic.reach_m);
  read_memory(reader, haptic);
  reader.finish();
  if (!robot) return std::nullopt;
  return haptic;
}

}  // namespace cellmirror
