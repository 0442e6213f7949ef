#include "drivers/rtde/rtde_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "rt_core/base/text.hpp"

namespace cellmirror::rtde {

namespace {

constexpr std::size_t kHead = 3;
constexpr std::size_t kDataLength = 1 + 8 + 2 * kJoints * 8 + 2 * 4;
constexpr std::size_t kAllDataLength = kDataLength + 2 * kJoints * 8 + 8 + 4;
constexpr std::size_t kLongestText = 200;

class Writer {
 public:
  explicit Writer(PackageType type) : bytes_{0, 0, static_cast<std::uint8_t>(type)} {}

  Writer& u8(std::uint8_t value) {
    bytes_.push_back(value);
    return *this;
  }
  template <class Unsigned>
  Writer& whole(Unsigned value) {
    for (int shift = static_cast<int>(8 * sizeof(value)) - 8; shift >= 0; shift -= 8)
      bytes_.push_back(static_cast<std::uint8_t>(value >> static_cast<unsigned>(shift)));
    return *this;
  }
  Writer& number(double value) { return whole(std::bit_cast<std::uint64_t>(value)); }
  Writer& text(std::string_view value) {
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    return *this;
  }
  // The length of the package is at its start.
  Bytes finish() {
    bytes_[0] = static_cast<std::uint8_t>(bytes_.size() >> 8U);
    bytes_[1] = static_cast<std::uint8_t>(bytes_.size());
    return std::move(bytes_);
  }

 private:
  Bytes bytes_;
};

// The caller has checked the length.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class Unsigned>
  Unsigned whole() {
    Unsigned value = 0;
    for (std::size_t i = 0; i < sizeof(value); ++i) value = static_cast<Unsigned>((value << 8U) | bytes_[at_++]);
    return value;
  }
  double number() { return std::bit_cast<double>(whole<std::uint64_t>()); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

std::string characters(std::span<const std::uint8_t> bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

void PackageSplitter::add(std::span<const std::uint8_t> bytes) {
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(used_));
  used_ = 0;
  if (bytes_.size() + bytes.size() > kMostWaiting) {
    broken_ = true;
    return;
  }
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

std::optional<Package> PackageSplitter::next() {
  const std::size_t left = bytes_.size() - used_;
  if (broken_ || left < kHead) return std::nullopt;
  const std::size_t length = static_cast<std::size_t>(bytes_[used_]) << 8U | bytes_[used_ + 1];
  if (length < kHead || length > kLongestPackage) {
    broken_ = true;
    return std::nullopt;
  }
  if (left < length) return std::nullopt;
  const Package package{bytes_[used_ + 2], std::span(bytes_).subspan(used_ + kHead, length - kHead)};
  used_ += length;
  return package;
}

void PackageSplitter::clear() { *this = PackageSplitter(); }

std::string robot_mode_text(std::int32_t mode) {
  static constexpr std::array<std::string_view, 10> kTexts = {
      "no controller", "disconnected", "confirm safety", "booting", "power off",
      "power on",      "idle",         "backdrive",      "running", "updating firmware"};
  if (mode < -1 || mode > 8) return fmt::format("robot mode {}", mode);
  const std::int32_t index = mode + 1;
  return std::string(kTexts[static_cast<std::size_t>(index)]);
}

std::string safety_mode_text(std::int32_t mode) {
  static constexpr std::array<std::string_view, 13> kTexts = {"normal",
                                                              "reduced",
                                                              "protective stop",
                                                              "recovery",
                                                              "safeguard stop",
                                                              "system emergency stop",
                                                              "robot emergency stop",
                                                              "violation",
                                                              "fault",
                                                              "validating a joint",
                                                              "undefined",
                                                              "safeguard stop in automatic mode",
                                                              "stop by the three-position enabling device"};
  if (mode < 1 || mode > static_cast<std::int32_t>(kTexts.size())) return fmt::format("safety mode {}", mode);
  return std::string(kTexts[static_cast<std::size_t>(mode - 1)]);
}

std::string runtime_state_text(std::uint32_t state) {
  static constexpr std::array<std::string_view, 6> kTexts = {"stopping", "stopped", "playing",
                                                             "pausing",  "paused",  "resuming"};
  return state < kTexts.size() ? std::string(kTexts[state]) : fmt::format("runtime state {}", state);
}

Bytes version_request(std::uint16_t version) { return Writer(PackageType::version).whole(version).finish(); }

Bytes outputs_request(double rate_hz, std::string_view variables) {
  return Writer(PackageType::outputs).number(rate_hz).text(variables).finish();
}

Bytes start_request() { return Writer(PackageType::start).finish(); }

std::optional<bool> decode_accepted(std::span<const std::uint8_t> payload) {
  if (payload.size() != 1) return std::nullopt;
  return payload[0] == 1;
}

std::optional<OutputsAnswer> decode_outputs(std::span<const std::uint8_t> payload) {
  if (payload.empty()) return std::nullopt;
  return OutputsAnswer{payload[0], characters(payload.subspan(1))};
}

std::optional<RobotData> decode_data(std::span<const std::uint8_t> payload, std::uint8_t recipe) {
  const bool known = payload.size() == kDataLength || payload.size() == kAllDataLength;
  if (!known || payload[0] != recipe) return std::nullopt;
  Reader in(payload.subspan(1));
  RobotData data;
  data.timestamp_s = in.number();
  for (double& value : data.q) value = in.number();
  for (double& value : data.qd) value = in.number();
  data.robot_mode = static_cast<std::int32_t>(in.whole<std::uint32_t>());
  data.safety_mode = static_cast<std::int32_t>(in.whole<std::uint32_t>());
  data.has_all = payload.size() == kAllDataLength;
  if (!data.has_all) return data;
  for (double& value : data.current) value = in.number();
  for (double& value : data.moment) value = in.number();
  data.speed_scaling = in.number();
  data.runtime_state = in.whole<std::uint32_t>();
  return data;
}

// Length of the message, message, length of the source, source, level.
std::string decode_text(std::span<const std::uint8_t> payload) {
  if (payload.empty()) return {};
  const std::size_t length = std::min<std::size_t>({payload[0], payload.size() - 1, kLongestText});
  return printable(characters(payload.subspan(1, length)));
}

std::optional<std::uint16_t> decode_version_request(std::span<const std::uint8_t> payload) {
  if (payload.size() != 2) return std::nullopt;
  return Reader(payload).whole<std::uint16_t>();
}

std::optional<OutputsRequest> decode_outputs_request(std::span<const std::uint8_t> payload) {
  if (payload.size() < 8) return std::nullopt;
  return OutputsRequest{Reader(payload).number(), characters(payload.subspan(8))};
}

Bytes accepted(PackageType type, bool yes) { return Writer(type).u8(yes ? 1 : 0).finish(); }

Bytes outputs_answer(const OutputsAnswer& answer) {
  return Writer(PackageType::outputs).u8(answer.recipe).text(answer.types).finish();
}

Bytes data_package(const RobotData& data, std::uint8_t recipe) {
  Writer out(PackageType::data);
  out.u8(recipe).number(data.timestamp_s);
  for (const double value : data.q) out.number(value);
  for (const double value : data.qd) out.number(value);
  out.whole(static_cast<std::uint32_t>(data.robot_mode)).whole(static_cast<std::uint32_t>(data.safety_mode));
  if (!data.has_all) return out.finish();
  for (const double value : data.current) out.number(value);
  for (const double value : data.moment) out.number(value);
  return out.number(data.speed_scaling).whole(data.runtime_state).finish();
}

}  // namespace cellmirror::rtde
