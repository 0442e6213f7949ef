#include "drivers/can/canopen/lss.hpp"

#include <span>

#include "drivers/can/canopen/bytes.hpp"
#include "drivers/can/canopen/cob_id.hpp"

namespace cellmirror::can {
namespace {

// Command specifiers (CiA 305, 6.2).
constexpr std::uint8_t kSwitchGlobal = 0x04;
constexpr std::uint8_t kConfigureNode = 0x11;
constexpr std::uint8_t kConfigureBitTiming = 0x13;
constexpr std::uint8_t kStore = 0x17;
constexpr std::uint8_t kSelectVendor = 0x40;  // to 0x43: product, revision, serial number
constexpr std::uint8_t kSelected = 0x44;
constexpr std::uint8_t kInquireVendor = 0x5A;  // to 0x5D, likewise
constexpr std::uint8_t kInquireNode = 0x5E;

constexpr std::uint8_t kDone = 0;
constexpr std::uint8_t kOutOfRange = 1;    // of node numbers, bit timings
constexpr std::uint8_t kNotSupported = 1;  // storing

CanFrame lss_answer(std::uint8_t command, std::uint32_t value) {
  CanFrame frame;
  frame.id = kLssSlaveCobId;
  frame.length = 8;
  frame.data[0] = command;
  put_le(std::span(frame.data).subspan(1), value, 4);
  return frame;
}

}  // namespace

std::optional<CanFrame> LssSlave::receive(const CanFrame& frame, const Identity& identity, std::uint8_t node) {
  if (!is_service_frame(frame) || frame.id != kLssMasterCobId || frame.length != 8) return {};
  const std::uint8_t command = frame.data[0];
  if (command == kSwitchGlobal) {
    configuring_ = frame.data[1] == 1;
    matched_ = 0;
    return {};
  }
  if (command >= kSelectVendor && command < kSelectVendor + identity.size())
    return select(command - kSelectVendor, get_le32(std::span(frame.data).subspan(1)), identity);
  matched_ = 0;
  return configuring_ ? configure(frame, identity, node) : std::nullopt;
}

// Only who waits is chosen; its four numbers have to be named in their order.
std::optional<CanFrame> LssSlave::select(std::size_t part, std::uint32_t number, const Identity& identity) {
  if (configuring_) return {};
  const bool in_order = part == 0 || part == matched_;
  matched_ = in_order && identity.at(part) == number ? part + 1 : 0;
  if (matched_ < identity.size()) return {};
  matched_ = 0;
  configuring_ = true;
  return lss_answer(kSelected, 0);
}

std::optional<CanFrame> LssSlave::configure(const CanFrame& frame, const Identity& identity, std::uint8_t node) {
  const std::uint8_t command = frame.data[0];
  if (command >= kInquireVendor && command < kInquireVendor + identity.size())
    return lss_answer(command, identity.at(command - kInquireVendor));
  switch (command) {
    case kInquireNode:
      return lss_answer(command, node);
    case kConfigureNode: {
      const std::uint8_t wanted = frame.data[1];
      if (wanted < 1 || wanted > kMaxNodeId) return lss_answer(command, kOutOfRange);
      pending_ = wanted;
      return lss_answer(command, kDone);
    }
    case kConfigureBitTiming:
      return lss_answer(command, kOutOfRange);
    case kStore:
      return lss_answer(command, kNotSupported);
    default:
      return {};
  }
}

}  // namespace cellmirror::can
