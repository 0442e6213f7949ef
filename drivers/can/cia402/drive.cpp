#include "drivers/can/cia402/drive.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/emcy.hpp"
#include "drivers/can/canopen/pdo.hpp"
#include "drivers/can/cia402/drive_objects.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kMotionStep = 1ms;  // profile position: how finely the drive moves between its owner's calls

constexpr bool is_event_driven(std::uint8_t transmission_type) { return transmission_type >= 254; }
constexpr bool is_cyclic(std::uint8_t transmission_type) { return transmission_type >= 1 && transmission_type <= 240; }

Timestamp earlier(Timestamp a, Timestamp b) {
  if (!a.known()) return b;
  return b.known() && b < a ? b : a;
}

}  // namespace

Cia402Drive::Cia402Drive(const Cia402DriveConfig& config, Cia402DriveOutput& output)
    : config_(config),
      node_(config.node_id),
      output_(&output),
      defaults_(make_drive_objects(config)),
      objects_(defaults_),
      server_(config.node_id, *this) {
  load_pdos();
}

void Cia402Drive::power_on(Timestamp now) {
  now_ = now;
  powered_ = true;
  reset_communication(now);
}

void Cia402Drive::power_off() {
  powered_ = false;
  nmt_ = NmtState::boot_up;
}

void Cia402Drive::reset_communication(Timestamp now) {
  const std::int32_t at = position();
  objects_ = defaults_;
  objects_.write_integer(kPositionActual, at);  // an absolute encoder does not forget
  objects_.write_integer(kTargetPosition, at);
  server_.reset();
  controlword_ = 0;
  set_point_taken_ = false;
  target_reached_ = true;
  moved_ = now;
  state_ = config_.self_starting ? Cia402State::operation_enabled : Cia402State::switch_on_disabled;
  load_pdos();
  update_statusword();
  nmt_ = NmtState::boot_up;
  output_->send(encode_heartbeat({node_, NmtState::boot_up}));
  const std::int64_t heartbeat_ms = object(0x1017);
  heartbeat_due_ = heartbeat_ms > 0 ? now + std::chrono::milliseconds(heartbeat_ms) : Timestamp{};
  enter(config_.self_starting ? NmtState::operational : NmtState::pre_operational, now);
}

void Cia402Drive::enter(NmtState state, Timestamp now) {
  if (nmt_ == state) return;
  nmt_ = state;
  if (state != NmtState::operational) return;
  for (Tpdo& tpdo : tpdos_) {
    tpdo.syncs = 0;
    if (tpdo.valid && is_event_driven(tpdo.transmission_type)) send_tpdo(tpdo, now);
  }
}

void Cia402Drive::receive(const CanFrame& frame, Timestamp now) {
  if (!powered_ || frame.error || frame.remote) return;
  now_ = now;
  if (const auto message = decode_nmt(frame)) {
    if (message->node == 0 || message->node == node_) on_nmt(*message, now);
    return;
  }
  if (is_sync(frame)) {
    on_sync(now);
    return;
  }
  if (nmt_ == NmtState::operational) {
    for (Rpdo& rpdo : rpdos_) {
      if (rpdo.valid && !frame.extended && frame.id == rpdo.cob_id) {
        on_rpdo(rpdo, frame, now);
        return;
      }
    }
  }
  if (nmt_ == NmtState::stopped) return;
  if (const auto answer = server_.receive(frame)) output_->send(*answer);
}

void Cia402Drive::on_nmt(NmtMessage message, Timestamp now) {
  switch (message.command) {
    case NmtCommand::start:
      enter(NmtState::operational, now);
      return;
    case NmtCommand::stop:
      enter(NmtState::stopped, now);
      return;
    case NmtCommand::enter_pre_operational:
      enter(NmtState::pre_operational, now);
      return;
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      reset_communication(now);
      return;
  }
}

void Cia402Drive::on_sync(Timestamp now) {
  if (nmt_ != NmtState::operational) return;
  for (Tpdo& tpdo : tpdos_) {
    if (!tpdo.valid) continue;
    if (is_cyclic(tpdo.transmission_type) && ++tpdo.syncs >= tpdo.transmission_type) {
      tpdo.syncs = 0;
      send_tpdo(tpdo, now);
    } else if (tpdo.transmission_type == 0 && mapped_values(tpdo) != tpdo.last) {
      send_tpdo(tpdo, now);
    }
  }
  for (Rpdo& rpdo : rpdos_) {
    if (!rpdo.waiting) continue;
    const CanFrame frame = *rpdo.waiting;
    rpdo.waiting.reset();
    apply_rpdo(rpdo, frame, now);
  }
  follow(now);
}

void Cia402Drive::on_rpdo(Rpdo& rpdo, const CanFrame& frame, Timestamp now) {
  const std::size_t length = pdo_length(rpdo.entries);
  if (frame.length < length) {
    send_emcy(0x8210, 0x11);
    return;
  }
  if (rpdo.on_sync) {
    rpdo.waiting = frame;
  } else {
    apply_rpdo(rpdo, frame, now);
    follow(now);
  }
}

void Cia402Drive::apply_rpdo(const Rpdo& rpdo, const CanFrame& frame, Timestamp now) {
  const auto values = unpack_pdo(rpdo.entries, frame.payload().first(pdo_length(rpdo.entries)));
  if (!values) return;
  for (const PdoValue& value : *values) {
    const ObjectAddress address{value.index, value.subindex};
    ObjectEntry* entry = objects_.find(address);
    if (entry == nullptr) continue;
    put_le(entry->value, value.raw, std::min<std::size_t>(entry->value.size(), 8));
    after_write(address, now);
  }
}

void Cia402Drive::after_write(ObjectAddress address, Timestamp now) {
  if (address.index >= 0x1400 && address.index <= 0x1BFF) load_pdos();
  if (address.index == 0x1017) {
    const std::int64_t heartbeat_ms = object(0x1017);
    heartbeat_due_ = heartbeat_ms > 0 ? now + std::chrono::milliseconds(heartbeat_ms) : Timestamp{};
  }
  if (address == kControlword) on_controlword(static_cast<std::uint16_t>(object(0x6040)), now);
  if (address == kModesOfOperation) {
    const auto wanted = static_cast<DriveMode>(object(0x6060));
    const bool known = wanted == DriveMode::profile_position || wanted == DriveMode::cyclic_sync_position ||
                       wanted == DriveMode::none || wanted == DriveMode::homing;
    if (known) objects_.write_integer(kModeDisplay, static_cast<std::int64_t>(wanted));
    profile_position_ = position();
    profile_target_ = position();
    update_statusword();
  }
}

void Cia402Drive::on_controlword(std::uint16_t controlword, Timestamp now) {
  const Cia402State before = state_;
  state_ = next_state(state_, controlword_, controlword);
  if (before == Cia402State::fault && state_ != before) clear_fault(now);
  if (before != Cia402State::operation_enabled && state_ == Cia402State::operation_enabled) {
    profile_position_ = position();
    profile_target_ = position();
    moved_ = now;
  }
  if (mode() == DriveMode::profile_position) on_new_set_point(controlword);
  controlword_ = controlword;
  update_statusword();
  changed(now);
}

void Cia402Drive::on_new_set_point(std::uint16_t controlword) {
  const bool wanted = (controlword & kControlwordNewSetPoint) != 0;
  if (!wanted) {
    set_point_taken_ = false;
  } else if (!set_point_taken_ && state_ == Cia402State::operation_enabled) {
    set_point_taken_ = true;
    target_reached_ = false;
    profile_position_ = position();
    const bool relative = (controlword & kControlwordRelative) != 0;
    profile_target_ = relative ? std::int64_t{position()} + target_position() : target_position();
    profile_target_ = std::clamp<std::int64_t>(profile_target_, std::numeric_limits<std::int32_t>::min(),
                                               std::numeric_limits<std::int32_t>::max());
  }
}

void Cia402Drive::follow(Timestamp now) {
  const double dt = std::max(0.0, seconds(now - moved_));
  moved_ = now;
  if (!config_.follows_targets || state_ != Cia402State::operation_enabled) return;
  const std::int32_t from = position();
  if (mode() == DriveMode::cyclic_sync_position) {
    objects_.write_integer(kPositionActual, target_position());
  } else if (mode() == DriveMode::profile_position && !target_reached_) {
    const double step = dt * static_cast<double>(object(0x6081));
    const double left = static_cast<double>(profile_target_) - profile_position_;
    target_reached_ = std::abs(left) <= step;
    profile_position_ =
        target_reached_ ? static_cast<double>(profile_target_) : profile_position_ + std::copysign(step, left);
    objects_.write_integer(kPositionActual, std::llround(profile_position_));
  }
  const double velocity = dt > 0 ? (static_cast<double>(position()) - from) / dt : 0.0;
  const double limit = std::numeric_limits<std::int32_t>::max();
  objects_.write_integer(kVelocityActual, std::llround(std::clamp(velocity, -limit, limit)));
  update_statusword();
  if (position() != from) changed(now);
}

void Cia402Drive::advance(Timestamp now) {
  if (!powered_) return;
  now_ = now;
  if (mode() == DriveMode::profile_position && now - moved_ >= kMotionStep) follow(now);
  if (heartbeat_due_.known() && now >= heartbeat_due_) {
    output_->send(encode_heartbeat({node_, nmt_}));
    const Nanoseconds period = std::chrono::milliseconds(object(0x1017));
    heartbeat_due_ = heartbeat_due_ + period;
    if (heartbeat_due_ <= now) heartbeat_due_ = now + period;
  }
  if (nmt_ != NmtState::operational) return;
  for (Tpdo& tpdo : tpdos_) {
    if (!tpdo.valid || !is_event_driven(tpdo.transmission_type)) continue;
    const bool timer = tpdo.event_due.known() && now >= tpdo.event_due;
    const bool waited = tpdo.pending && now - tpdo.sent >= tpdo.inhibit;
    if (timer || waited) send_tpdo(tpdo, now);
  }
}

Timestamp Cia402Drive::next_due() const {
  if (!powered_) return {};
  Timestamp due = heartbeat_due_;
  const bool moving = config_.follows_targets && mode() == DriveMode::profile_position && !target_reached_ &&
                      state_ == Cia402State::operation_enabled;
  if (moving) due = earlier(due, moved_ + kMotionStep);
  if (nmt_ != NmtState::operational) return due;
  for (const Tpdo& tpdo : tpdos_) {
    if (!tpdo.valid || !is_event_driven(tpdo.transmission_type)) continue;
    due = earlier(due, tpdo.event_due);
    if (tpdo.pending) due = earlier(due, tpdo.sent + tpdo.inhibit);
  }
  return due;
}

void Cia402Drive::changed(Timestamp now) {
  if (!powered_ || nmt_ != NmtState::operational) return;
  for (Tpdo& tpdo : tpdos_) {
    if (!tpdo.valid || !is_event_driven(tpdo.transmission_type)) continue;
    const std::vector<std::uint64_t> values = mapped_values(tpdo);
    if (values == tpdo.last) continue;
    // With an event timer the measured values wait for it; only a new statusword is an event of its own.
    if (tpdo.event_timer.count() > 0 && !statusword_differs(tpdo, values)) continue;
    if (!tpdo.sent.known() || now - tpdo.sent >= tpdo.inhibit) {
      send_tpdo(tpdo, now);
    } else {
      tpdo.pending = true;
    }
  }
}

bool Cia402Drive::statusword_differs(const Tpdo& tpdo, const std::vector<std::uint64_t>& values) {
  std::size_t next = 0;
  for (const PdoEntryConfig& entry : tpdo.entries) {
    if (entry.index == 0) continue;
    if (entry.index == kStatusword.index && (next >= tpdo.last.size() || tpdo.last[next] != values[next])) return true;
    ++next;
  }
  return false;
}

void Cia402Drive::send_tpdo(Tpdo& tpdo, Timestamp now) {
  tpdo.last = mapped_values(tpdo);
  tpdo.sent = now;
  tpdo.pending = false;
  if (tpdo.event_timer.count() > 0) {
    // From the due time, so that the period is kept; from now where it was sent early, or the owner called late.
    const Timestamp next = tpdo.event_due + tpdo.event_timer;
    const bool in_time = tpdo.event_due.known() && now >= tpdo.event_due && next > now;
    tpdo.event_due = in_time ? next : now + tpdo.event_timer;
  }
  output_->send(pack_pdo(tpdo.cob_id, tpdo.entries, tpdo.last));
}

std::vector<std::uint64_t> Cia402Drive::mapped_values(const Tpdo& tpdo) const {
  std::vector<std::uint64_t> values;
  values.reserve(tpdo.entries.size());
  for (const PdoEntryConfig& entry : tpdo.entries) {
    if (entry.index == 0) continue;
    const ObjectEntry* object = objects_.find({entry.index, entry.subindex});
    values.push_back(object == nullptr ? 0 : get_le(object->value, std::min<std::size_t>(object->value.size(), 8)));
  }
  return values;
}

void Cia402Drive::set_actual(std::int32_t position, std::int32_t velocity, std::int16_t torque, Timestamp now) {
  objects_.write_integer(kPositionActual, position);
  objects_.write_integer(kVelocityActual, velocity);
  objects_.write_integer(kTorqueActual, torque);
  changed(now);
}

bool Cia402Drive::set_object(ObjectAddress address, std::int64_t value) {
  return objects_.write_integer(address, value);
}

void Cia402Drive::raise_fault(std::uint16_t code, std::uint8_t error_register, Timestamp now) {
  objects_.write_integer(kErrorCode, code);
  objects_.write_integer(kErrorRegister, error_register);
  state_ = Cia402State::fault;
  update_statusword();
  send_emcy(code, error_register);
  changed(now);
}

void Cia402Drive::clear_fault(Timestamp now) {
  objects_.write_integer(kErrorCode, 0);
  objects_.write_integer(kErrorRegister, 0);
  state_ = Cia402State::switch_on_disabled;
  update_statusword();
  send_emcy(0, 0);
  changed(now);
}

void Cia402Drive::set_state(Cia402State state, Timestamp now) {
  state_ = state;
  update_statusword();
  changed(now);
}

void Cia402Drive::send_emcy(std::uint16_t code, std::uint8_t error_register) {
  if (!powered_ || nmt_ == NmtState::stopped || nmt_ == NmtState::boot_up) return;
  Emcy emcy;
  emcy.node = node_;
  emcy.code = code;
  emcy.error_register = error_register;
  output_->send(encode_emcy(emcy));
}

void Cia402Drive::update_statusword() {
  unsigned word = statusword_bits(state_) | kStatuswordRemote;
  if (target_reached_) word |= kStatuswordTargetReached;
  const bool following = mode() == DriveMode::cyclic_sync_position && state_ == Cia402State::operation_enabled;
  if (following || (mode() == DriveMode::profile_position && set_point_taken_)) word |= kStatuswordModeBit12;
  objects_.write_integer(kStatusword, word);
}

DriveMode Cia402Drive::mode() const { return static_cast<DriveMode>(object(0x6061)); }
std::int32_t Cia402Drive::target_position() const { return static_cast<std::int32_t>(object(0x607A)); }
std::int32_t Cia402Drive::position() const { return static_cast<std::int32_t>(object(0x6064)); }
std::uint16_t Cia402Drive::statusword() const { return static_cast<std::uint16_t>(object(0x6041)); }

std::int64_t Cia402Drive::object(std::uint16_t index) const {
  const auto value = objects_.integer({index, 0});
  return value ? *value : 0;
}

}  // namespace cellmirror::can
