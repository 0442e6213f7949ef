// The server of the monitor page, and of pages that only show (web_site.hpp): HTTP and WebSocket. Protocol:
// docs/monitor-page.md. One thread does all I/O and never waits for a client; two others do work that takes longer.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ipc/web/web_backend.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::web {

inline constexpr int kDefaultPort = 8420;
inline constexpr std::size_t kMaxWebSockets = 16;           // at once; one of them is kept for the token
inline constexpr std::size_t kMaxWebSocketsPerUser = 8;     // of this machine, or per address; without the token
inline constexpr std::size_t kMaxConnections = 64;          // requests included
inline constexpr std::size_t kMaxSnapshotsWaiting = 8;      // of all clients together
inline constexpr std::size_t kMaxMessageBytes = 16 * 1024;  // from a client
inline constexpr double kCommandsPerSecond = 20;            // of a client; twice as many at once
inline constexpr std::size_t kMaxCommandsWaiting = 32;      // of a client, for their acknowledgement
inline constexpr std::size_t kMaxBacklogBytes = 4 << 20;    // of output to a client that does not read

// Time limits of clients.
struct Patience {
  Nanoseconds request{5'000'000'000};   // for a whole request
  Nanoseconds answer{60'000'000'000};   // of a command or of another thread
  Nanoseconds sending{10'000'000'000};  // without any progress
  Nanoseconds ping{10'000'000'000};     // silence of a WebSocket before it is pinged
  Nanoseconds silence{30'000'000'000};  // before it is closed
};

struct ServerOptions {
  std::string address = "127.0.0.1";  // numeric
  int port = kDefaultPort;            // 0: a free one
  bool read_only = false;             // no commands
  std::string token;                  // for commands; empty: a new one is made
  std::vector<std::string> origins;   // allowed in addition to its own
  // Part of the first message to a client.
  std::string version;
  std::string cell;
  std::string instance;
  std::string run;  // identifies this run of the gateway; empty: a new one is made
  Patience patience;
};

struct ServerStatus {
  std::uint64_t clients = 0;            // WebSockets, now
  std::uint64_t requests = 0;           // HTTP
  std::uint64_t pictures = 0;           // sent
  std::uint64_t pictures_left_out = 0;  // skipped: the client was not ready
  std::uint64_t refused = 0;            // requests: malformed, oversized, wrong token, wrong origin
  std::uint64_t cut = 0;                // connections that were too slow or silent
  std::uint64_t commands = 0;
  std::uint64_t wrong_tokens = 0;   // checked and wrong
  std::uint64_t unread_tokens = 0;  // refused without a check: the sender had sent too many wrong tokens
};

// Whether a server can listen there now.
[[nodiscard]] bool port_is_free(const std::string& address, int port);

class Server {
 public:
  // `site` is not owned and outlives the server. Refused, with a remedy, where the port is in use.
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const ServerOptions& options, Site& site);
  // Ends at once, regardless of clients.
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
