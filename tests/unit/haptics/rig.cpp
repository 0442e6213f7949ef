#include "rig.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "rt_core/base/contract.hpp"

namespace cellmirror::haptics::test_rig {

namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// A joint whose z axis lies as R says in the base at value zero; `R_WP`: the joint before it.
kinematics::ChainJoint joint(JointKind kind, std::uint8_t variable, const Matrix3d& R_WP, const Matrix3d& R_WJ) {
  kinematics::ChainJoint made;
  made.X_PJ.linear() = R_WP.transpose() * R_WJ;
  made.kind = kind;
  made.variable = variable;
  return made;
}

Instrument instrument_of(const std::vector<kinematics::ChainJoint>& joints,
                         const std::vector<kinematics::Variable>& variables, const Matrix3d& R_LT,
                         const HapticSettings& settings) {
  Pose X_LT = Pose::Identity();
  X_LT.linear() = R_LT;
  auto chain = kinematics::Chain::make(variables, joints, X_LT);
  CELLMIRROR_EXPECTS(chain.has_value());
  Instrument made{.slot = 3, .joint_count = 5, .chain = *chain, .settings = settings};
  for (std::size_t i = 0; i < 4; ++i) {
    made.variable_joint[i] = static_cast<std::uint8_t>(i);
    made.lower[i] = variables[i].lower;
    made.upper[i] = variables[i].upper;
  }
  made.upper[4] = 1.0;
  return made;
}

}  // namespace

HapticRead ScriptedPort::read(HapticSample& out) CELL_RT {
  out = sample;
  return std::exchange(next, HapticRead::unchanged);
}

void ScriptedPort::write(const HapticOutput& written) CELL_RT {
  output = written;
  ++writes;
}

Instrument gantry(const HapticSettings& settings) {
  const Matrix3d along_x = AngleAxisd(std::numbers::pi / 2, Vector3d::UnitY()).toRotationMatrix();
  const Matrix3d along_y = AngleAxisd(-std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
  const Matrix3d along_z = Matrix3d::Identity();
  return instrument_of(
      {joint(JointKind::prismatic, 0, Matrix3d::Identity(), along_x), joint(JointKind::prismatic, 1, along_x, along_y),
       joint(JointKind::prismatic, 2, along_y, along_z), joint(JointKind::revolute, 3, along_z, along_z)},
      {{"X", JointKind::prismatic, -0.5, 0.5},
       {"Y", JointKind::prismatic, -0.5, 0.5},
       {"Z", JointKind::prismatic, -0.5, 0.5},
       {"ROLL", JointKind::revolute, -3.0, 3.0}},
      Matrix3d::Identity(), settings);
}

Instrument trocar(const HapticSettings& settings) {
  const Matrix3d about_x = AngleAxisd(std::numbers::pi / 2, Vector3d::UnitY()).toRotationMatrix();
  const Matrix3d about_y = AngleAxisd(-std::numbers::pi / 2, Vector3d::UnitX()).toRotationMatrix();
  const Matrix3d down = AngleAxisd(std::numbers::pi, Vector3d::UnitX()).toRotationMatrix();
  Instrument made = instrument_of(
      {joint(JointKind::revolute, 0, Matrix3d::Identity(), about_x), joint(JointKind::revolute, 1, about_x, about_y),
       joint(JointKind::prismatic, 2, about_y, down), joint(JointKind::revolute, 3, down, down)},
      {{"YAW", JointKind::revolute, -1.2, 1.2},
       {"PITCH", JointKind::revolute, -1.2, 1.2},
       {"INSERTION", JointKind::prismatic, 0.02, 0.3},
       {"ROLL", JointKind::revolute, -3.0, 3.0}},
      Matrix3d::Identity(), settings);
  return made;
}

HapticSettings plain_settings() {
  HapticSettings settings;
  apply(HapticProfile::strict, settings);
  settings.stiffness = 1000;
  settings.damping = 0;
  settings.static_friction = 0;
  settings.dynamic_friction = 0;
  settings.max_force = 50;
  settings.max_slew = 1e9;
  settings.engage_time = Nanoseconds{0};
  settings.passivity_control = false;
  return settings;
}

ContactConstraint plane(const Vector3d& a, double offset, const Vector3d& x_ref) {
  ContactConstraint made;
  made.a = a;
  made.gap = a.dot(x_ref) - offset;
  made.normal = a.normalized();
  made.point = x_ref;
  return made;
}

ContactModel model_of(const std::vector<ContactConstraint>& constraints, const Vector3d& x_ref) {
  ContactModel made;
  made.sequence = 1;
  made.slot = 3;
  made.x_ref = x_ref;
  made.count = static_cast<std::uint8_t>(constraints.size());
  std::ranges::copy(constraints, made.constraints.begin());
  return made;
}

Rig::Rig(const Instrument& made) : instrument(made) {
  port.sample.valid = true;
  port.sample.writer = 77;
  model.sequence = 1;
  model.slot = 3;
  q[2] = std::max(0.0, instrument.lower[2]);
  sut.open(instrument, port);
}

void Rig::fresh() {
  port.next = HapticRead::fresh;
  ++port.sample.sequence;
  port.sample.time = now + period;  // measured just before the tick that reads it
}

bool Rig::tick(const Vector3d& p_DH) {
  fresh();
  port.sample.p_DH = p_DH;
  return tick();
}

bool Rig::tick() {
  if (tissue_worker) tissue_worker(*this);
  now = now + period;
  if (keep_model_new) {
    ++model.sequence;
    model.posture_time = now;
  }
  const bool moved = sut.step({now, period, missed, show_model ? &model : nullptr, std::span<const double>(q.data(), 5),
                               device_gone, show_tissue ? &tissue : nullptr},
                              posture);
  if (moved) q = posture.position;
  return moved;
}

void Rig::go(const Vector3d& p_DH, int rest) {
  constexpr double kStep = 0.5e-3;  // m a period
  const Vector3d from = port.sample.p_DH;
  const int steps = static_cast<int>(std::ceil((p_DH - from).norm() / kStep));
  for (int i = 1; i <= steps; ++i) tick(from + (p_DH - from) * (static_cast<double>(i) / steps));
  for (int i = 0; i < rest; ++i) tick(p_DH);
}

}  // namespace cellmirror::haptics::test_rig
