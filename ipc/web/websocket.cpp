#include "ipc/web/websocket.hpp"

#include <algorithm>
#include <array>

#include "ipc/web/sha1.hpp"
#include "rt_core/base/base64.hpp"
#include "rt_core/base/utf8.hpp"

namespace cellmirror::web {

namespace {

constexpr std::size_t kMaxControlPayload = 125;  // section 5.5
constexpr std::size_t kMaskBytes = 4;

bool is_control(Opcode opcode) { return static_cast<std::uint8_t>(opcode) >= 8; }

bool is_known(std::uint8_t opcode) { return opcode <= 2 || (opcode >= 8 && opcode <= 10); }

std::uint8_t byte_of(std::string_view text, std::size_t i) { return static_cast<std::uint8_t>(text[i]); }

// Section 7.4: those that a close frame may carry; 1004 to 1006 and 1015 are reserved.
bool may_be_sent(std::uint16_t code) {
  return (code >= 1000 && code <= 1003) || (code >= 1007 && code <= 1014) || (code >= 3000 && code <= 4999);
}

std::optional<CloseCode> error_in(const WebSocketMessage& message) {
  if (message.opcode == Opcode::text)
    return is_utf8(message.payload) ? std::nullopt : std::optional(CloseCode::bad_text);
  if (message.opcode != Opcode::close || message.payload.empty()) return std::nullopt;
  if (message.payload.size() == 1 || !may_be_sent(static_cast<std::uint16_t>(close_code_of(message.payload))))
    return CloseCode::protocol_error;
  return is_utf8(std::string_view(message.payload).substr(2)) ? std::nullopt : std::optional(CloseCode::bad_text);
}

}  // namespace

struct FrameReader::Header {
  bool last = false;
  Opcode opcode = Opcode::text;
  std::array<char, kMaskBytes> mask{};
  std::size_t bytes = 0;  // of the header itself
  std::size_t payload = 0;
};

std::optional<std::string> websocket_accept(const HttpRequest& request) {
  constexpr std::string_view kGuid = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";  // section 1.3
  constexpr std::size_t kKeyLength = 24;                                      // Base64 of 16 bytes
  const std::string* key = request.header("sec-websocket-key");
  const std::string* version = request.header("sec-websocket-version");
  if (request.method != "GET" || !request.header_has("upgrade", "websocket") ||
      !request.header_has("connection", "upgrade"))
    return std::nullopt;
  if (key == nullptr || key->size() != kKeyLength || version == nullptr || *version != "13") return std::nullopt;
  return base64(sha1(*key + std::string(kGuid)));
}

std::string frame_header(Opcode opcode, std::size_t payload_bytes) {
  std::string out(1, static_cast<char>(0x80U | static_cast<std::uint8_t>(opcode)));
  const auto append = [&](int bytes) {
    for (int i = bytes - 1; i >= 0; --i)
      out += static_cast<char>(static_cast<std::uint8_t>(std::uint64_t{payload_bytes} >> (8 * i)));
  };
  if (payload_bytes <= kMaxControlPayload) {
    append(1);
  } else if (payload_bytes <= 0xFFFF) {
    out += static_cast<char>(126);
    append(2);
  } else {
    out += static_cast<char>(127);
    append(8);
  }
  return out;
}

std::string frame(Opcode opcode, std::string_view payload) {
  return frame_header(opcode, payload.size()).append(payload);
}

CloseCode close_code_of(std::string_view payload) {
  if (payload.size() < 2) return CloseCode::none_given;
  return static_cast<CloseCode>((byte_of(payload, 0) << 8U) | byte_of(payload, 1));
}

std::string close_frame(CloseCode code, std::string_view reason) {
  if (code == CloseCode::none_given) return frame(Opcode::close, {});
  const auto number = static_cast<std::uint16_t>(code);
  std::string payload{static_cast<char>(static_cast<std::uint8_t>(number >> 8U)),
                      static_cast<char>(static_cast<std::uint8_t>(number & 0xFFU))};
  payload += reason.substr(0, kMaxControlPayload - payload.size());
  return frame(Opcode::close, payload);
}

void FrameReader::push(std::string_view bytes) {
  if (!error_) bytes_.append(bytes);
}

std::optional<FrameReader::Header> FrameReader::read_header() {
  if (bytes_.size() < 2) return std::nullopt;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes_[i]); };
  const std::uint8_t opcode = byte(0) & 0x0FU;
  const bool reserved_bits = (byte(0) & 0x70U) != 0;
  const bool masked = (byte(1) & 0x80U) != 0;  // section 5.1: a client masks
  if (reserved_bits || !masked || !is_known(opcode)) {
    error_ = CloseCode::protocol_error;
    return std::nullopt;
  }
  Header header;
  header.last = (byte(0) & 0x80U) != 0;
  header.opcode = static_cast<Opcode>(opcode);
  std::uint64_t length = byte(1) & 0x7FU;
  const std::size_t more = length == 127 ? 8 : length == 126 ? 2 : 0;
  header.bytes = 2 + more + kMaskBytes;
  if (bytes_.size() < 2 + more) return std::nullopt;
  if (more > 0) length = 0;
  for (std::size_t i = 0; i < more; ++i) length = (length << 8U) | byte(2 + i);
  if (is_control(header.opcode) && (!header.last || length > kMaxControlPayload)) {
    error_ = CloseCode::protocol_error;
    return std::nullopt;
  }
  if (length > most_bytes_ - std::min(most_bytes_, is_control(header.opcode) ? 0 : parts_.size())) {
    error_ = CloseCode::too_big;
    return std::nullopt;
  }
  header.payload = static_cast<std::size_t>(length);
  if (bytes_.size() < header.bytes + header.payload) return std::nullopt;
  std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(2 + more), kMaskBytes, header.mask.begin());
  return header;
}

std::optional<WebSocketMessage> FrameReader::take(const Header& header) {
  std::string payload = bytes_.substr(header.bytes, header.payload);
  bytes_.erase(0, header.bytes + header.payload);
  for (std::size_t i = 0; i < payload.size(); ++i)
    payload[i] = static_cast<char>(static_cast<std::uint8_t>(payload[i]) ^
                                   static_cast<std::uint8_t>(header.mask[i % kMaskBytes]));
  if (is_control(header.opcode)) return take_checked({header.opcode, std::move(payload)});
  // Section 5.4: only the first part of a message has an opcode.
  if ((header.opcode == Opcode::continuation) != opcode_.has_value()) {
    error_ = CloseCode::protocol_error;
    return std::nullopt;
  }
  if (!opcode_) opcode_ = header.opcode;
  parts_ += payload;
  if (!header.last) return std::nullopt;
  WebSocketMessage message{*opcode_, std::move(parts_)};
  parts_.clear();
  opcode_.reset();
  return take_checked(std::move(message));
}

std::optional<WebSocketMessage> FrameReader::take_checked(WebSocketMessage message) {
  error_ = error_in(message);
  if (error_) return std::nullopt;
  return message;
}

std::optional<WebSocketMessage> FrameReader::next() {
  while (!error_) {
    const auto header = read_header();
    if (!header) return std::nullopt;
    ++count_;
    if (auto message = take(*header)) return message;
  }
  return std::nullopt;
}

}  // namespace cellmirror::web
