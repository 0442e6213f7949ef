// The monitor page's server: HTTP and WebSocket. Protocol: docs/monitor-page.md. One thread does all input and output
// and never waits for a client; what takes longer than a moment is done by two others.
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
inline constexpr std::size_t kMaxConnections = 64;          // with those of requests
inline constexpr std::size_t kMaxSnapshotsWaiting = 8;      // of all clients; the gateway's pictures have other uses
inline constexpr std::size_t kMaxMessageBytes = 16 * 1024;  // from a client
inline constexpr double kCommandsPerSecond = 20;            // of a client; and twice as many at once
inline constexpr std::size_t kMaxCommandsWaiting = 32;      // of a client, for their acknowledgement
inline constexpr std::size_t kMaxBacklogBytes =
    4 << 20;  // a picture and acknowledgements, to a client that does not read

// How long clients may take.
struct Patience {
  Nanoseconds request{5'000'000'000};   // for a whole request, however slowly it comes
  Nanoseconds answer{60'000'000'000};   // of a command or another thread
  Nanoseconds sending{10'000'000'000};  // without any progress
  Nanoseconds ping{10'000'000'000};     // silence before a WebSocket is asked whether it is there
  Nanoseconds silence{30'000'000'000};  // before it is cut
};

struct ServerOptions {
  std::string address = "127.0.0.1";  // numeric
  int port = kDefaultPort;            // 0: a free one
  bool read_only = false;             // nobody may command
  std::string token;                  // whoever may command knows it; empty: made anew
  std::vector<std::string> origins;   // beside its own
  // What clients are told at the beginning.
  std::string version;
  std::string cell;
  std::string instance;
  std::string run;  // tells this run of the gateway from those before; empty: made anew
  Patience patience;
};

struct ServerStatus {
  std::uint64_t clients = 0;            // WebSockets, now
  std::uint64_t requests = 0;           // HTTP
  std::uint64_t pictures = 0;           // sent
  std::uint64_t pictures_left_out = 0;  // to clients that were not ready for the next one
  std::uint64_t refused = 0;            // requests: malformed, oversized, wrong token, wrong origin
  std::uint64_t cut = 0;                // connections: too slow, or silent
  std::uint64_t commands = 0;
};

// Whether a server could listen there now.
[[nodiscard]] bool port_is_free(const std::string& address, int port);

class Server {
 public:
  // `backend` is not owned and outlives the server. Refused where the port is in use, with a remedy.
  [[nodiscard]] static Result<std::unique_ptr<Server>> start(const ServerOptions& options, Backend& backend);
  // Ends at once, whatever clients do.
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
