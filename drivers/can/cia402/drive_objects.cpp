#include "drivers/can/cia402/drive_objects.hpp"

#include <utility>
#include <vector>

#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/slave.hpp"
#include "drivers/can/canopen/slave_pdos.hpp"
#include "drivers/can/cia402/drive.hpp"
#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

constexpr auto kRw = ObjectAccess::read_write;
constexpr auto kRo = ObjectAccess::read_only;

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

TpdoConfig default_pdo(std::vector<PdoEntryConfig> entries) {
  TpdoConfig pdo;
  pdo.number = 1;
  pdo.transmission_type = 1;
  pdo.entries = std::move(entries);
  return pdo;
}

}  // namespace

ObjectDictionary make_drive_objects(const Cia402DriveConfig& config) {
  CELLMIRROR_EXPECTS(config.node_id >= 1 && config.node_id <= kMaxNodeId);
  std::vector<TpdoConfig> tpdos = config.tpdos;
  std::vector<TpdoConfig> rpdos = config.rpdos;
  if (tpdos.empty()) tpdos.push_back(default_pdo({{0x6041, 0, 16}, {0x6064, 0, 32}}));
  if (rpdos.empty()) rpdos.push_back(default_pdo({{0x6040, 0, 16}, {0x607A, 0, 32}}));
  ObjectDictionary objects;
  // Device type: profile 402, servo drive (bit 17).
  add_communication_objects(objects, config.node_id, {0x0002'0192, config.name, config.heartbeat_ms});
  add_drive_profile(objects);
  add_pdo_objects(objects, config.node_id, rpdos, tpdos);
  return objects;
}

}  // namespace cellmirror::can
