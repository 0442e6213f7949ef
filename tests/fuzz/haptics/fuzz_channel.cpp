// Whatever a device and the workers say: the force stays finite and within its limit, the instrument within its joints,
// and a fault stays until it is taken back, or passes by itself where it may.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "rig.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;
using namespace cellmirror::haptics;

class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> data) : data_(data) {}
  [[nodiscard]] bool any() const { return !data_.empty(); }

  template <class T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof value, data_.size());
    std::memcpy(&value, data_.data(), count);
    data_ = data_.subspan(count);
    return value;
  }
  // Mostly of the size that things have, now and then anything at all.
  double number(double scale) {
    const auto kind = take<std::uint8_t>();
    if (kind >= 240) return take<double>();
    return scale * take<std::int16_t>() / 32768.0;
  }
  Eigen::Vector3d vector(double scale) {
    const double x = number(scale);
    const double y = number(scale);
    return {x, y, number(scale)};
  }

 private:
  std::span<const std::uint8_t> data_;
};

HapticSettings settings_from(Bytes& bytes) {
  HapticSettings settings;
  const auto choices = bytes.take<std::uint8_t>();
  settings.drive = (choices & 1) != 0 ? Drive::joints : Drive::pose;
  settings.clutch_button = (choices & 2) != 0 ? 0 : -1;
  settings.gripper_joint = (choices & 4) != 0 ? 4 : -1;
  settings.passivity_control = (choices & 8) == 0;
  settings.workspace_scale = (choices & 16) != 0 ? 0.3 : 2.0;
  settings.force_scale = (choices & 32) != 0 ? 0.0 : 1.5;
  apply((choices & 64) != 0 ? HapticProfile::strict : HapticProfile::desktop, settings);
  settings.re_engage = (choices & 128) != 0;
  settings.X_WD.translation() = Eigen::Vector3d(0, 0, -0.15);
  return settings;
}

void change_model(Bytes& bytes, ContactModel& model) {
  ++model.sequence;
  model.count = static_cast<std::uint8_t>(bytes.take<std::uint8_t>() % 16);
  model.certain = bytes.take<std::uint8_t>() % 4 != 0;
  model.x_ref = Eigen::Vector3d(0, 0, -0.15) + bytes.vector(0.05);
  model.reach = bytes.number(0.05);
  for (std::size_t i = 0; i < std::min<std::size_t>(model.count, kMaxConstraints); ++i) {
    ContactConstraint& constraint = model.constraints[i];
    constraint.a = bytes.vector(1.5);
    constraint.gap = bytes.number(0.02);
    constraint.normal = constraint.a;
    constraint.point = bytes.vector(0.1);
  }
}

void change_tissue(Bytes& bytes, test_rig::Rig& rig) {
  TissueForce& tissue = rig.tissue;
  rig.show_tissue = true;
  const auto what = bytes.take<std::uint8_t>();
  tissue.slot = (what & 0xC0) == 0xC0 ? 0 : rig.instrument.slot;
  ++tissue.sequence;
  tissue.posture_time = rig.now;
  if ((what & 1) != 0) tissue.x_ref = rig.state().x_proxy + bytes.vector(0.01);
  if ((what & 2) != 0) tissue.force_W = bytes.vector(4);
  if ((what & 4) != 0) tissue.torque_W = bytes.vector(0.1);
  if ((what & 8) != 0) {
    const Eigen::Vector3d along = bytes.vector(30);
    tissue.stiffness = along * along.transpose();
  }
  if ((what & 16) != 0) tissue.stiffness((what >> 6U) % 3U, 1) = bytes.number(500);
  if ((what & 32) != 0) tissue.posture_time.ns += bytes.take<std::int64_t>() >> (bytes.take<std::uint8_t>() % 64);
  tissue.contacts = bytes.take<std::uint8_t>() % 3;
  tissue.held = bytes.take<std::uint8_t>() % 2;
}

void change_sample(Bytes& bytes, test_rig::Rig& rig) {
  HapticSample& sample = rig.port.sample;
  const auto what = bytes.take<std::uint8_t>();
  rig.fresh();
  if ((what & 1) != 0) sample.p_DH += bytes.vector(0.004);
  if ((what & 2) != 0) {
    for (double& axis : sample.axes) axis += bytes.number(0.01);
    sample.axis_count = bytes.take<std::uint8_t>() % 10;
  }
  if ((what & 4) != 0) sample.q_DH.coeffs() = Eigen::Vector4d(0, 0, 0, 1) + bytes.number(1) * Eigen::Vector4d::Ones();
  if ((what & 8) != 0) sample.buttons ^= 1U;
  if ((what & 16) != 0) sample.gripper = bytes.number(1);
  if ((what & 32) != 0) sample.sequence += bytes.take<std::uint64_t>();
  if ((what & 64) != 0) sample.time.ns += bytes.take<std::int64_t>() >> (bytes.take<std::uint8_t>() % 64);
  if ((what & 128) != 0) {
    sample.writer = bytes.take<std::uint8_t>() % 3;
    sample.valid = bytes.take<std::uint8_t>() % 8 != 0;
  } else {
    sample.valid = true;
  }
}

void check(const test_rig::Rig& rig, bool moved, const HapticState& earlier) {
  const HapticState& state = rig.state();
  const HapticOutput& output = rig.port.output;
  CELLMIRROR_EXPECTS(output.force_D.allFinite() && output.force_E.allFinite() && output.torque_D.allFinite());
  CELLMIRROR_EXPECTS(output.force_D.norm() <= rig.instrument.settings.max_force * (1 + 1e-9));
  CELLMIRROR_EXPECTS(std::isfinite(output.gripper_torque) && std::isfinite(state.energy));
  for (const double torque : output.joint_torques) CELLMIRROR_EXPECTS(std::isfinite(torque));
  CELLMIRROR_EXPECTS(state.tissue_force_W.allFinite() && std::isfinite(state.axis_torque));
  CELLMIRROR_EXPECTS(state.x_proxy.allFinite() && state.x_device.allFinite());
  CELLMIRROR_EXPECTS((state.phase == HapticPhase::faulted) == (state.fault != HapticFault::none));
  CELLMIRROR_EXPECTS((state.phase == HapticPhase::faulted) == (state.awaited != HapticAwaited::nothing));
  const bool ended = earlier.phase == HapticPhase::faulted && state.phase != HapticPhase::faulted;
  CELLMIRROR_EXPECTS(!ended || (rig.instrument.settings.re_engage && passes_by_itself(earlier.fault)));
  CELLMIRROR_EXPECTS(!ended || state.phase == HapticPhase::waiting);
  const bool silent = state.phase == HapticPhase::faulted || state.phase == HapticPhase::waiting;
  CELLMIRROR_EXPECTS(!silent || (output.force_D.isZero(0) && !moved));
  for (std::size_t i = 0; moved && i < rig.instrument.joint_count; ++i) {
    const double q = rig.posture.position[i];
    CELLMIRROR_EXPECTS(q >= rig.instrument.lower[i] && q <= rig.instrument.upper[i]);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Instrument trocar = test_rig::trocar({});
  static const Instrument gantry = test_rig::gantry({});
  Bytes bytes(std::span<const std::uint8_t>(data, std::min<std::size_t>(size, 4096)));
  Instrument instrument = bytes.take<std::uint8_t>() % 2 == 0 ? trocar : gantry;
  instrument.settings = settings_from(bytes);
  test_rig::Rig rig(instrument);
  for (int tick = 0; tick < 400 && bytes.any(); ++tick) {
    const auto what = bytes.take<std::uint8_t>();
    if ((what & 3) != 0) change_sample(bytes, rig);
    if ((what & 3) == 0) rig.port.next = static_cast<HapticRead>(what >> 6U);
    if ((what & 4) != 0) change_model(bytes, rig.model);
    rig.missed = (what & 0x38) == 0x38 ? 3 : 0;
    rig.device_gone = (what & 0xF8) == 0xF0;
    if ((what & 0xF8) == 0xC8) change_tissue(bytes, rig);
    if ((what & 0xF8) == 0xE8) rig.q[0] = bytes.number(2);
    // A fault is taken back only in between, so that the check sees what a tick alone does.
    if ((what & 0xF8) == 0xD8) {
      rig.device_gone = false;
      for (int i = 0; i < 25; ++i) {
        rig.fresh();
        rig.tick();
      }
      (void)rig.sut.reset();
    }
    const HapticState before = rig.state();
    const bool moved = rig.tick();
    check(rig, moved, before);
  }
  rig.sut.close();
  CELLMIRROR_EXPECTS(rig.port.output.force_D.isZero(0));
  return 0;
}
