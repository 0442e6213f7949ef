#include "drivers/can/cia402/device/servo_drive.hpp"

#include <chrono>

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kMotorStep = 500us;
static_assert(MotorModel::kStep == 0.0005);
constexpr Nanoseconds kMostBehind = 100ms;  // of motion that is made up for

constexpr ObjectAddress kServoStatusword{0x6041, 0};
constexpr std::uint16_t kErrorMasterLost = 0x8130;

}  // namespace

ServoDrive::ServoDrive(const DriveConfig& config, std::uint16_t heartbeat_ms, FrameOutput& output)
    : config_(config),
      scale_(config.increments_per_unit()),
      joint_sign_(config.sign < 0 ? -1.0 : 1.0),
      slave_(config.node_id, make_servo_objects(config, heartbeat_ms), kServoStatusword, *this, output),
      motor_(config),
      parameters_(read_servo_parameters(slave_.objects())) {
  if (config.waits_for_lss) slave_.wait_for_number();
}

void ServoDrive::power_on(Timestamp now) {
  moved_ = now;
  slave_.power_on(NmtState::pre_operational, now);
}

void ServoDrive::on_reset(Timestamp /*now*/) {
  power_.reset();
  parameters_ = read_servo_parameters(slave_.objects());
  mode_ = DriveMode::none;
  controlword_ = 0;
  error_code_ = 0;
  set_point_acknowledged_ = false;
  limited_ = false;
  stop_ramp_.reset();
  demand_ = {actual(), 0, 0};
  write_objects();
  slave_.objects().write_integer({0x607A, 0}, object(0x6064));
}

void ServoDrive::receive(const CanFrame& frame, Timestamp now) {
  move(now);
  slave_.receive(frame, now);
}

void ServoDrive::advance(Timestamp now) {
  move(now);
  slave_.advance(now);
}

void ServoDrive::move(Timestamp now) {
  if (!slave_.is_powered()) return;
  if (now - moved_ > kMostBehind) moved_ = now - kMostBehind;
  if (moved_ + kMotorStep > now) return;
  for (; moved_ + kMotorStep <= now; moved_ = moved_ + kMotorStep) step();
  write_objects();
  slave_.changed(now);
}

void ServoDrive::synced(Timestamp /*now*/) {}

bool ServoDrive::is_stored(ObjectAddress address) const { return !is_servo_command(address); }

bool ServoDrive::communication_lost(Timestamp now) {
  constexpr int kFault = 1;
  constexpr int kDisableVoltage = 2;
  constexpr int kQuickStop = 3;
  if (!power_.is_powered()) return false;
  const bool is_fault = parameters_.connection_option == kFault;
  if (is_fault) {
    error_code_ = kErrorMasterLost;
    power_.fault(parameters_);
  }
  if (parameters_.connection_option == kDisableVoltage) power_.disable_voltage();
  if (parameters_.connection_option == kQuickStop) power_.quick_stop(parameters_);
  write_objects();
  slave_.changed(now);
  return is_fault;
}

bool ServoDrive::fail(std::uint16_t code, std::uint8_t error_register, Timestamp /*now*/) {
  raise_fault(code, error_register);
  write_objects();
  return true;
}

void ServoDrive::raise_fault(std::uint16_t code, std::uint8_t error_register) {
  error_code_ = code;
  power_.fault(parameters_);
  slave_.emergency(code, error_register);
}

}  // namespace cellmirror::can
