#include "drivers/can/canopen/slave_pdos.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/earlier_due.hpp"
#include "drivers/can/canopen/pdo.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uint8_t kMappingSubindices = 8;
constexpr std::uint16_t kRpdoParameters = 0x1400;
constexpr std::uint16_t kRpdoMapping = 0x1600;
constexpr std::uint16_t kTpdoParameters = 0x1800;
constexpr std::uint16_t kTpdoMapping = 0x1A00;
constexpr std::uint8_t kHighestSync = 240;  // transmission types up to it go with SYNC
constexpr std::uint8_t kManufacturerEvent = 254;

constexpr auto kPdoRw = ObjectAccess::read_write;
constexpr auto kPdoRo = ObjectAccess::read_only;

constexpr bool is_event_driven(std::uint8_t transmission_type) { return transmission_type >= kManufacturerEvent; }
constexpr bool is_cyclic(std::uint8_t transmission_type) {
  return transmission_type >= 1 && transmission_type <= kHighestSync;
}
constexpr bool is_mapping(std::uint16_t index) {
  return (index >= kRpdoMapping && index < kTpdoParameters) || index >= kTpdoMapping;
}

// Identifiers that no PDO may have (CiA 301, table "restricted CAN-IDs").
constexpr bool is_restricted(std::uint32_t id) {
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) || (id >= 0x601 && id <= 0x67F) ||
         (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

void add_pdo(ObjectDictionary& objects, bool sent, std::uint16_t parameters, std::uint16_t mapping,
             std::uint32_t default_cob_id, const TpdoConfig* config) {
  const std::uint32_t cob_id = config != nullptr && config->cob_id != 0 ? config->cob_id : default_cob_id;
  objects.set_integer({parameters, 0}, DataType::unsigned8, kPdoRo, sent ? 6 : 5, "highest subindex");
  objects.set_integer({parameters, 1}, DataType::unsigned32, kPdoRw,
                      config != nullptr ? cob_id : cob_id | kCobIdInvalid, "COB-ID");
  objects.set_integer({parameters, 2}, DataType::unsigned8, kPdoRw, config != nullptr ? config->transmission_type : 255,
                      "transmission type");
  objects.set_integer({parameters, 3}, DataType::unsigned16, kPdoRw, config != nullptr ? config->inhibit_time_100us : 0,
                      "inhibit time");
  objects.set_integer({parameters, 5}, DataType::unsigned16, kPdoRw, config != nullptr ? config->event_timer_ms : 0,
                      "event timer");
  if (sent) objects.set_integer({parameters, 6}, DataType::unsigned8, kPdoRw, 0, "SYNC start value");
  const std::size_t entries = config != nullptr ? config->entries.size() : 0;
  objects.set_integer({mapping, 0}, DataType::unsigned8, kPdoRw, static_cast<std::int64_t>(entries), "mapped objects");
  for (std::uint8_t i = 0; i < kMappingSubindices; ++i) {
    const std::uint32_t word = i < entries ? mapping_word(config->entries[i]) : 0;
    objects.set_integer({mapping, static_cast<std::uint8_t>(i + 1)}, DataType::unsigned32, kPdoRw, word,
                        "mapped object");
  }
}

const TpdoConfig* find_pdo(std::span<const TpdoConfig> pdos, int number) {
  const auto found = std::ranges::find(pdos, number, &TpdoConfig::number);
  return found == pdos.end() ? nullptr : &*found;
}

void expect_valid(std::span<const TpdoConfig> pdos) {
  for (const TpdoConfig& pdo : pdos) {
    CELLMIRROR_EXPECTS(pdo.number >= 1 && pdo.number <= kSlavePdos && pdo.entries.size() <= kMappingSubindices);
    CELLMIRROR_EXPECTS(is_valid_mapping(pdo.entries));
  }
}

}  // namespace

void add_pdo_objects(ObjectDictionary& objects, std::uint8_t node, std::span<const TpdoConfig> rpdos,
                     std::span<const TpdoConfig> tpdos) {
  CELLMIRROR_EXPECTS(node >= 1 && node <= kMaxNodeId);
  expect_valid(rpdos);
  expect_valid(tpdos);
  for (std::uint16_t i = 0; i < kSlavePdos; ++i) {
    add_pdo(objects, false, static_cast<std::uint16_t>(kRpdoParameters + i),
            static_cast<std::uint16_t>(kRpdoMapping + i), rpdo_cob_id(i + 1, node), find_pdo(rpdos, i + 1));
    add_pdo(objects, true, static_cast<std::uint16_t>(kTpdoParameters + i),
            static_cast<std::uint16_t>(kTpdoMapping + i), tpdo_cob_id(i + 1, node), find_pdo(tpdos, i + 1));
  }
}

SlavePdos::SlavePdos(ObjectDictionary& objects, ObjectAddress event, const PdoEvents& events, FrameOutput& output)
    : objects_(&objects), event_(event), events_(&events), output_(&output), tpdos_(kSlavePdos), rpdos_(kSlavePdos) {
  load({});
}

std::uint32_t SlavePdos::number(std::uint16_t index, std::uint8_t subindex) const {
  return static_cast<std::uint32_t>(objects_->integer({index, subindex}).value_or(0));
}

std::optional<SdoAbort> SlavePdos::check(ObjectAddress address, std::uint64_t value) const {
  return is_mapping(address.index) ? check_mapping(address, value) : check_parameter(address, value);
}

std::optional<SdoAbort> SlavePdos::check_parameter(ObjectAddress address, std::uint64_t value) const {
  const std::uint32_t now = number(address.index, 1);
  const bool exists = (now & kCobIdInvalid) == 0;
  const bool sent = address.index >= kTpdoParameters;
  switch (address.subindex) {
    case 1: {
      const auto cob_id = static_cast<std::uint32_t>(value);
      if ((cob_id & kCobIdExtended) != 0) return SdoAbort::invalid_value;
      if ((cob_id & kCobIdInvalid) != 0) return {};
      if (is_restricted(cob_id & 0x1FFF'FFFFU)) return SdoAbort::invalid_value;
      if (exists && (cob_id & 0x7FFU) != (now & 0x7FFU)) return SdoAbort::device_state;
      return {};
    }
    case 2: {
      const bool known = value <= kHighestSync || value >= kManufacturerEvent;
      return known ? std::nullopt : std::optional(SdoAbort::invalid_value);
    }
    case 6:
      if (sent && exists) return SdoAbort::device_state;
      return value <= kHighestSync ? std::nullopt : std::optional(SdoAbort::value_too_high);
    default:
      return {};
  }
}

// CiA 301, 7.5.2.36: a mapping is changed while the PDO is invalid and subindex 0 is 0.
std::optional<SdoAbort> SlavePdos::check_mapping(ObjectAddress address, std::uint64_t value) const {
  const auto parameters = static_cast<std::uint16_t>(address.index - (kTpdoMapping - kTpdoParameters));
  if ((number(parameters, 1) & kCobIdInvalid) == 0) return SdoAbort::device_state;
  if (address.subindex == 0) return check_mapping_count(address, value);
  if (number(address.index, 0) != 0) return SdoAbort::unsupported_access;
  return check_mapped_object(address.index < kTpdoParameters, static_cast<std::uint32_t>(value));
}

std::optional<SdoAbort> SlavePdos::check_mapping_count(ObjectAddress address, std::uint64_t value) const {
  if (value > kMappingSubindices) return SdoAbort::value_too_high;
  std::size_t bits = 0;
  const auto count = static_cast<std::uint8_t>(value);
  for (std::uint8_t i = 1; i <= count; ++i) {
    const std::uint32_t word = number(address.index, i);
    if ((word & 0xFFU) == 0) return SdoAbort::invalid_value;
    bits += word & 0xFFU;
  }
  return bits > kMaxPdoBits ? std::optional(SdoAbort::pdo_too_long) : std::nullopt;
}

std::optional<SdoAbort> SlavePdos::check_mapped_object(bool received, std::uint32_t word) const {
  const PdoEntryConfig entry = entry_of_mapping_word(word);
  if (word == 0 || entry.index == 0) return {};
  const ObjectEntry* mapped = objects_->find({entry.index, entry.subindex});
  if (mapped == nullptr) {
    return objects_->has_index(entry.index) ? SdoAbort::no_such_subindex : SdoAbort::no_such_object;
  }
  if (!mapped->pdo_mappable || 8 * size_of(mapped->type) != entry.bits) return SdoAbort::not_mappable;
  const bool writable = mapped->access == ObjectAccess::read_write || mapped->access == ObjectAccess::write_only;
  const bool readable = mapped->access != ObjectAccess::write_only;
  return (received ? writable : readable) ? std::nullopt : std::optional(SdoAbort::not_mappable);
}

std::vector<PdoEntryConfig> SlavePdos::mapping_of(std::uint16_t index) const {
  std::vector<PdoEntryConfig> entries;
  const std::uint32_t count = number(index, 0);
  for (std::uint8_t i = 1; i <= count && i <= kMappingSubindices; ++i) {
    entries.push_back(entry_of_mapping_word(number(index, i)));
  }
  return entries;
}

void SlavePdos::load(Timestamp now) {
  for (std::uint16_t i = 0; i < kSlavePdos; ++i) {
    load_tpdo(i, now);
    load_rpdo(i);
  }
}

void SlavePdos::load_pdo_of(ObjectAddress parameter, Timestamp now) {
  const bool sent = parameter.index >= kTpdoParameters;
  const std::uint16_t first = sent ? kTpdoParameters : kRpdoParameters;
  const auto i = static_cast<std::uint16_t>((parameter.index - first) % (kRpdoMapping - kRpdoParameters));
  if (i >= kSlavePdos) return;
  if (sent) {
    load_tpdo(i, now);
  } else {
    load_rpdo(i);
  }
}

void SlavePdos::load_tpdo(std::uint16_t i, Timestamp now) {
  const auto parameters = static_cast<std::uint16_t>(kTpdoParameters + i);
  Tpdo& tpdo = tpdos_[i];
  tpdo.cob_id = number(parameters, 1) & 0x7FFU;
  tpdo.on_request = (number(parameters, 1) & kCobIdNoRtr) == 0;
  tpdo.transmission_type = static_cast<std::uint8_t>(number(parameters, 2));
  tpdo.inhibit = std::chrono::microseconds(100) * number(parameters, 3);
  tpdo.event_timer = std::chrono::milliseconds(number(parameters, 5));
  tpdo.sync_start = static_cast<std::uint8_t>(number(parameters, 6));
  tpdo.counting = tpdo.sync_start == 0;
  tpdo.entries = mapping_of(static_cast<std::uint16_t>(kTpdoMapping + i));
  tpdo.valid = (number(parameters, 1) & kCobIdInvalid) == 0 && is_valid_mapping(tpdo.entries);
  tpdo.last.clear();
  tpdo.event_due = {};
  if (tpdo.event_timer.count() > 0 && now.known()) tpdo.event_due = now + tpdo.event_timer;
}

void SlavePdos::load_rpdo(std::uint16_t i) {
  const auto parameters = static_cast<std::uint16_t>(kRpdoParameters + i);
  Rpdo& rpdo = rpdos_[i];
  rpdo.cob_id = number(parameters, 1) & 0x7FFU;
  rpdo.on_sync = number(parameters, 2) <= kHighestSync;
  rpdo.entries = mapping_of(static_cast<std::uint16_t>(kRpdoMapping + i));
  rpdo.valid = (number(parameters, 1) & kCobIdInvalid) == 0 && is_valid_mapping(rpdo.entries);
  rpdo.waiting.reset();
  rpdo.event_timer = std::chrono::milliseconds(number(parameters, 5));
  rpdo.due = {};
  rpdo.late = false;
}

void SlavePdos::start(Timestamp now) {
  for (Tpdo& tpdo : tpdos_) {
    tpdo.syncs = 0;
    tpdo.counting = tpdo.sync_start == 0;
    if (tpdo.valid && is_event_driven(tpdo.transmission_type)) send(tpdo, now);
  }
}

void SlavePdos::stop() {
  for (Rpdo& rpdo : rpdos_) {
    rpdo.due = {};
    rpdo.late = false;
  }
}

void SlavePdos::list_identifiers(std::vector<std::uint32_t>& identifiers) const {
  for (const Rpdo& rpdo : rpdos_) {
    if (rpdo.valid) identifiers.push_back(rpdo.cob_id);
  }
  for (const Tpdo& tpdo : tpdos_) {
    if (tpdo.valid && tpdo.on_request) identifiers.push_back(tpdo.cob_id);
  }
}

void SlavePdos::request(std::uint32_t id, Timestamp now) {
  for (Tpdo& tpdo : tpdos_) {
    if (tpdo.valid && tpdo.on_request && tpdo.cob_id == id) return send(tpdo, now);
  }
}

bool SlavePdos::watch(Timestamp now) {
  bool found = false;
  for (Rpdo& rpdo : rpdos_) {
    if (!rpdo.due.known() || now < rpdo.due) continue;
    rpdo.due = {};
    rpdo.late = true;
    found = true;
  }
  return found;
}

bool SlavePdos::is_late() const { return std::ranges::any_of(rpdos_, &Rpdo::late); }

SlavePdos::Received SlavePdos::receive(const CanFrame& frame, std::vector<ObjectAddress>& written, Timestamp now) {
  if (frame.extended) return Received::none;
  for (Rpdo& rpdo : rpdos_) {
    if (!rpdo.valid || frame.id != rpdo.cob_id) continue;
    if (frame.length < pdo_length(rpdo.entries)) return Received::too_short;
    rpdo.late = false;
    rpdo.due = rpdo.event_timer.count() > 0 ? now + rpdo.event_timer : Timestamp{};
    if (rpdo.on_sync) {
      rpdo.waiting = frame;
    } else {
      apply(rpdo, frame, written);
    }
    return Received::taken;
  }
  return Received::none;
}

void SlavePdos::apply_on_sync(std::vector<ObjectAddress>& written) {
  for (Rpdo& rpdo : rpdos_) {
    if (!rpdo.waiting) continue;
    const CanFrame frame = *std::exchange(rpdo.waiting, std::nullopt);
    apply(rpdo, frame, written);
  }
}

void SlavePdos::apply(const Rpdo& rpdo, const CanFrame& frame, std::vector<ObjectAddress>& written) {
  std::size_t bit = 0;
  for (const PdoEntryConfig& entry : rpdo.entries) {
    const std::size_t from = std::exchange(bit, bit + entry.bits);
    const ObjectAddress address{entry.index, entry.subindex};
    ObjectEntry* object = entry.index == 0 ? nullptr : objects_->find(address);
    if (object == nullptr) continue;
    put_le(object->value, get_bits(frame.data, from, entry.bits), std::min<std::size_t>(object->value.size(), 8));
    written.push_back(address);
  }
}

bool SlavePdos::counts(Tpdo& tpdo, std::optional<std::uint8_t> counter) const {
  if (!tpdo.counting && counter == tpdo.sync_start) {
    tpdo.counting = true;
    tpdo.syncs = tpdo.transmission_type - 1U;  // this SYNC is the first
  }
  return tpdo.counting || !counter;
}

void SlavePdos::send_on_sync(std::optional<std::uint8_t> counter, Timestamp now) {
  for (Tpdo& tpdo : tpdos_) {
    if (!tpdo.valid) continue;
    if (is_cyclic(tpdo.transmission_type)) {
      if (!counts(tpdo, counter) || ++tpdo.syncs < tpdo.transmission_type) continue;
      tpdo.syncs = 0;
      send(tpdo, now);
    } else if (tpdo.transmission_type == 0) {
      read_values(tpdo, values_);
      if (values_ != tpdo.last) send(tpdo, now);
    }
  }
}

void SlavePdos::changed(Timestamp now) {
  for (Tpdo& tpdo : tpdos_) {
    if (!tpdo.valid || !is_event_driven(tpdo.transmission_type)) continue;
    read_values(tpdo, values_);
    if (values_ == tpdo.last || !has_event(tpdo, values_)) continue;
    // With an event timer the measured values wait for it; only a new statusword is an event of its own.
    if (tpdo.event_timer.count() > 0 && !event_differs(tpdo, values_)) continue;
    if (!tpdo.sent.known() || now - tpdo.sent >= tpdo.inhibit) {
      send(tpdo, now);
    } else {
      tpdo.pending = true;
    }
  }
}

void SlavePdos::advance(Timestamp now) {
  for (Tpdo& tpdo : tpdos_) {
    if (!tpdo.valid || !is_event_driven(tpdo.transmission_type)) continue;
    const bool timer = tpdo.event_due.known() && now >= tpdo.event_due;
    const bool waited = tpdo.pending && now - tpdo.sent >= tpdo.inhibit;
    if (timer || waited) send(tpdo, now);
  }
}

Timestamp SlavePdos::next_due() const {
  Timestamp due;
  for (const Tpdo& tpdo : tpdos_) {
    if (!tpdo.valid || !is_event_driven(tpdo.transmission_type)) continue;
    due = earlier_due(due, tpdo.event_due);
    if (tpdo.pending) due = earlier_due(due, tpdo.sent + tpdo.inhibit);
  }
  for (const Rpdo& rpdo : rpdos_) due = earlier_due(due, rpdo.due);
  return due;
}

bool SlavePdos::has_event(const Tpdo& tpdo, std::span<const std::uint64_t> values) const {
  std::size_t next = 0;
  for (const PdoEntryConfig& entry : tpdo.entries) {
    if (entry.index == 0) continue;
    if (next >= tpdo.last.size()) return true;
    const std::uint64_t sent = tpdo.last[next];
    if (sent != values[next] && events_->is_event({entry.index, entry.subindex}, sent, values[next])) return true;
    ++next;
  }
  return false;
}

bool SlavePdos::event_differs(const Tpdo& tpdo, std::span<const std::uint64_t> values) const {
  std::size_t next = 0;
  for (const PdoEntryConfig& entry : tpdo.entries) {
    if (entry.index == 0) continue;
    const bool is_event = ObjectAddress{entry.index, entry.subindex} == event_;
    if (is_event && (next >= tpdo.last.size() || tpdo.last[next] != values[next])) return true;
    ++next;
  }
  return false;
}

void SlavePdos::send(Tpdo& tpdo, Timestamp now) {
  read_values(tpdo, tpdo.last);
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

void SlavePdos::read_values(const Tpdo& tpdo, std::vector<std::uint64_t>& values) const {
  values.clear();
  for (const PdoEntryConfig& entry : tpdo.entries) {
    if (entry.index == 0) continue;
    const ObjectEntry* object = objects_->find({entry.index, entry.subindex});
    values.push_back(object == nullptr ? 0 : get_le(object->value, std::min<std::size_t>(object->value.size(), 8)));
  }
}

}  // namespace cellmirror::can
