// The monitor page: HTTP and WebSocket by civetweb. Protocol: docs/monitor-page.md.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ipc/web/web_backend.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::web {

inline constexpr int kDefaultPort = 8420;
inline constexpr std::size_t kMaxClients = 16;              // WebSockets at once
inline constexpr std::size_t kMaxMessageBytes = 16 * 1024;  // from a client

struct ServerOptions {
  std::string address = "127.0.0.1";
  int port = kDefaultPort;           // 0: a free one
  bool read_only = false;            // nobody may command
  std::string token;                 // whoever may command knows it; empty: made anew
  std::vector<std::string> origins;  // beside its own
};

struct ServerStatus {
  std::uint64_t clients = 0;            // now
  std::uint64_t pictures = 0;           // sent
  std::uint64_t pictures_left_out = 0;  // to clients that were not ready for the next one
  std::uint64_t refused = 0;            // requests: malformed, oversized, wrong token, wrong origin
  std::uint64_t commands = 0;
};

class Server {
 public:
  // `backend` is not owned and outlives the server.
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const ServerOptions& options, Backend& backend);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] int port() const;
  [[nodiscard]] const std::string& token() const;
  [[nodiscard]] ServerStatus status() const;  // any thread

 private:
  struct Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror::web
