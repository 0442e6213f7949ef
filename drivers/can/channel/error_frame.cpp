#include "drivers/can/channel/error_frame.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>

#include <utility>

namespace cellmirror::can {
namespace {

// Older headers lack it.
constexpr std::uint8_t kControllerActive = 0x40;
constexpr std::uint32_t kErrorCounters =
    0x200;  // CAN_ERR_CNT: byte 6 is the transmit error counter, byte 7 the receive error counter
constexpr std::size_t kCountersEnd = 8;

using Words = std::pair<std::uint32_t, const char*>;

constexpr Words kClasses[] = {
    {CAN_ERR_TX_TIMEOUT, "transmission timed out"},
    {CAN_ERR_LOSTARB, "arbitration lost"},
    {CAN_ERR_PROT, "protocol violation"},
    {CAN_ERR_TRX, "transceiver"},
    {CAN_ERR_ACK, "no acknowledgement: nobody else is on the bus"},
    {CAN_ERR_BUSOFF, "bus-off"},
    {CAN_ERR_BUSERROR, "bus error"},
    {CAN_ERR_RESTARTED, "controller restarted"},
};

constexpr Words kController[] = {
    {CAN_ERR_CRTL_RX_OVERFLOW, "receive overflow"}, {CAN_ERR_CRTL_TX_OVERFLOW, "transmit overflow"},
    {CAN_ERR_CRTL_RX_WARNING, "receive warning"},   {CAN_ERR_CRTL_TX_WARNING, "transmit warning"},
    {CAN_ERR_CRTL_RX_PASSIVE, "receive passive"},   {CAN_ERR_CRTL_TX_PASSIVE, "transmit passive"},
    {kControllerActive, "error active again"},
};

void append(std::string& text, const char* words) {
  if (!text.empty()) text += ", ";
  text += words;
}

}  // namespace

std::optional<CanBusState> bus_state_of_error(const CanFrame& frame) {
  if (!frame.error) return {};
  if ((frame.id & CAN_ERR_BUSOFF) != 0) return CanBusState::bus_off;
  if ((frame.id & CAN_ERR_RESTARTED) != 0) return CanBusState::active;
  if ((frame.id & CAN_ERR_CRTL) == 0 || frame.length < 2) return {};
  const unsigned status = frame.data[1];
  if ((status & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) return CanBusState::passive;
  if ((status & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) return CanBusState::warning;
  if ((status & kControllerActive) != 0) return CanBusState::active;
  return {};
}

std::string error_words(const CanFrame& frame) {
  std::string text;
  for (const auto& [mask, words] : kClasses) {
    if ((frame.id & mask) != 0) append(text, words);
  }
  if ((frame.id & CAN_ERR_CRTL) != 0) {
    append(text, "controller");
    const unsigned status = frame.length >= 2 ? frame.data[1] : 0;
    for (const auto& [mask, words] : kController) {
      if ((status & mask) != 0) append(text, words);
    }
  }
  if ((frame.id & kErrorCounters) != 0 && frame.length >= kCountersEnd)
    append(text, fmt::format("error counters {} (transmit) and {} (receive)", frame.data[6], frame.data[7]).c_str());
  return text.empty() ? fmt::format("error of the unknown class 0x{:X}", frame.id) : text;
}

const char* words(CanBusState state) {
  switch (state) {
    case CanBusState::unknown:
      return "unknown";
    case CanBusState::active:
      return "active";
    case CanBusState::warning:
      return "warning";
    case CanBusState::passive:
      return "error passive";
    case CanBusState::bus_off:
      return "bus-off";
    case CanBusState::down:
      return "down";
  }
  return "unknown";
}

}  // namespace cellmirror::can
