// Shared by the connections of one server. Private to this folder.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "ipc/web/access.hpp"
#include "ipc/web/flow.hpp"
#include "ipc/web/inbox.hpp"
#include "ipc/web/job_pool.hpp"
#include "ipc/web/places.hpp"
#include "ipc/web/token_tries.hpp"
#include "ipc/web/web_backend.hpp"
#include "ipc/web/web_server.hpp"

namespace cellmirror::web {

// For status(), from any thread; relaxed, because no other data depends on them.
struct Counters {
  std::atomic<std::uint64_t> clients{0};
  std::atomic<std::uint64_t> requests{0};
  std::atomic<std::uint64_t> pictures{0};
  std::atomic<std::uint64_t> pictures_left_out{0};
  std::atomic<std::uint64_t> refused{0};
  std::atomic<std::uint64_t> cut{0};
  std::atomic<std::uint64_t> commands{0};
  std::atomic<std::uint64_t> wrong_tokens{0};
  std::atomic<std::uint64_t> unread_tokens{0};
};

inline void count(std::atomic<std::uint64_t>& counter, std::uint64_t by = 1) {
  counter.fetch_add(by, std::memory_order_relaxed);
}

struct ServerContext {
  ServerOptions options;  // with port and token as they are
  AccessRules access;
  Site& site;
  Backend* gateway;  // null: the site only shows
  JobPool& jobs;
  std::shared_ptr<Inbox> inbox;
  Counters& counters;
  // POST /api/command, all clients together, since each of these commands has its own connection. Server's thread.
  RateLimit posted_commands{kCommandsPerSecond};
  Places places{};  // of WebSockets; server's thread
  TokenTries tries{};
  // Snapshots that are pending, those of closed connections included; counted down by the reply, possibly after the end
  // of the server.
  std::shared_ptr<std::atomic<std::uint64_t>> snapshots = std::make_shared<std::atomic<std::uint64_t>>(0);
};

// Checks and counts a token, whichever way the client sent it. `peer`: result of peer_of().
inline TokenTries::Check check_token(ServerContext& context, std::string_view given, const std::string& peer,
                                     Timestamp now) {
  const TokenTries::Check checked = context.tries.check(given, context.options.token, peer, now);
  if (checked.verdict == TokenTries::Verdict::wrong) count(context.counters.wrong_tokens);
  if (checked.verdict == TokenTries::Verdict::unread) count(context.counters.unread_tokens);
  return checked;
}

}  // namespace cellmirror::web
