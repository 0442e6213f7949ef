// Answers questions about the running gateway on a Unix-domain socket. Protocol: docs/messages.md, "The control
// socket".
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror {

inline constexpr std::size_t kMaxControlRequestBytes = 65'536;
inline constexpr std::size_t kMaxControlReplyBytes = std::size_t{16} * 1024 * 1024;

// A pending request: answered at once or later, once, by any thread, even after the end of the server or the client.
// Released without an answer it is answered as failed.
class ControlReply {
 public:
  class Answers;  // receives answers
  ControlReply(std::shared_ptr<Answers> answers, std::uint64_t client);
  ~ControlReply();
  ControlReply(ControlReply&& other) noexcept;
  ControlReply& operator=(ControlReply&&) = delete;
  void operator()(std::string text);

 private:
  std::shared_ptr<Answers> answers_;  // null: answered
  std::uint64_t client_;
};

struct ControlServerStatus {
  std::uint64_t answered = 0;
  std::uint64_t refused = 0;  // other users, requests too long
  std::uint64_t cut = 0;      // clients that sent or read too slowly
};

// One thread serves up to kMaxClients at once; a slow client blocks no other and is disconnected after the time-out, or
// earlier if a new one needs its place. Only processes of the same user, and root, are admitted (SO_PEERCRED).
class ControlServer {
 public:
  static constexpr std::size_t kMaxClients = 32;
  // Is given one request line without its line break and returns one JSON document. Called from the server's thread:
  // what takes long delays the other clients.
  using Handler = std::function<std::string(std::string_view request)>;
  // The same for questions whose answers take their time.
  using LaterHandler = std::function<void(std::string_view request, ControlReply reply)>;
  static constexpr Nanoseconds kLongestAnswer{30'000'000'000};

  // Makes the socket (0600) at `path`, replacing one that was left behind: call it with the instance's claim held.
  [[nodiscard]] static Result<std::unique_ptr<ControlServer>> start(const std::filesystem::path& path, Handler handler,
                                                                    Nanoseconds client_timeout = Nanoseconds{
                                                                        5'000'000'000});
  [[nodiscard]] static Result<std::unique_ptr<ControlServer>> start_later(
      const std::filesystem::path& path, LaterHandler handler, Nanoseconds client_timeout = Nanoseconds{5'000'000'000});
  ~ControlServer();  // stops, disconnects the clients, removes the socket
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  [[nodiscard]] ControlServerStatus status() const;  // any thread

 private:
  struct Impl;
  explicit ControlServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror
