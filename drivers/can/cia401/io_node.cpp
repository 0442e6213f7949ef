#include "drivers/can/cia401/io_node.hpp"

#include <cstdlib>

#include "drivers/can/cia401/io_objects.hpp"

namespace cellmirror::can {
namespace {

constexpr unsigned kBitsOfByte = 8;
constexpr std::uint8_t kOutputBytes = kIoBits / kBitsOfByte;

}  // namespace

IoNode::IoNode(std::uint8_t node_id, std::uint16_t heartbeat_ms, FrameOutput& output)
    : slave_(node_id, make_io_objects(node_id, heartbeat_ms), {kDigitalInputs, 1}, *this, output) {}

void IoNode::power_on(Timestamp now) { slave_.power_on(NmtState::pre_operational, now); }

void IoNode::receive(const CanFrame& frame, Timestamp now) { slave_.receive(frame, now); }

void IoNode::set_inputs(const IoInputs& real, Timestamp now) {
  const IoInputs inputs = slave_.faults().seen(real);
  if (inputs.digital == inputs_.digital && inputs.analogue == inputs_.analogue) return;
  inputs_ = inputs;
  write_inputs();
  slave_.changed(now);
}

void IoNode::write_inputs() {
  for (std::uint8_t i = 0; i < kOutputBytes; ++i)
    slave_.objects().write_integer({kDigitalInputs, static_cast<std::uint8_t>(i + 1)},
                                   inputs_.digital >> (kBitsOfByte * i) & 0xFFU);
  for (std::uint8_t i = 0; i < kIoAnalogues; ++i)
    slave_.objects().write_integer({kAnalogueInputs, static_cast<std::uint8_t>(i + 1)}, inputs_.analogue.at(i));
}

std::optional<SdoAbort> IoNode::check(ObjectAddress address, std::int64_t value) {
  const bool is_boolean = address.index == kDigitalInterruptEnable || address.index == kAnalogueInterruptEnable;
  if (is_boolean && value != 0 && value != 1) return SdoAbort::invalid_value;
  return {};
}

void IoNode::written(std::span<const ObjectAddress> addresses, Timestamp /*now*/) {
  for (const ObjectAddress& address : addresses) {
    if (address.index == kDigitalOutputs) outputs_.digital = bits(kDigitalOutputs);
  }
}

void IoNode::on_reset(Timestamp /*now*/) {
  outputs_ = {};
  write_inputs();
}

void IoNode::synced(Timestamp /*now*/) {}

// CiA 401, error behaviour of outputs: the bits with error mode 1 take their error value.
bool IoNode::communication_lost(Timestamp /*now*/) {
  const std::uint32_t mode = bits(kOutputErrorMode);
  outputs_.digital = (outputs_.digital & ~mode) | (bits(kOutputErrorValue) & mode);
  for (std::uint8_t i = 0; i < kOutputBytes; ++i)
    slave_.objects().write_integer({kDigitalOutputs, static_cast<std::uint8_t>(i + 1)},
                                   outputs_.digital >> (kBitsOfByte * i) & 0xFFU);
  return false;
}

bool IoNode::is_stored(ObjectAddress address) const { return address.index != kDigitalOutputs; }

bool IoNode::is_event(ObjectAddress address, std::uint64_t sent, std::uint64_t now) const {
  if (address.index == kDigitalInputs) {
    const auto mask = static_cast<std::uint64_t>(object(kDigitalInterruptMask, address.subindex));
    return object(kDigitalInterruptEnable, 0) != 0 && ((sent ^ now) & mask) != 0;
  }
  if (address.index == kAnalogueInputs) {
    const int difference = static_cast<std::int16_t>(now) - static_cast<std::int16_t>(sent);
    return object(kAnalogueInterruptEnable, 0) != 0 && std::abs(difference) > object(kAnalogueDelta, address.subindex);
  }
  return sent != now;
}

std::uint32_t IoNode::bits(std::uint16_t index) const {
  std::uint32_t out = 0;
  for (std::uint8_t i = 0; i < kOutputBytes; ++i) {
    const auto byte = static_cast<std::uint32_t>(object(index, static_cast<std::uint8_t>(i + 1)) & 0xFF);
    out |= byte << (kBitsOfByte * i);
  }
  return out;
}

std::int64_t IoNode::object(std::uint16_t index, std::uint8_t subindex) const {
  return slave_.objects().integer({index, subindex}).value_or(0);
}

}  // namespace cellmirror::can
