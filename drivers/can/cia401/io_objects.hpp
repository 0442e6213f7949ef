// The object dictionary of an IoNode (CiA 401).
#pragma once

#include <cstdint>

#include "drivers/can/canopen/object_dictionary.hpp"

namespace cellmirror::can {

inline constexpr std::uint16_t kDigitalInputs = 0x6000;           // 8 inputs a subindex
inline constexpr std::uint16_t kDigitalInterruptEnable = 0x6005;  // boolean
inline constexpr std::uint16_t kDigitalInterruptMask = 0x6006;    // whose change is an event
inline constexpr std::uint16_t kDigitalOutputs = 0x6200;          // 8 outputs a subindex
inline constexpr std::uint16_t kOutputErrorMode = 0x6206;         // 1: takes its error value, 0: stays
inline constexpr std::uint16_t kOutputErrorValue = 0x6207;
inline constexpr std::uint16_t kAnalogueInputs = 0x6401;           // 16 bits, an input a subindex
inline constexpr std::uint16_t kAnalogueInterruptEnable = 0x6423;  // boolean
inline constexpr std::uint16_t kAnalogueDelta = 0x6426;            // by how much more it changes than this: an event

// 32 digital inputs and outputs, 8 analogue inputs. RPDO1 the outputs; TPDO1 the digital, TPDO2 and TPDO3 the analogue
// inputs.
[[nodiscard]] ObjectDictionary make_io_objects(std::uint8_t node_id, std::uint16_t heartbeat_ms);

}  // namespace cellmirror::can
