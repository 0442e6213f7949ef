// Sources of control commands: standard input, and a FIFO or a Unix socket. Never waits; the device's loop polls.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/descriptor.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror::sim {

class ControlServer {
 public:
  // Answers one line; the answer gets its line end here.
  using Answer = std::function<std::string(std::string_view line)>;

  ControlServer() = default;
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  // Standard input; answers go to standard error, so that standard output stays one JSON document.
  void watch_standard_input();
  // An existing FIFO is read (answers to standard error); else a Unix stream socket is created at `path`, mode 0600. An
  // unserved socket is replaced; anything else at `path` is refused.
  Result<void> open(const std::string& path);

  // Takes what has come, on any of them. Waits at most `timeout_ms` (0: not at all, -1: until something comes).
  void serve(int timeout_ms, const Answer& answer);

  static constexpr std::size_t kMostClients = 16;

 private:
  struct Client {
    Descriptor own;  // none: standard input
    int in = -1;
    int out = -1;
    bool socket = false;
    bool stays = false;  // the FIFO: end of file means only that the last writer has left
    std::string pending;
  };

  void accept_clients();
  void read_from(Client& client, const Answer& answer);
  static void reply(const Client& client, std::string text);

  Descriptor listener_;
  std::string socket_path_;
  std::vector<Client> clients_;
};

}  // namespace cellmirror::sim
