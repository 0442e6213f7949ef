// The server side of WebSocket (RFC 6455): opening handshake and frames, without extensions. Pure: bytes in, messages
// out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ipc/web/http_request.hpp"

namespace cellmirror::web {

enum class Opcode : std::uint8_t { continuation = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

// Status codes of a close frame (section 7.4.1).
enum class CloseCode : std::uint16_t {
  normal = 1000,
  going_away = 1001,
  protocol_error = 1002,
  unsupported = 1003,
  none_given = 1005,  // never on the wire
  bad_text = 1007,    // not UTF-8
  policy = 1008,
  too_big = 1009,
};

// The header Sec-WebSocket-Accept for an opening; none if the request is not an opening handshake of version 13.
[[nodiscard]] std::optional<std::string> websocket_accept(const HttpRequest& request);

// The header of an unmasked frame, as servers send it; the payload follows.
[[nodiscard]] std::string frame_header(Opcode opcode, std::size_t payload_bytes);
[[nodiscard]] std::string frame(Opcode opcode, std::string_view payload);
// Without code and reason for `none_given`.
[[nodiscard]] std::string close_frame(CloseCode code, std::string_view reason);
// The code in the payload of a close frame that FrameReader accepted (section 7.4).
[[nodiscard]] CloseCode close_code_of(std::string_view payload);

struct WebSocketMessage {
  Opcode opcode = Opcode::text;  // text, binary, close, ping or pong
  std::string payload;
};

// Assembles messages from the frames of a client. A message, with all its parts, has at most `most_bytes`: a frame that
// exceeds this is refused by its header, before any of its payload is read.
class FrameReader {
 public:
  explicit FrameReader(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // Bytes as received. Ignored after an error.
  void push(std::string_view bytes);
  // The next complete message; none: more bytes are needed, or there is an error.
  [[nodiscard]] std::optional<WebSocketMessage> next();
  [[nodiscard]] std::optional<CloseCode> error() const { return error_; }
  // Frames read since the last call, parts of messages included.
  [[nodiscard]] std::size_t take_count() { return std::exchange(count_, 0); }

 private:
  struct Header;
  [[nodiscard]] std::optional<Header> read_header();
  std::optional<WebSocketMessage> take(const Header& header);
  std::optional<WebSocketMessage> take_checked(WebSocketMessage message);

  std::size_t most_bytes_;
  std::string bytes_;  // not yet taken
  std::string parts_;  // of a message that is not complete
  std::optional<Opcode> opcode_;
  std::size_t count_ = 0;  // of frames
  std::optional<CloseCode> error_;
};

}  // namespace cellmirror::web
