// A DBC file: every signal that was taken decodes frames of its message's length.
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/can/dbc/dbc.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  Diagnostics diagnostics;
  const can::Dbc dbc = can::parse_dbc({reinterpret_cast<const char*>(data), size}, "fuzz.dbc", diagnostics);
  std::array<std::uint8_t, kCanMaxData> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(37 * i + size);
  for (const can::DbcMessage& message : dbc.messages) {
    const auto payload = std::span(bytes).first(message.length);
    for (const can::DbcSignal& signal : message.signals) {
      if (!can::is_present(message, signal, payload)) continue;
      can::put_physical_value(signal, can::physical_value(signal, payload), payload);
    }
  }
  return 0;
}
