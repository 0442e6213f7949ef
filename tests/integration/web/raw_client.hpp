// A client of the monitor page's server that can misbehave: it sends what it is told, byte by byte.
#pragma once

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::web {

struct ServerMessage {
  int opcode = 0;
  std::string text;
  bool ended = true;
};

class RawClient {
 public:
  explicit RawClient(int port, int receive_buffer = 0) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (receive_buffer > 0) ::setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  }

  [[nodiscard]] int socket() const { return socket_.get(); }
  [[nodiscard]] bool connected() const { return connected_; }

  // False where the server has ended the connection.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }

  // Everything up to the end of the connection; none where it did not end in time.
  std::optional<std::string> read_to_end(double seconds_at_most = 60) {
    const Timestamp end = SystemClock().now() + Nanoseconds(static_cast<std::int64_t>(seconds_at_most * 1e9));
    while (SystemClock().now() < end) {
      if (!read_some(end)) return std::exchange(received_, {});
    }
    return std::nullopt;
  }

  // Up to `mark` and with it; empty where it did not come.
  std::string read_until(std::string_view mark, double seconds_at_most = 60) {
    const Timestamp end = SystemClock().now() + Nanoseconds(static_cast<std::int64_t>(seconds_at_most * 1e9));
    for (;;) {
      const std::size_t at = received_.find(mark);
      if (at != std::string::npos) {
        std::string out = received_.substr(0, at + mark.size());
        received_.erase(0, at + mark.size());
        return out;
      }
      if (SystemClock().now() >= end || !read_some(end)) return {};
    }
  }

  // Opens the WebSocket; the answer's head.
  std::string open_live(int port, std::string_view more_headers = {}) {
    send("GET /live HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
         "Sec-WebSocket-Version: 13\r\n" +
         std::string(more_headers) + "\r\n");
    return read_until("\r\n\r\n");
  }

  // Opens a WebSocket of the Foxglove protocol; the answer's head.
  std::string open_foxglove(int port) {
    send("GET / HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
         "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: foxglove.websocket.v1\r\n\r\n");
    return read_until("\r\n\r\n");
  }

  // The next message of the server, which sends no parts of messages; pings are answered. `pause` before each read.
  ServerMessage next_message(std::chrono::milliseconds pause = {}) {
    const Timestamp end = SystemClock().now() + Nanoseconds(60'000'000'000);
    const auto have = [&](std::size_t bytes) {
      while (received_.size() < bytes) {
        std::this_thread::sleep_for(pause);
        if (SystemClock().now() >= end || !read_some(end)) return false;
      }
      return true;
    };
    for (;;) {
      std::size_t head = 2;
      if (!have(head)) return {};
      std::size_t size = static_cast<unsigned char>(received_[1]);
      const std::size_t bytes = size == 126 ? 2 : size == 127 ? 8 : 0;
      if (!have(head + bytes)) return {};
      if (bytes > 0) size = 0;
      for (std::size_t i = 0; i < bytes; ++i) size = size << 8U | static_cast<unsigned char>(received_[head + i]);
      head += bytes;
      if (!have(head + size)) return {};
      const int opcode = received_[0] & 0x0F;
      ServerMessage out{opcode, received_.substr(head, size), opcode == 8};
      received_.erase(0, head + size);
      if (opcode != 9) return out;
      say(out.text, 10);
    }
  }

  // A masked text frame of at most 65,535 bytes.
  bool say(std::string_view text, int opcode = 1) {
    constexpr std::array<char, 4> kMask = {'m', 'a', 's', 'k'};
    std::string frame(1, static_cast<char>(0x80 | opcode));
    if (text.size() < 126) {
      frame += static_cast<char>(0x80 | static_cast<int>(text.size()));
    } else {
      frame += static_cast<char>(0xFE);
      frame += static_cast<char>(text.size() >> 8U);
      frame += static_cast<char>(text.size() & 0xFFU);
    }
    frame.append(kMask.data(), kMask.size());
    for (std::size_t i = 0; i < text.size(); ++i) frame += static_cast<char>(text[i] ^ kMask.at(i % 4));
    return send(frame);
  }

 private:
  // False at the end of the connection.
  bool read_some(Timestamp end) {
    pollfd polled{socket_.get(), POLLIN, 0};
    const auto left = (end - SystemClock().now()).count() / 1'000'000;
    if (::poll(&polled, 1, static_cast<int>(left > 0 ? left : 0)) <= 0) return true;
    std::array<char, 65536> buffer{};
    const ssize_t got = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
    if (got <= 0) return false;
    received_.append(buffer.data(), static_cast<std::size_t>(got));
    return true;
  }

  Descriptor socket_;
  bool connected_ = false;
  std::string received_;
};

}  // namespace cellmirror::web
