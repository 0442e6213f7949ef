#include "drivers/can/canopen/lss.hpp"

#include <span>
#include <utility>

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
constexpr std::uint8_t kIdentifyVendor = 0x46;  // to 0x4B: product, bounds of revision and serial number
constexpr std::size_t kIdentityBounds = 6;
constexpr std::uint8_t kIdentifyUnnumbered = 0x4C;
constexpr std::uint8_t kIdentified = 0x4F;
constexpr std::uint8_t kUnnumbered = 0x50;
constexpr std::uint8_t kFastscan = 0x51;
constexpr std::uint8_t kScanAnew = 0x80;  // in place of a bit
constexpr unsigned kBitsOfPart = 32;
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

LssSlave::Reaction LssSlave::receive(const CanFrame& frame, const Identity& identity, std::uint8_t node) {
  if (!is_service_frame(frame) || frame.id != kLssMasterCobId || frame.length != 8) return {};
  const std::uint8_t command = frame.data[0];
  const std::uint32_t number = get_le32(std::span(frame.data).subspan(1));
  if (command == kSwitchGlobal) return {{}, switch_all(frame.data[1], node)};
  if (command >= kSelectVendor && command < kSelectVendor + identity.size())
    return {select(command - kSelectVendor, number, identity)};
  matched_ = 0;
  if (command >= kIdentifyVendor && command < kIdentifyVendor + kIdentityBounds)
    return {identify(command - kIdentifyVendor, number, identity)};
  identified_ = 0;
  const bool has_number = node != kNoNodeNumber || pending_ != kNoNodeNumber;
  if (command == kIdentifyUnnumbered) return {has_number ? Answer{} : lss_answer(kUnnumbered, 0)};
  if (command == kFastscan) return {has_number || configuring_ ? Answer{} : scan(frame, identity)};
  return {configuring_ ? configure(frame, identity, node) : Answer{}};
}

// True where that ends the wait for a number.
bool LssSlave::switch_all(std::uint8_t mode, std::uint8_t node) {
  const bool was_configuring = std::exchange(configuring_, mode == 1);
  matched_ = identified_ = scanned_ = 0;
  return was_configuring && !configuring_ && node == kNoNodeNumber && pending_ != kNoNodeNumber;
}

// Only who waits is chosen; its four numbers have to be named in their order.
LssSlave::Answer LssSlave::select(std::size_t part, std::uint32_t number, const Identity& identity) {
  if (configuring_) return {};
  const bool in_order = part == 0 || part == matched_;
  matched_ = in_order && identity.at(part) == number ? part + 1 : 0;
  if (matched_ < identity.size()) return {};
  matched_ = 0;
  configuring_ = true;
  return lss_answer(kSelected, 0);
}

// Identify remote slave: vendor, product code, and the lowest and highest revision and serial number. Who meets all of
// them answers, whether it was chosen or not.
LssSlave::Answer LssSlave::identify(std::size_t part, std::uint32_t number, const Identity& identity) {
  const bool in_order = part == 0 || part == identified_;
  const std::array met{number == identity[0], number == identity[1], number <= identity[2],
                       number >= identity[2], number <= identity[3], number >= identity[3]};
  identified_ = in_order && met.at(part) ? part + 1 : 0;
  if (identified_ < met.size()) return {};
  identified_ = 0;
  return lss_answer(kIdentified, 0);
}

// Fastscan: the master asks for the upper bits of one part of the identity after the other; who has them answers. With
// the last bit the part is known, and the scan goes on with the one that the master names, or back: chosen.
LssSlave::Answer LssSlave::scan(const CanFrame& frame, const Identity& identity) {
  const std::uint8_t bit = frame.data[5];
  const std::size_t part = frame.data[6];
  const std::size_t next = frame.data[7];
  if (bit == kScanAnew) {
    scanned_ = 0;
    return lss_answer(kIdentified, 0);
  }
  if (bit >= kBitsOfPart || part >= identity.size() || next >= identity.size() || part != scanned_) return {};
  const std::uint32_t difference = get_le32(std::span(frame.data).subspan(1)) ^ identity.at(part);
  if (difference >> bit != 0) return {};
  scanned_ = next;
  configuring_ = bit == 0 && next < part;
  return lss_answer(kIdentified, 0);
}

LssSlave::Answer LssSlave::configure(const CanFrame& frame, const Identity& identity, std::uint8_t node) {
  const std::uint8_t command = frame.data[0];
  if (command >= kInquireVendor && command < kInquireVendor + identity.size())
    return lss_answer(command, identity.at(command - kInquireVendor));
  switch (command) {
    case kInquireNode:
      return lss_answer(command, node);
    case kConfigureNode: {
      const std::uint8_t wanted = frame.data[1];
      const bool known = (wanted >= 1 && wanted <= kMaxNodeId) || wanted == kNoNodeNumber;
      if (!known) return lss_answer(command, kOutOfRange);
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
