// Wrong tokens by the peer that sent them: how many of a peer are looked at, and what is logged about them. Pure: time
// is passed in. Never keeps a token. Server's thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "ipc/web/flow.hpp"
#include "rt_core/base/time.hpp"

namespace cellmirror::web {

inline constexpr double kWrongTokensPerSecond = 0.1;   // of a peer
inline constexpr double kWrongTokensAtOnce = 10;       // of a peer
inline constexpr double kAllWrongTokensPerSecond = 5;  // of all peers; twice as many at once
inline constexpr std::size_t kMostWrongPeers = 256;    // that are remembered

// For the client.
[[nodiscard]] std::string too_many_wrong_tokens_text(int wait_s);

class TokenTries {
 public:
  enum class Verdict : std::uint8_t {
    none,    // there is no token
    right,   // it is the token
    wrong,   // it is another one; counted
    unread,  // not looked at: the peer has sent too many wrong ones
  };
  struct Check {
    Verdict verdict = Verdict::none;
    int wait_s = 0;  // of `unread`: before the next one is looked at
    [[nodiscard]] bool right() const { return verdict == Verdict::right; }
  };

  // `peer`: as of peer_of(). A peer that has sent no wrong token is never refused, whatever others do; while all peers
  // together send too many, each that has sent one is. A right token takes nothing off.
  [[nodiscard]] Check check(std::string_view given, std::string_view token, const std::string& peer, Timestamp now);

  // A line for the log about each peer that has sent wrong tokens: at the first one, then every ten seconds, at most
  // kMostLines of them and one about all others.
  [[nodiscard]] std::vector<std::string> take_reports(Timestamp now);

  static constexpr std::size_t kMostLines = 4;
  static constexpr Nanoseconds kReportPeriod{10'000'000'000};

 private:
  struct Peer {
    double left = kWrongTokensAtOnce;  // as of `last`
    Timestamp last;
    // Since the last line about it.
    std::uint64_t wrong = 0;
    std::uint64_t unread = 0;
    Timestamp first;  // of those
    Timestamp due;    // no line before
  };
  using Peers = std::unordered_map<std::string, Peer>;

  // How long until the peer's next token is looked at; zero or less: now.
  [[nodiscard]] double wait_s(const Peer& peer, Timestamp now);
  void note_wrong(const std::string& name, Timestamp now);
  // Of the peer's attempts one more, counted in `which`.
  void count(Peer& peer, std::uint64_t Peer::* which, Timestamp now);
  void look_again(Timestamp at) { next_report_ = next_report_ ? std::min(*next_report_, at) : at; }
  // Drops who has been quiet for long, or else who has been quiet longest.
  void make_room(Timestamp now);
  void forget(Peers::iterator peer);

  Peers peers_;
  double all_left_ = 2 * kAllWrongTokensPerSecond;
  Timestamp all_last_;
  std::optional<Timestamp> next_report_;  // nothing is to be reported
  // Of peers that were dropped before a line about them.
  std::uint64_t dropped_wrong_ = 0;
  std::uint64_t dropped_unread_ = 0;
};

}  // namespace cellmirror::web
