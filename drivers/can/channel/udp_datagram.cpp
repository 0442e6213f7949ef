#include "drivers/can/channel/udp_datagram.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include "rt_core/base/contract.hpp"

namespace cellmirror::can {
namespace {

// MessagePack's first bytes.
constexpr std::uint8_t kFixMap = 0x80;
constexpr std::uint8_t kFixStr = 0xA0;
constexpr std::uint8_t kNil = 0xC0;
constexpr std::uint8_t kFalse = 0xC2;
constexpr std::uint8_t kTrue = 0xC3;
constexpr std::uint8_t kBin8 = 0xC4;
constexpr std::uint8_t kBin32 = 0xC6;
constexpr std::uint8_t kFloat32 = 0xCA;
constexpr std::uint8_t kFloat64 = 0xCB;
constexpr std::uint8_t kUint8 = 0xCC;
constexpr std::uint8_t kUint16 = 0xCD;
constexpr std::uint8_t kUint32 = 0xCE;
constexpr std::uint8_t kUint64 = 0xCF;
constexpr std::uint8_t kInt8 = 0xD0;
constexpr std::uint8_t kInt64 = 0xD3;
constexpr std::uint8_t kStr8 = 0xD9;
constexpr std::uint8_t kStr32 = 0xDB;
constexpr std::uint8_t kMap16 = 0xDE;
constexpr std::uint8_t kMap32 = 0xDF;

constexpr std::size_t kMaxKeys = 32;  // of a map; eleven are known

class Writer {
 public:
  explicit Writer(UdpDatagram& out) : out_(&out) {}

  void byte(std::uint8_t value) { out_->bytes[out_->size++] = value; }
  void big_endian(std::uint64_t value, std::size_t bytes) {
    for (std::size_t i = bytes; i-- > 0;) byte(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void key(std::string_view text) {
    CELLMIRROR_EXPECTS(text.size() < 32);
    byte(static_cast<std::uint8_t>(kFixStr | text.size()));
    for (const char c : text) byte(static_cast<std::uint8_t>(c));
  }
  void boolean(std::string_view name, bool value) {
    key(name);
    byte(value ? kTrue : kFalse);
  }
  void unsigned_number(std::string_view name, std::uint32_t value) {
    key(name);
    if (value < 0x80) {
      byte(static_cast<std::uint8_t>(value));
    } else if (value <= 0xFF) {
      byte(kUint8);
      big_endian(value, 1);
    } else if (value <= 0xFFFF) {
      byte(kUint16);
      big_endian(value, 2);
    } else {
      byte(kUint32);
      big_endian(value, 4);
    }
  }

 private:
  UdpDatagram* out_;
};

// One scalar of the map.
struct Value {
  enum class Kind : std::uint8_t { nil, boolean, number, real, text, binary };
  Kind kind = Kind::nil;
  std::uint64_t number = 0;  // boolean too; negative numbers are `negative`
  bool negative = false;
  std::span<const std::uint8_t> bytes{};  // text, binary
};

class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> data) : left_(data) {}

  [[nodiscard]] bool at_end() const { return left_.empty(); }

  [[nodiscard]] std::optional<std::uint64_t> big_endian(std::size_t bytes) {
    if (left_.size() < bytes) return {};
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | left_[i];
    left_ = left_.subspan(bytes);
    return value;
  }

  [[nodiscard]] std::optional<std::size_t> map_size() {
    const auto first = big_endian(1);
    if (!first) return {};
    if ((*first & 0xF0) == kFixMap) return *first & 0x0F;
    if (*first == kMap16) return big_endian(2);
    if (*first == kMap32) return big_endian(4);
    return {};
  }

  // None for containers, extension types and cut data.
  [[nodiscard]] std::optional<Value> scalar() {
    const auto first = big_endian(1);
    if (!first) return {};
    const auto type = static_cast<std::uint8_t>(*first);
    if (type < 0x80) return Value{.kind = Value::Kind::number, .number = type};
    if (type >= 0xE0) return Value{.kind = Value::Kind::number, .negative = true};
    if ((type & 0xE0) == kFixStr) return bytes_of(Value::Kind::text, type & 0x1F);
    if (type == kNil) return Value{};
    if (type == kFalse || type == kTrue) return Value{.kind = Value::Kind::boolean, .number = type == kTrue ? 1U : 0U};
    if (type >= kBin8 && type <= kBin32) return sized(Value::Kind::binary, std::size_t{1} << (type - kBin8));
    if (type >= kStr8 && type <= kStr32) return sized(Value::Kind::text, std::size_t{1} << (type - kStr8));
    return numeric(type);
  }

 private:
  [[nodiscard]] std::optional<Value> numeric(std::uint8_t type) {
    if (type == kFloat32 || type == kFloat64) {
      if (!big_endian(type == kFloat32 ? 4 : 8)) return {};
      return Value{.kind = Value::Kind::real};
    }
    if (type >= kUint8 && type <= kUint64) {
      const auto value = big_endian(std::size_t{1} << (type - kUint8));
      if (!value) return {};
      return Value{.kind = Value::Kind::number, .number = *value};
    }
    if (type >= kInt8 && type <= kInt64) {
      const std::size_t bytes = std::size_t{1} << (type - kInt8);
      const auto value = big_endian(bytes);
      if (!value) return {};
      const bool negative = (*value >> (8 * bytes - 1)) != 0;
      return Value{.kind = Value::Kind::number, .number = *value, .negative = negative};
    }
    return {};
  }
  [[nodiscard]] std::optional<Value> sized(Value::Kind kind, std::size_t size_bytes) {
    const auto size = big_endian(size_bytes);
    return size ? bytes_of(kind, *size) : std::nullopt;
  }
  [[nodiscard]] std::optional<Value> bytes_of(Value::Kind kind, std::uint64_t size) {
    if (left_.size() < size) return {};
    Value value{.kind = kind};
    value.bytes = left_.first(size);
    left_ = left_.subspan(size);
    return value;
  }

  std::span<const std::uint8_t> left_;
};

struct Fields {
  std::uint64_t id = 0;
  std::optional<std::uint64_t> dlc;
  std::span<const std::uint8_t> data;
  bool extended = true;
  bool remote = false;
  bool error = false;
  bool fd = false;
  bool bit_rate_switch = false;
  bool error_state_indicator = false;
};

bool take_flag(const Value& value, bool& flag) {
  if (value.kind != Value::Kind::boolean && value.kind != Value::Kind::nil) return false;
  flag = value.number != 0;
  return true;
}

bool take_number(const Value& value, std::uint64_t& number) {
  if (value.kind != Value::Kind::number || value.negative) return false;
  number = value.number;
  return true;
}

// Empty where the value was taken, else the reason.
std::string_view take(std::string_view key, const Value& value, Fields& fields) {
  constexpr std::string_view kNoFlag = "a flag is neither true nor false";
  constexpr std::string_view kNoNumber = "the identifier or the length is no number";
  bool ignored = false;
  if (key == "timestamp" || key == "channel") return {};
  if (key == "arbitration_id") return take_number(value, fields.id) ? "" : kNoNumber;
  if (key == "is_extended_id") return take_flag(value, fields.extended) ? "" : kNoFlag;
  if (key == "is_remote_frame") return take_flag(value, fields.remote) ? "" : kNoFlag;
  if (key == "is_error_frame") return take_flag(value, fields.error) ? "" : kNoFlag;
  if (key == "is_fd") return take_flag(value, fields.fd) ? "" : kNoFlag;
  if (key == "is_rx") return take_flag(value, ignored) ? "" : kNoFlag;
  if (key == "bitrate_switch") return take_flag(value, fields.bit_rate_switch) ? "" : kNoFlag;
  if (key == "error_state_indicator") return take_flag(value, fields.error_state_indicator) ? "" : kNoFlag;
  if (key == "dlc") {
    if (value.kind == Value::Kind::nil) return {};
    std::uint64_t dlc = 0;
    if (!take_number(value, dlc)) return kNoNumber;
    fields.dlc = dlc;
    return {};
  }
  if (key == "data") {
    if (value.kind != Value::Kind::binary && value.kind != Value::Kind::nil) return "the data are no bytes";
    fields.data = value.bytes;
    return {};
  }
  return "unknown key";
}

// python-can's Message(check=True).
std::expected<CanFrame, std::string_view> checked(Fields fields) {
  if (fields.remote) fields.data = {};
  if (fields.remote && (fields.error || fields.fd)) return std::unexpected("a remote frame that is FD or an error");
  if (fields.id >= (fields.extended ? 0x2000'0000U : 0x800U)) return std::unexpected("the identifier is too large");
  const std::uint64_t length = fields.dlc.value_or(fields.data.size());
  if (length > (fields.fd ? kCanMaxData : 8U)) return std::unexpected("the length is beyond that of the kind of frame");
  if (!fields.remote && length != fields.data.size()) return std::unexpected("length and data do not match");
  if (!fields.fd && (fields.bit_rate_switch || fields.error_state_indicator)) {
    return std::unexpected("an FD flag on a classic frame");
  }
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(fields.id);
  frame.extended = fields.extended;
  frame.remote = fields.remote;
  frame.error = fields.error;
  frame.fd = fields.fd;
  frame.bit_rate_switch = fields.bit_rate_switch;
  frame.error_state_indicator = fields.error_state_indicator;
  frame.length = static_cast<std::uint8_t>(length);
  std::copy(fields.data.begin(), fields.data.end(), frame.data.begin());
  return frame;
}

}  // namespace

UdpDatagram encode_udp_datagram(const CanFrame& frame, double timestamp_s) {
  UdpDatagram datagram;
  Writer out(datagram);
  out.byte(kFixMap | 11);
  out.key("timestamp");
  out.byte(kFloat64);
  out.big_endian(std::bit_cast<std::uint64_t>(timestamp_s), 8);
  out.unsigned_number("arbitration_id", frame.id);
  out.boolean("is_extended_id", frame.extended);
  out.boolean("is_remote_frame", frame.remote);
  out.boolean("is_error_frame", frame.error);
  out.key("channel");
  out.byte(kNil);
  out.unsigned_number("dlc", frame.length);
  const auto data = frame.remote ? std::span<const std::uint8_t>{} : frame.payload();
  out.key("data");
  out.byte(kBin8);
  out.byte(static_cast<std::uint8_t>(data.size()));
  for (const std::uint8_t b : data) out.byte(b);
  out.boolean("is_fd", frame.fd);
  out.boolean("bitrate_switch", frame.bit_rate_switch);
  out.boolean("error_state_indicator", frame.error_state_indicator);
  return datagram;
}

std::expected<CanFrame, std::string_view> decode_udp_datagram(std::span<const std::uint8_t> datagram) {
  Reader in(datagram);
  const auto size = in.map_size();
  if (!size) return std::unexpected("no MessagePack map");
  if (*size > kMaxKeys) return std::unexpected("too many keys");
  Fields fields;
  for (std::size_t i = 0; i < *size; ++i) {
    const auto key = in.scalar();
    if (!key || key->kind != Value::Kind::text) return std::unexpected("a key is no text");
    const auto value = in.scalar();
    if (!value) return std::unexpected("cut, or a value that is no scalar");
    const std::string_view name(reinterpret_cast<const char*>(key->bytes.data()), key->bytes.size());
    const std::string_view reason = take(name, *value, fields);
    if (!reason.empty()) return std::unexpected(reason);
  }
  if (!in.at_end()) return std::unexpected("bytes behind the map");
  return checked(fields);
}

}  // namespace cellmirror::can
