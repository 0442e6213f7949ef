#include "drivers/can/cia401/io_objects.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "drivers/can/canopen/slave.hpp"
#include "rt_core/ports/io_image.hpp"

namespace cellmirror::can {
namespace {

constexpr std::uint8_t kIoBytes = kIoBits / 8;

struct IoArray {
  std::uint16_t index;
  std::uint8_t count;
  DataType type;
  ObjectAccess access;
  bool mappable;
  std::int64_t value;
  const char* name;
};

void add(ObjectDictionary& objects, const IoArray& array) {
  objects.set_integer({array.index, 0}, DataType::unsigned8, ObjectAccess::read_only, array.count, array.name);
  for (std::uint8_t i = 1; i <= array.count; ++i)
    objects.set_integer({array.index, i}, array.type, array.access, array.value, fmt::format("{} {}", array.name, i),
                        array.mappable);
}

TpdoConfig io_pdo(std::uint8_t number, std::uint16_t index, std::uint8_t first, std::uint8_t bits) {
  constexpr std::uint8_t kEntries = 4;
  TpdoConfig config;
  config.number = number;
  config.transmission_type = 255;
  for (std::uint8_t i = 0; i < kEntries; ++i)
    config.entries.push_back({index, static_cast<std::uint8_t>(first + i), bits});
  return config;
}

}  // namespace

ObjectDictionary make_io_objects(std::uint8_t node_id, std::uint16_t heartbeat_ms) {
  using enum DataType;
  constexpr auto kRw = ObjectAccess::read_write;
  constexpr auto kRo = ObjectAccess::read_only;
  ObjectDictionary objects;
  // Device type: profile 401; digital inputs (bit 16), digital outputs (17), analogue inputs (18).
  add_communication_objects(objects, node_id, {0x0007'0191, "cellmirror I/O node", heartbeat_ms});
  objects.set_integer({kDigitalInterruptEnable, 0}, boolean, kRw, 1, "global interrupt enable digital");
  objects.set_integer({kAnalogueInterruptEnable, 0}, boolean, kRw, 0, "analogue input global interrupt enable");
  const std::array arrays{
      IoArray{kDigitalInputs, kIoBytes, unsigned8, kRo, true, 0, "digital inputs"},
      IoArray{kDigitalInterruptMask, kIoBytes, unsigned8, kRw, false, 0xFF, "interrupt mask any change"},
      IoArray{kDigitalOutputs, kIoBytes, unsigned8, kRw, true, 0, "digital outputs"},
      IoArray{kOutputErrorMode, kIoBytes, unsigned8, kRw, false, 0xFF, "error mode digital outputs"},
      IoArray{kOutputErrorValue, kIoBytes, unsigned8, kRw, false, 0, "error value digital outputs"},
      IoArray{kAnalogueInputs, kIoAnalogues, integer16, kRo, true, 0, "analogue input"},
      IoArray{kAnalogueDelta, kIoAnalogues, unsigned32, kRw, false, 0, "analogue input interrupt delta"},
  };
  for (const IoArray& array : arrays) add(objects, array);
  const std::array rpdos{io_pdo(1, kDigitalOutputs, 1, 8)};
  const std::array tpdos{io_pdo(1, kDigitalInputs, 1, 8), io_pdo(2, kAnalogueInputs, 1, 16),
                         io_pdo(3, kAnalogueInputs, 5, 16)};
  add_pdo_objects(objects, node_id, rpdos, tpdos);
  return objects;
}

}  // namespace cellmirror::can
