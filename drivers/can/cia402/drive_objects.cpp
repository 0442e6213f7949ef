#include "drivers/can/cia402/drive_objects.hpp"

#include <array>
#include <chrono>
#include <string>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/pdo.hpp"
#include "drivers/can/cia402/drive.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uint16_t kPdoCount = 4;
constexpr std::uint8_t kMappingSubindices = 8;
constexpr std::uint16_t kRpdoParameters = 0x1400;
constexpr std::uint16_t kRpdoMapping = 0x1600;
constexpr std::uint16_t kTpdoParameters = 0x1800;
constexpr std::uint16_t kTpdoMapping = 0x1A00;

constexpr auto kRw = ObjectAccess::read_write;
constexpr auto kRo = ObjectAccess::read_only;

void add_identity(ObjectDictionary& objects, const Cia402DriveConfig& config) {
  // Device type: profile 402, servo drive (bit 17).
  objects.set_integer({0x1000, 0}, DataType::unsigned32, kRo, 0x0002'0192, "device type");
  objects.set_integer(kErrorRegister, DataType::unsigned8, kRo, 0, "error register", true);
  objects.set_integer({0x1005, 0}, DataType::unsigned32, kRw, kSyncCobId, "COB-ID SYNC");
  ObjectEntry name;
  name.name = "manufacturer device name";
  name.type = DataType::visible_string;
  name.access = ObjectAccess::constant;
  name.value.assign(config.name.begin(), config.name.end());
  objects.set({0x1008, 0}, name);
  objects.set_integer({0x1014, 0}, DataType::unsigned32, kRo, kEmcyBase + config.node_id, "COB-ID EMCY");
  objects.set_integer({0x1017, 0}, DataType::unsigned16, kRw, config.heartbeat_ms, "producer heartbeat time");
  objects.set_integer({0x1018, 0}, DataType::unsigned8, kRo, 1, "identity");
  objects.set_integer({0x1018, 1}, DataType::unsigned32, kRo, 0, "vendor");
}

void add_drive_profile(ObjectDictionary& objects) {
  objects.set_integer(kErrorCode, DataType::unsigned16, kRo, 0, "error code", true);
  objects.set_integer(kControlword, DataType::unsigned16, kRw, 0, "controlword", true);
  objects.set_integer(kStatusword, DataType::unsigned16, kRo, 0, "statusword", true);
  const auto csp = static_cast<std::int64_t>(DriveMode::cyclic_sync_position);
  objects.set_integer(kModesOfOperation, DataType::integer8, kRw, csp, "modes of operation", true);
  objects.set_integer(kModeDisplay, DataType::integer8, kRo, csp, "modes of operation display", true);
  objects.set_integer(kPositionActual, DataType::integer32, kRo, 0, "position actual value", true);
  objects.set_integer(kVelocityActual, DataType::integer32, kRo, 0, "velocity actual value", true);
  objects.set_integer(kTorqueActual, DataType::integer16, kRo, 0, "torque actual value", true);
  objects.set_integer(kTargetPosition, DataType::integer32, kRw, 0, "target position", true);
  objects.set_integer({0x6081, 0}, DataType::unsigned32, kRw, 100'000, "profile velocity", true);
  objects.set_integer({0x60FF, 0}, DataType::integer32, kRw, 0, "target velocity", true);
  objects.set_integer({0x60F4, 0}, DataType::integer32, kRo, 0, "following error actual value", true);
  // Supported drive modes: bit 0 profile position, bit 7 cyclic synchronous position.
  objects.set_integer({0x6502, 0}, DataType::unsigned32, kRo, 0x81, "supported drive modes");
}

void add_pdo(ObjectDictionary& objects, std::uint16_t parameters, std::uint16_t mapping, std::uint32_t default_cob_id,
             const TpdoConfig* config) {
  const std::uint32_t cob_id = config != nullptr && config->cob_id != 0 ? config->cob_id : default_cob_id;
  objects.set_integer({parameters, 0}, DataType::unsigned8, kRo, 5, "highest subindex");
  objects.set_integer({parameters, 1}, DataType::unsigned32, kRw, config != nullptr ? cob_id : cob_id | kCobIdInvalid,
                      "COB-ID");
  objects.set_integer({parameters, 2}, DataType::unsigned8, kRw, config != nullptr ? config->transmission_type : 255,
                      "transmission type");
  objects.set_integer({parameters, 3}, DataType::unsigned16, kRw, config != nullptr ? config->inhibit_time_100us : 0,
                      "inhibit time");
  objects.set_integer({parameters, 5}, DataType::unsigned16, kRw, config != nullptr ? config->event_timer_ms : 0,
                      "event timer");
  const std::size_t entries = config != nullptr ? config->entries.size() : 0;
  objects.set_integer({mapping, 0}, DataType::unsigned8, kRw, static_cast<std::int64_t>(entries), "mapped objects");
  for (std::uint8_t i = 0; i < kMappingSubindices; ++i) {
    const std::uint32_t word = i < entries ? mapping_word(config->entries[i]) : 0;
    objects.set_integer({mapping, static_cast<std::uint8_t>(i + 1)}, DataType::unsigned32, kRw, word, "mapped object");
  }
}

const TpdoConfig* find_pdo(const std::vector<TpdoConfig>& pdos, int number) {
  for (const TpdoConfig& pdo : pdos) {
    if (pdo.number == number) return &pdo;
  }
  return nullptr;
}

TpdoConfig default_pdo(std::vector<PdoEntryConfig> entries) {
  TpdoConfig pdo;
  pdo.number = 1;
  pdo.transmission_type = 1;
  pdo.entries = std::move(entries);
  return pdo;
}

void check(const std::vector<TpdoConfig>& pdos) {
  for (const TpdoConfig& pdo : pdos) {
    CELLMIRROR_EXPECTS(pdo.number >= 1 && pdo.number <= kPdoCount && pdo.entries.size() <= kMappingSubindices);
    CELLMIRROR_EXPECTS(is_valid_mapping(pdo.entries));
  }
}

constexpr bool is_mapping(std::uint16_t index) {
  return (index >= kRpdoMapping && index < kRpdoMapping + kPdoCount) ||
         (index >= kTpdoMapping && index < kTpdoMapping + kPdoCount);
}

}  // namespace

ObjectDictionary make_drive_objects(const Cia402DriveConfig& config) {
  CELLMIRROR_EXPECTS(config.node_id >= 1 && config.node_id <= kMaxNodeId);
  std::vector<TpdoConfig> tpdos = config.tpdos;
  std::vector<TpdoConfig> rpdos = config.rpdos;
  if (tpdos.empty()) tpdos.push_back(default_pdo({{0x6041, 0, 16}, {0x6064, 0, 32}}));
  if (rpdos.empty()) rpdos.push_back(default_pdo({{0x6040, 0, 16}, {0x607A, 0, 32}}));
  check(tpdos);
  check(rpdos);
  ObjectDictionary objects;
  add_identity(objects, config);
  add_drive_profile(objects);
  for (std::uint16_t i = 0; i < kPdoCount; ++i) {
    add_pdo(objects, static_cast<std::uint16_t>(kRpdoParameters + i), static_cast<std::uint16_t>(kRpdoMapping + i),
            rpdo_cob_id(i + 1, config.node_id), find_pdo(rpdos, i + 1));
    add_pdo(objects, static_cast<std::uint16_t>(kTpdoParameters + i), static_cast<std::uint16_t>(kTpdoMapping + i),
            tpdo_cob_id(i + 1, config.node_id), find_pdo(tpdos, i + 1));
  }
  return objects;
}

std::expected<std::vector<std::uint8_t>, SdoAbort> Cia402Drive::read(ObjectAddress address) {
  return read_object(objects_, address);
}

std::optional<SdoAbort> Cia402Drive::write(ObjectAddress address, std::span<const std::uint8_t> value) {
  if (const auto abort = check_write(objects_, address, value)) return abort;
  if (is_mapping(address.index)) {
    if (const auto abort = check_mapping_write(address, get_le(value, value.size()))) return abort;
  }
  if (const auto abort = write_object(objects_, address, value)) return abort;
  after_write(address, now_);
  return {};
}

// CiA 301, 7.5.2.36: a mapping is changed while the PDO is invalid and subindex 0 is 0.
std::optional<SdoAbort> Cia402Drive::check_mapping_write(ObjectAddress address, std::uint64_t value) const {
  const auto parameters = static_cast<std::uint16_t>(address.index - (kTpdoMapping - kTpdoParameters));
  const auto cob_id = static_cast<std::uint32_t>(objects_.integer({parameters, 1}).value_or(0));
  if ((cob_id & kCobIdInvalid) == 0) return SdoAbort::device_state;
  if (address.subindex == 0) {
    if (value > kMappingSubindices) return SdoAbort::value_too_high;
    std::size_t bits = 0;
    const auto count = static_cast<std::uint8_t>(value);
    for (std::uint8_t i = 1; i <= count; ++i) {
      const auto word = static_cast<std::uint32_t>(objects_.integer({address.index, i}).value_or(0));
      if ((word & 0xFF) == 0) return SdoAbort::invalid_value;
      bits += word & 0xFF;
    }
    return bits > kMaxPdoBits ? std::optional(SdoAbort::pdo_too_long) : std::nullopt;
  }
  if (objects_.integer({address.index, 0}).value_or(0) != 0) return SdoAbort::unsupported_access;
  const PdoEntryConfig entry = entry_of_mapping_word(static_cast<std::uint32_t>(value));
  if (value == 0 || entry.index == 0) return {};
  const ObjectEntry* mapped = objects_.find({entry.index, entry.subindex});
  if (mapped == nullptr) return SdoAbort::no_such_object;
  if (!mapped->pdo_mappable || 8 * size_of(mapped->type) != entry.bits) return SdoAbort::not_mappable;
  return {};
}

std::vector<PdoEntryConfig> Cia402Drive::mapping_of(std::uint16_t index) const {
  std::vector<PdoEntryConfig> entries;
  const std::int64_t count = objects_.integer({index, 0}).value_or(0);
  for (std::uint8_t i = 1; i <= count && i <= kMappingSubindices; ++i) {
    entries.push_back(entry_of_mapping_word(static_cast<std::uint32_t>(objects_.integer({index, i}).value_or(0))));
  }
  return entries;
}

void Cia402Drive::load_pdos() {
  tpdos_.resize(kPdoCount);
  rpdos_.resize(kPdoCount);
  const auto number = [this](std::uint16_t index, std::uint8_t subindex) {
    return static_cast<std::uint32_t>(objects_.integer({index, subindex}).value_or(0));
  };
  for (std::uint16_t i = 0; i < kPdoCount; ++i) {
    const auto tpdo_index = static_cast<std::uint16_t>(kTpdoParameters + i);
    Tpdo& tpdo = tpdos_[i];
    tpdo.cob_id = number(tpdo_index, 1) & ~(kCobIdInvalid | kCobIdNoRtr);
    tpdo.transmission_type = static_cast<std::uint8_t>(number(tpdo_index, 2));
    tpdo.inhibit = std::chrono::microseconds(100) * number(tpdo_index, 3);
    tpdo.event_timer = std::chrono::milliseconds(number(tpdo_index, 5));
    tpdo.entries = mapping_of(static_cast<std::uint16_t>(kTpdoMapping + i));
    tpdo.valid = (number(tpdo_index, 1) & kCobIdInvalid) == 0 && is_valid_mapping(tpdo.entries);
    tpdo.last.clear();
    tpdo.event_due = {};
    if (tpdo.event_timer.count() > 0 && now_.known()) tpdo.event_due = now_ + tpdo.event_timer;

    const auto rpdo_index = static_cast<std::uint16_t>(kRpdoParameters + i);
    Rpdo& rpdo = rpdos_[i];
    rpdo.cob_id = number(rpdo_index, 1) & 0x7FF;
    rpdo.on_sync = number(rpdo_index, 2) <= 240;
    rpdo.entries = mapping_of(static_cast<std::uint16_t>(kRpdoMapping + i));
    rpdo.valid = (number(rpdo_index, 1) & kCobIdInvalid) == 0 && is_valid_mapping(rpdo.entries);
    rpdo.waiting.reset();
  }
}

}  // namespace cellmirror::can
