// How the WebSockets of a server are shared out, so that no single user can take them all. Server's thread.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "ipc/web/web_server.hpp"

namespace cellmirror::web {

// Outlives the places that it has given.
class Places {
 public:
  // A place, which ends with the last copy; null: there is none for this client. `peer`: as of peer_of(). Clients with
  // the token are not counted by user, and one place is left to them.
  [[nodiscard]] std::shared_ptr<void> take(const std::string& peer, bool has_token) {
    if (taken_ >= kMaxWebSockets) return nullptr;
    if (!has_token) {
      if (without_token_ >= kMaxWebSockets - 1 || taken_by(peer) >= kMaxWebSocketsPerUser) return nullptr;
      ++without_token_;
      ++by_peer_[peer];
    }
    ++taken_;
    return {this, [peer, has_token](Places* places) { places->give_back(peer, has_token); }};
  }

 private:
  [[nodiscard]] std::size_t taken_by(const std::string& peer) const {
    const auto found = by_peer_.find(peer);
    return found == by_peer_.end() ? 0 : found->second;
  }
  void give_back(const std::string& peer, bool has_token) {
    --taken_;
    if (has_token) return;
    --without_token_;
    if (--by_peer_[peer] == 0) by_peer_.erase(peer);
  }

  std::size_t taken_ = 0;
  std::size_t without_token_ = 0;
  std::map<std::string, std::size_t> by_peer_;  // of those without the token
};

}  // namespace cellmirror::web
