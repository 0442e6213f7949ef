#include "rt_core/engine/instrument_bytes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "rt_core/engine/state_transfer.hpp"

namespace cellmirror {

template <class Archive>
void transfer(Archive& archive, kinematics::ChainJoint& value) CELL_RT {
  archive.choice(value.kind, JointKind::prismatic);
  archive(value.X_PJ, value.variable, value.multiplier, value.offset);
}

}  // namespace cellmirror

namespace cellmirror::engine {

namespace {

using haptics::HapticSettings;
using haptics::Instrument;

// An instrument without its chain.
struct InstrumentValues {
  std::uint8_t slot = 0;
  std::uint8_t joint_count = 0;
  std::array<std::uint8_t, kMaxJointsPerRobot> variable_joint{};
  Pose X_WB = Pose::Identity();
  JointValues lower{};
  JointValues upper{};
  HapticSettings settings;

  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive.bounded(joint_count, kMaxJointsPerRobot);
    archive(slot, variable_joint, X_WB, lower, upper, settings);
  }
};

bool all_finite(const HapticSettings& s) {
  const double values[] = {
      s.workspace_scale, s.force_scale,      s.gripper_scale,        s.gripper_offset,   s.stiffness,
      s.damping,         s.max_force,        s.static_friction,      s.dynamic_friction, s.max_slew,
      s.max_speed,       s.energy_allowance, s.max_passivity_damping};
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value) && std::abs(value) < 1e12; });
}

bool is_sound(const Instrument& instrument) {
  const HapticSettings& s = instrument.settings;
  if (!kinematics::is_pose(instrument.X_WB) || !kinematics::is_pose(s.X_WD) || !all_finite(s)) return false;
  if (s.workspace_scale <= 0 || s.stiffness < 0 || s.max_force < 0 || s.max_slew < 0 || s.damping < 0) return false;
  if (s.gripper_joint < -1 || s.gripper_joint >= instrument.joint_count) return false;
  for (std::size_t i = 0; i < instrument.chain.variable_count(); ++i)
    if (instrument.variable_joint[i] >= instrument.joint_count) return false;
  return true;
}

}  // namespace

void write_chain(StateWriter& out, const kinematics::Chain& chain) CELL_RT {
  std::size_t variables = chain.variables().size();
  std::size_t joints = chain.joints().size();
  out.bounded(variables, kinematics::kMaxVariables);
  for (const kinematics::Variable& variable : chain.variables()) {
    JointKind kind = variable.kind;
    double lower = variable.lower;
    double upper = variable.upper;
    out.text(variable.name);
    out.choice(kind, JointKind::prismatic);
    out(lower, upper);
  }
  out.bounded(joints, kinematics::kMaxChainJoints);
  for (kinematics::ChainJoint joint : chain.joints()) out(joint);
  Pose X_LT = chain.X_LT();
  out(X_LT);
}

std::optional<kinematics::Chain> read_chain(StateReader& in) {
  std::size_t count = 0;
  in.bounded(count, kinematics::kMaxVariables);
  if (!in.ok()) return std::nullopt;
  std::vector<kinematics::Variable> variables(count);
  for (kinematics::Variable& variable : variables) {
    in.text(variable.name);
    in.choice(variable.kind, JointKind::prismatic);
    in(variable.lower, variable.upper);
  }
  in.bounded(count, kinematics::kMaxChainJoints);
  if (!in.ok()) return std::nullopt;
  std::vector<kinematics::ChainJoint> joints(count);
  for (kinematics::ChainJoint& joint : joints) in(joint);
  Pose X_LT = Pose::Identity();
  in(X_LT);
  if (!in.ok()) return std::nullopt;
  auto chain = kinematics::Chain::make(std::move(variables), joints, X_LT);
  if (!chain) {
    in.fail();
    return std::nullopt;
  }
  return *std::move(chain);
}

void write_instrument(StateWriter& out, const Instrument& instrument) CELL_RT {
  write_chain(out, instrument.chain);
  InstrumentValues values{.slot = instrument.slot,
                          .joint_count = instrument.joint_count,
                          .variable_joint = instrument.variable_joint,
                          .X_WB = instrument.X_WB,
                          .lower = instrument.lower,
                          .upper = instrument.upper,
                          .settings = instrument.settings};
  out(values);
}

std::optional<Instrument> read_instrument(StateReader& in) {
  auto chain = read_chain(in);
  if (!chain) return std::nullopt;
  InstrumentValues values;
  in(values);
  Instrument out{.slot = values.slot,
                 .joint_count = values.joint_count,
                 .chain = *std::move(chain),
                 .variable_joint = values.variable_joint,
                 .X_WB = values.X_WB,
                 .lower = values.lower,
                 .upper = values.upper,
                 .settings = values.settings};
  if (in.ok() && !is_sound(out)) in.fail();
  if (!in.ok()) return std::nullopt;
  return out;
}

}  // namespace cellmirror::engine
