#include "drivers/can/canopen/slave.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/earlier_due.hpp"
#include "drivers/can/canopen/emcy.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

constexpr auto kServedRw = ObjectAccess::read_write;
constexpr auto kServedRo = ObjectAccess::read_only;

constexpr ObjectAddress kErrorRegister{0x1001, 0};
constexpr std::uint16_t kErrorField = 0x1003;
constexpr std::uint8_t kErrorHistory = 8;
constexpr ObjectAddress kHeartbeatConsumer{0x1016, 1};
constexpr std::uint16_t kHeartbeatProducer = 0x1017;
constexpr std::uint16_t kStoreObject = 0x1010;
constexpr std::uint16_t kRestoreObject = 0x1011;
constexpr std::uint32_t kSave = 0x6576'6173;  // "save"
constexpr std::uint32_t kLoad = 0x6461'6F6C;  // "load"
constexpr std::uint16_t kSyncCounter = 0x1019;
constexpr std::uint16_t kSyncPeriod = 0x1006;
constexpr std::uint16_t kEmcyInhibit = 0x1015;
constexpr std::size_t kMostEmergencies = 32;  // waiting; further ones are only listed in 0x1003
constexpr std::uint16_t kEmcyPdoLength = 0x8210;
constexpr std::uint16_t kEmcySyncLength = 0x8240;
constexpr std::uint16_t kEmcyRpdoLate = 0x8250;
constexpr std::uint16_t kEmcyMasterLost = 0x8130;
constexpr std::uint8_t kErrorGeneric = 0x01;
constexpr std::uint8_t kErrorCommunication = 0x10;

// CiA 301, 7.5.2.2: what the classes of error codes are in the error register.
std::uint8_t error_register_of(std::uint16_t code) {
  switch (code >> 12U) {
    case 0x2:
      return kErrorGeneric | 0x02;  // current
    case 0x3:
      return kErrorGeneric | 0x04;  // voltage
    case 0x4:
      return kErrorGeneric | 0x08;  // temperature
    case 0x8:
      return kErrorGeneric | (code >> 8U == 0x81 || code >> 8U == 0x82 ? kErrorCommunication : 0x20);
    case 0x7:
      return kErrorGeneric | 0x20;  // device profile
    case 0xF:
      return kErrorGeneric | 0x80;  // manufacturer
    default:
      return kErrorGeneric;
  }
}

void add_text(ObjectDictionary& objects, std::uint16_t index, const char* name, std::string_view value) {
  ObjectEntry entry;
  entry.name = name;
  entry.type = DataType::visible_string;
  entry.access = ObjectAccess::constant;
  entry.value.assign(value.begin(), value.end());
  objects.set({index, 0}, entry);
}

constexpr bool is_communication(ObjectAddress address) { return address.index >= 0x1000 && address.index <= 0x1FFF; }

}  // namespace

void add_communication_objects(ObjectDictionary& objects, std::uint8_t node, const SlaveIdentity& identity) {
  objects.set_integer({0x1000, 0}, DataType::unsigned32, kServedRo, identity.device_type, "device type");
  objects.set_integer(kErrorRegister, DataType::unsigned8, kServedRo, 0, "error register", true);
  objects.set_integer({kErrorField, 0}, DataType::unsigned8, kServedRw, 0, "errors");
  for (std::uint8_t i = 1; i <= kErrorHistory; ++i) {
    objects.set_integer({kErrorField, i}, DataType::unsigned32, kServedRo, 0, "error");
  }
  objects.set_integer({0x1005, 0}, DataType::unsigned32, kServedRw, kSyncCobId, "COB-ID SYNC");
  objects.set_integer({kSyncPeriod, 0}, DataType::unsigned32, kServedRw, 0, "communication cycle period");
  add_text(objects, 0x1008, "manufacturer device name", identity.name);
  add_text(objects, 0x1009, "manufacturer hardware version", "simulated");
  add_text(objects, 0x100A, "manufacturer software version", "1");
  objects.set_integer({0x100C, 0}, DataType::unsigned16, kServedRw, 0, "guard time");
  objects.set_integer({0x100D, 0}, DataType::unsigned8, kServedRw, 0, "life time factor");
  // Value 1: the device stores or restores on command, all parameters at once.
  for (const auto& [index, object_name] :
       {std::pair(kStoreObject, "store parameters"), std::pair(kRestoreObject, "restore defaults")}) {
    objects.set_integer({index, 0}, DataType::unsigned8, kServedRo, 1, object_name);
    objects.set_integer({index, 1}, DataType::unsigned32, kServedRw, 1, object_name);
  }
  objects.set_integer({0x1014, 0}, DataType::unsigned32, kServedRo, kEmcyBase + node, "COB-ID EMCY");
  objects.set_integer({kEmcyInhibit, 0}, DataType::unsigned16, kServedRw, 0, "inhibit time EMCY");
  objects.set_integer({kHeartbeatConsumer.index, 0}, DataType::unsigned8, kServedRo, 1, "heartbeats that are watched");
  objects.set_integer(kHeartbeatConsumer, DataType::unsigned32, kServedRw, 0, "node and time of a watched heartbeat");
  objects.set_integer({kHeartbeatProducer, 0}, DataType::unsigned16, kServedRw, identity.heartbeat_ms,
                      "producer heartbeat time");
  objects.set_integer({0x1018, 0}, DataType::unsigned8, kServedRo, 4, "identity");
  constexpr const char* kIdentity[] = {"vendor", "product code", "revision number", "serial number"};
  for (std::uint8_t i = 1; i <= 4; ++i) {
    objects.set_integer({0x1018, i}, DataType::unsigned32, kServedRo, i == 4 ? node : 0, kIdentity[i - 1]);
  }
  objects.set_integer({kSyncCounter, 0}, DataType::unsigned8, kServedRw, 0, "synchronous counter overflow value");
  objects.set_integer({0x1029, 0}, DataType::unsigned8, kServedRo, 1, "error behaviour");
  objects.set_integer({0x1029, 1}, DataType::unsigned8, kServedRw, 0, "communication error");
  objects.set_integer({0x1200, 0}, DataType::unsigned8, kServedRo, 2, "SDO server");
  objects.set_integer({0x1200, 1}, DataType::unsigned32, kServedRo, kSdoRequestBase + node, "COB-ID client to server");
  objects.set_integer({0x1200, 2}, DataType::unsigned32, kServedRo, kSdoResponseBase + node, "COB-ID server to client");
}

CanopenSlave::CanopenSlave(std::uint8_t node, ObjectDictionary defaults, ObjectAddress event,
                           SlaveApplication& application, FrameOutput& output)
    : node_(node),
      first_node_(node),
      lss_(node),
      application_(&application),
      gate_(output),
      defaults_(std::move(defaults)),
      factory_(defaults_),
      objects_(defaults_),
      server_(node, *this),
      pdos_(objects_, event, application, gate_) {
  CELLMIRROR_EXPECTS(node >= 1 && node <= kMaxNodeId);
}

void CanopenSlave::wait_for_number() {
  first_node_ = node_ = kNoNodeNumber;
  lss_.restart(kNoNodeNumber);
}

void CanopenSlave::power_on(NmtState first, Timestamp now) {
  now_ = now;
  powered_ = true;
  first_ = first;
  reset(ResetKind::node, now);
}

void CanopenSlave::power_off() {
  powered_ = false;
  nmt_ = NmtState::boot_up;
}

void CanopenSlave::reset_objects(ResetKind kind) {
  communication_errors_ = 0;
  emergencies_.clear();
  emergency_sent_ = {};
  if (kind == ResetKind::node) {
    if (std::exchange(restores_, false)) defaults_ = factory_;
    objects_ = defaults_;
    device_errors_ = 0;
    return;
  }
  for (const auto& [address, entry] : defaults_.entries()) {
    if (is_communication(address)) objects_.set(address, entry);
  }
  objects_.write_integer(kErrorRegister, error_register());
}

void CanopenSlave::reset(ResetKind kind, Timestamp now) {
  reset_objects(kind);
  server_.reset();
  pdos_.load(now);
  ++identifiers_revision_;
  master_due_ = {};
  guard_due_ = {};
  guard_toggle_ = false;
  nmt_ = NmtState::boot_up;
  const bool fails = kind == ResetKind::communication && application_->communication_lost(now);
  if (kind == ResetKind::node) application_->on_reset(now);
  heartbeat_due_ = {};
  if (node_ != kNoNodeNumber) {
    gate_.send(encode_heartbeat({node_, NmtState::boot_up}));
    restart_heartbeat(now);
    enter(first_, now);
  }
  // After the boot-up message: nothing is sent before it.
  if (fails) emergency(kEmcyMasterLost, kErrorGeneric | kErrorCommunication);
}

void CanopenSlave::enter(NmtState state, Timestamp now) {
  if (std::exchange(nmt_, state) == state) return;
  if (state == NmtState::operational) {
    pdos_.start(now);
  } else {
    pdos_.stop();
    clear_error(rpdo_late);
  }
  if (state == NmtState::stopped) {
    server_.reset();
    if (application_->communication_lost(now)) emergency(kEmcyMasterLost, kErrorGeneric | kErrorCommunication);
  }
}

void CanopenSlave::on_lss(const CanFrame& frame, Timestamp now) {
  const LssSlave::Reaction reaction = lss_.receive(frame, identity(), node_);
  if (reaction.answer) gate_.send(*reaction.answer);
  if (reaction.starts) on_nmt(NmtCommand::reset_communication, now);
}

// Those that receive() looks at.
void CanopenSlave::list_identifiers(std::vector<std::uint32_t>& identifiers) const {
  if (node_ == kNoNodeNumber) {
    identifiers.push_back(kLssMasterCobId);
    return;
  }
  identifiers.insert(identifiers.end(),
                     {kNmtCobId, kSyncCobId, kLssMasterCobId, kSdoRequestBase + node_, kHeartbeatBase + node_});
  const auto watched = static_cast<std::uint32_t>(object(kHeartbeatConsumer.index, kHeartbeatConsumer.subindex));
  if (const std::uint32_t node = watched >> 16U & 0xFFU; node > 0) identifiers.push_back(kHeartbeatBase + node);
  pdos_.list_identifiers(identifiers);
}

void CanopenSlave::receive(const CanFrame& frame, Timestamp now) {
  if (!powered_ || frame.error) return;
  now_ = now;
  follow_faults(now);
  if (gate_.is_dead()) return;
  if (frame.remote) {
    on_request(frame, now);
    return;
  }
  if (!frame.extended && frame.id == kLssMasterCobId) {
    on_lss(frame, now);
    return;
  }
  if (node_ == kNoNodeNumber) return;
  if (const auto message = decode_nmt(frame)) {
    if (message->node == 0 || message->node == node_) on_nmt(message->command, now);
    return;
  }
  if (is_service_frame(frame) && frame.id == kSyncCobId) {
    on_sync(frame, now);
    return;
  }
  if (const auto heartbeat = decode_heartbeat(frame)) {
    on_heartbeat(*heartbeat, now);
    return;
  }
  if (nmt_ == NmtState::operational) on_rpdo(frame, now);
  if (nmt_ == NmtState::stopped) return;
  if (const auto answer = server_.receive(frame, now)) gate_.send(*answer);
  drain_server(now);
}

void CanopenSlave::on_nmt(NmtCommand command, Timestamp now) {
  switch (command) {
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
      renumber(first_node_);
      return reset(ResetKind::node, now);
    case NmtCommand::reset_communication:
      renumber(lss_.pending());
      return reset(ResetKind::communication, now);
  }
}

// The predefined identifiers are a base, whose lower 7 bits are 0, and the node's number.
void CanopenSlave::renumber(std::uint8_t node) {
  constexpr std::int64_t kNodeBits = 0x7F;
  lss_.restart(node);
  if (std::exchange(node_, node) == node || node == kNoNodeNumber) return;
  server_.set_node(node);
  std::vector<ObjectAddress> identifiers{{0x1014, 0}, {0x1200, 1}, {0x1200, 2}};
  for (std::uint16_t i = 0; i < kSlavePdos; ++i) {
    identifiers.push_back({static_cast<std::uint16_t>(0x1400 + i), 1});
    identifiers.push_back({static_cast<std::uint16_t>(0x1800 + i), 1});
  }
  for (const ObjectAddress& address : identifiers) {
    for (ObjectDictionary* objects : {&defaults_, &factory_}) {
      if (const auto value = objects->integer(address)) objects->write_integer(address, (*value & ~kNodeBits) | node);
    }
  }
}

LssSlave::Identity CanopenSlave::identity() const {
  LssSlave::Identity numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers.at(i) = static_cast<std::uint32_t>(object(0x1018, static_cast<std::uint8_t>(i + 1)));
  return numbers;
}

// A SYNC has length 1 if object 0x1019 enables the counter, else 0 (CiA 301, 7.2.5). Another length is reported; the
// frame is then used as a SYNC without a counter, unless it is too long to be a SYNC.
void CanopenSlave::on_sync(const CanFrame& frame, Timestamp now) {
  const bool counted = object(kSyncCounter) != 0;
  if (frame.length == (counted ? 1 : 0)) {
    clear_error(wrong_sync_length);
  } else {
    set_error(wrong_sync_length, kEmcySyncLength);
  }
  if (nmt_ != NmtState::operational || !is_sync(frame)) return;
  pdos_.send_on_sync(counted && frame.length == 1 ? std::optional(frame.data[0]) : std::nullopt, now);
  written_.clear();
  pdos_.apply_on_sync(written_);
  if (!written_.empty()) after_write(written_, now);
  application_->synced(now);
}

void CanopenSlave::on_rpdo(const CanFrame& frame, Timestamp now) {
  written_.clear();
  const SlavePdos::Received received = pdos_.receive(frame, written_, now);
  // Once, until one has the right length again: a flood is not answered by a flood.
  if (received == SlavePdos::Received::too_short) set_error(wrong_pdo_length, kEmcyPdoLength);
  if (received == SlavePdos::Received::taken) {
    clear_error(wrong_pdo_length);
    if (!pdos_.is_late()) clear_error(rpdo_late);
  }
  if (!written_.empty()) after_write(written_, now);
}

// A remote frame requests a TPDO or the NMT state (node guarding).
void CanopenSlave::on_request(const CanFrame& frame, Timestamp now) {
  if (node_ == kNoNodeNumber || frame.extended) return;
  if (frame.id == kHeartbeatBase + node_) return on_guarding(now);
  if (nmt_ == NmtState::operational) pdos_.request(frame.id, now);
}

// CiA 301, 7.2.8.3.2.1: the answer alternates bit 7, from 0. A node that produces heartbeats is not guarded
// (7.2.8.3.2).
void CanopenSlave::on_guarding(Timestamp now) {
  if (object(kHeartbeatProducer) != 0) return;
  const auto state = static_cast<std::uint8_t>(static_cast<unsigned>(nmt_) | (guard_toggle_ ? 0x80U : 0U));
  guard_toggle_ = !guard_toggle_;
  gate_.send(make_frame(kHeartbeatBase + node_, {state}));
  const Nanoseconds life = std::chrono::milliseconds(object(0x100C) * object(0x100D));
  guard_due_ = life.count() > 0 ? now + life : Timestamp{};
  clear_error(guarding_lost);
}

void CanopenSlave::on_heartbeat(const Heartbeat& heartbeat, Timestamp now) {
  const auto watched = static_cast<std::uint32_t>(object(kHeartbeatConsumer.index, kHeartbeatConsumer.subindex));
  const Nanoseconds time = std::chrono::milliseconds(watched & 0xFFFFU);
  if ((watched >> 16U & 0xFFU) != heartbeat.node || time.count() == 0) return;
  master_due_ = now + time;
  clear_error(heartbeat_lost);
}

void CanopenSlave::master_lost(CommunicationError error, Timestamp now) {
  set_error(error, kEmcyMasterLost);
  if (application_->communication_lost(now)) {
    device_errors_ = error_register();
    communication_errors_ = static_cast<std::uint8_t>(communication_errors_ & ~error);
  }
  // Object 0x1029: 0 pre-operational, 1 no change, 2 stopped.
  const std::int64_t behaviour = object(0x1029, 1);
  if (behaviour == 0 && nmt_ == NmtState::operational) enter(NmtState::pre_operational, now);
  if (behaviour == 2) enter(NmtState::stopped, now);
}

void CanopenSlave::restart_heartbeat(Timestamp now) {
  const std::int64_t heartbeat_ms = object(kHeartbeatProducer);
  heartbeat_due_ = heartbeat_ms > 0 ? now + std::chrono::milliseconds(heartbeat_ms) : Timestamp{};
}

void CanopenSlave::after_write(std::span<const ObjectAddress> addresses, Timestamp now) {
  const auto has = [&](std::uint16_t index) {
    return std::ranges::any_of(addresses, [index](ObjectAddress address) { return address.index == index; });
  };
  bool has_parameter = false;
  for (const ObjectAddress& address : addresses) {
    if (!SlavePdos::is_parameter(address)) continue;
    pdos_.load_pdo_of(address, now);
    has_parameter = true;
  }
  if (has_parameter && !pdos_.is_late()) clear_error(rpdo_late);
  if (has_parameter || has(kHeartbeatConsumer.index)) ++identifiers_revision_;
  if (has(kHeartbeatProducer)) {
    restart_heartbeat(now);
    if (object(kHeartbeatProducer) != 0) {
      guard_due_ = {};
      clear_error(guarding_lost);
    }
  }
  if (has(kHeartbeatConsumer.index)) {
    master_due_ = {};
    clear_error(heartbeat_lost);  // the node now watches another master, or none
  }
  if (has(kErrorField)) {
    for (std::uint8_t i = 1; i <= kErrorHistory; ++i) objects_.write_integer({kErrorField, i}, 0);
  }
  application_->written(addresses, now);
}

std::expected<std::vector<std::uint8_t>, SdoAbort> CanopenSlave::read(ObjectAddress address) {
  const bool is_error = address.index == kErrorField && address.subindex > object(kErrorField);
  if (is_error && address.subindex <= kErrorHistory) return std::unexpected(SdoAbort::no_data);
  return read_object(objects_, address);
}

std::optional<SdoAbort> CanopenSlave::write(ObjectAddress address, std::span<const std::uint8_t> value) {
  if (const auto abort = check_write(objects_, address, value)) return abort;
  if (address.index == kStoreObject || address.index == kRestoreObject) return store(address, value);
  const ObjectEntry& entry = *objects_.find(address);
  if (is_integer_type(entry.type)) {
    const std::uint64_t raw = get_le(value, value.size());
    const auto number =
        is_signed_type(entry.type) ? sign_extended(raw, 8 * value.size()) : static_cast<std::int64_t>(raw);
    if (const auto abort = refuse(address, number)) return abort;
  }
  if (const auto abort = write_object(objects_, address, value)) return abort;
  after_write(std::span(&address, 1), now_);
  return {};
}

// CiA 301, 7.5.2.13 and 7.5.2.14: a signature prevents accidental writes; reading returns the capabilities.
std::optional<SdoAbort> CanopenSlave::store(ObjectAddress address, std::span<const std::uint8_t> value) {
  const bool saves = address.index == kStoreObject;
  if (get_le(value, value.size()) != (saves ? kSave : kLoad)) return SdoAbort::cannot_store;
  if (!saves) {
    restores_ = true;
    return {};
  }
  restores_ = false;
  for (const auto& [place, entry] : objects_.entries()) {
    const bool is_own = place.index == kErrorField || place.index == kStoreObject || place.index == kRestoreObject;
    if (is_own || entry.access != ObjectAccess::read_write || !application_->is_stored(place)) continue;
    defaults_.find(place)->value = entry.value;
  }
  return {};
}

std::optional<SdoAbort> CanopenSlave::refuse(ObjectAddress address, std::int64_t value) {
  if (SlavePdos::is_parameter(address)) return pdos_.check(address, static_cast<std::uint64_t>(value));
  if (address == ObjectAddress{kErrorField, 0} && value != 0) return SdoAbort::invalid_value;
  // Other identifiers of SYNC are not supported, nor does a drive produce it.
  if (address.index == 0x1005 && value != static_cast<std::int64_t>(kSyncCobId)) return SdoAbort::invalid_value;
  if (address.index == kSyncCounter && (value == 1 || value > 240)) return SdoAbort::invalid_value;
  if (address.index == kSyncCounter && object(kSyncPeriod) != 0) return SdoAbort::device_state;
  if (address == kHeartbeatConsumer && (value >> 16 & 0xFF) > kMaxNodeId) return SdoAbort::invalid_value;
  if (address.index == 0x1029 && value > 2) return SdoAbort::invalid_value;
  return application_->check(address, value);
}

void CanopenSlave::drain_server(Timestamp now) {
  while (const auto frame = server_.advance(now)) gate_.send(*frame);
}

void CanopenSlave::inject(const NodeFault& fault, Timestamp now) {
  if (!powered_) return;
  follow_faults(now);
  const bool was_dead = gate_.is_dead();
  if (!gate_.add(fault, now) || was_dead) return;
  if (fault.kind == NodeFaultKind::emergency) {
    const std::uint8_t error_register = error_register_of(fault.code);
    reports_error_ = !application_->fail(fault.code, error_register, now);
    if (reports_error_) emergency(fault.code, error_register);
  }
  if (fault.kind != NodeFaultKind::death) return;
  reset_objects(ResetKind::node);
  server_.reset();
  pdos_.load(now);
  nmt_ = NmtState::boot_up;
  heartbeat_due_ = master_due_ = guard_due_ = {};
  application_->on_reset(now);
}

void CanopenSlave::end_faults(Timestamp now) {
  gate_.end_all();
  follow_faults(now);
}

void CanopenSlave::follow_faults(Timestamp now) {
  const FaultGate::Ended ended = gate_.advance(now);
  if (ended.death) {
    renumber(first_node_);
    reset(ResetKind::node, now);
  }
  if (ended.emergency && !gate_.is_dead() && std::exchange(reports_error_, false)) emergency(0, 0);
}

void CanopenSlave::advance(Timestamp now) {
  if (!powered_) return;
  now_ = now;
  follow_faults(now);
  if (gate_.is_dead()) return;
  drain_server(now);
  if (heartbeat_due_.known() && now >= heartbeat_due_) {
    gate_.send(encode_heartbeat({node_, nmt_}));
    const Nanoseconds period = std::chrono::milliseconds(object(kHeartbeatProducer));
    heartbeat_due_ = heartbeat_due_ + period;
    if (heartbeat_due_ <= now) heartbeat_due_ = now + period;
  }
  for (const auto& [due, error] : {std::pair(&master_due_, heartbeat_lost), std::pair(&guard_due_, guarding_lost)}) {
    if (!due->known() || now < *due) continue;
    *due = {};
    master_lost(error, now);
  }
  if (nmt_ == NmtState::operational) {
    pdos_.advance(now);
    if (pdos_.watch(now)) set_error(rpdo_late, kEmcyRpdoLate);
  }
  if (!emergencies_.empty() && now >= next_emergency()) {
    gate_.send(emergencies_.front());
    emergencies_.pop_front();
    emergency_sent_ = now;
  }
}

Timestamp CanopenSlave::next_due() const {
  if (!powered_) return {};
  Timestamp due = earlier_due(heartbeat_due_, earlier_due(master_due_, guard_due_));
  due = earlier_due(due, gate_.next_due());
  due = earlier_due(due, server_.next_due());
  if (!emergencies_.empty()) due = earlier_due(due, next_emergency());
  return nmt_ == NmtState::operational ? earlier_due(due, pdos_.next_due()) : due;
}

void CanopenSlave::changed(Timestamp now) {
  if (powered_ && nmt_ == NmtState::operational) pdos_.changed(now);
}

void CanopenSlave::emergency(std::uint16_t code, std::uint8_t error_register) {
  device_errors_ = error_register;
  report(code);
}

void CanopenSlave::set_error(CommunicationError error, std::uint16_t code) {
  // Each late RPDO is reported, even while another one is late.
  const bool is_new = (communication_errors_ & error) == 0 || error == rpdo_late;
  communication_errors_ = static_cast<std::uint8_t>(communication_errors_ | error);
  if (is_new) report(code);
}

void CanopenSlave::clear_error(CommunicationError error) {
  if ((communication_errors_ & error) == 0) return;
  communication_errors_ = static_cast<std::uint8_t>(communication_errors_ & ~error);
  report(0);
}

std::uint8_t CanopenSlave::error_register() const {
  const unsigned communication = communication_errors_ != 0 ? kErrorGeneric | kErrorCommunication : 0;
  return static_cast<std::uint8_t>(device_errors_ | communication);
}

Timestamp CanopenSlave::next_emergency() const {
  return emergency_sent_ + std::chrono::microseconds(100) * object(kEmcyInhibit);
}

void CanopenSlave::report(std::uint16_t code) {
  objects_.write_integer(kErrorRegister, error_register());
  if (code != 0) {
    const std::int64_t kept = std::min<std::int64_t>(object(kErrorField), kErrorHistory - 1);
    for (std::int64_t i = kept; i >= 1; --i) {
      objects_.write_integer({kErrorField, static_cast<std::uint8_t>(i + 1)},
                             object(kErrorField, static_cast<std::uint8_t>(i)));
    }
    objects_.write_integer({kErrorField, 1}, code);
    objects_.write_integer({kErrorField, 0}, kept + 1);
  }
  if (!powered_ || nmt_ == NmtState::stopped || nmt_ == NmtState::boot_up) return;
  Emcy emcy;
  emcy.node = node_;
  emcy.code = code;
  emcy.error_register = error_register();
  const bool waits = emergency_sent_.known() && now_ < next_emergency();
  if (waits || !emergencies_.empty()) {
    if (emergencies_.size() < kMostEmergencies) emergencies_.push_back(encode_emcy(emcy));
    return;
  }
  emergency_sent_ = now_;
  gate_.send(encode_emcy(emcy));
}

std::int64_t CanopenSlave::object(std::uint16_t index, std::uint8_t subindex) const {
  return objects_.integer({index, subindex}).value_or(0);
}

}  // namespace cellmirror::can
