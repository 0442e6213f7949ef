// Limits and reports wrong tokens per peer. Pure: time is passed in. Never stores a token. Server's thread.
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

inline constexpr double kWrongTokensPerSecond = 0.1;   // per peer
inline constexpr double kWrongTokensAtOnce = 10;       // per peer
inline constexpr double kAllWrongTokensPerSecond = 5;  // all peers together; burst of twice as many
inline constexpr std::size_t kMostWrongPeers = 256;    // peers that are remembered

// Text of the refusal that the client gets.
[[nodiscard]] std::string too_many_wrong_tokens_text(int wait_s);

class TokenTries {
 public:
  enum class Verdict : std::uint8_t {
    none,    // no token was sent
    right,   // the token is right
    wrong,   // the token is wrong; counted
    unread,  // not checked: the peer has sent too many wrong tokens
  };
  struct Check {
    Verdict verdict = Verdict::none;
    int wait_s = 0;  // for `unread`: time until the next token is checked
    [[nodiscard]] bool right() const { return verdict == Verdict::right; }
  };

  // `peer`: result of peer_of(). A peer that has sent no wrong token is never refused. While all peers together exceed
  // their limit, every peer that has sent a wrong token is refused. A right token does not reset the counts.
  [[nodiscard]] Check check(std::string_view given, std::string_view token, const std::string& peer, Timestamp now);

  // Lines for the log, one per peer that has sent wrong tokens: at the first token, then at most every kReportPeriod.
  // At most kMostLines, and one about all other peers.
  [[nodiscard]] std::vector<std::string> take_reports(Timestamp now);

  static constexpr std::size_t kMostLines = 4;
  static constexpr Nanoseconds kReportPeriod{10'000'000'000};

 private:
  struct Peer {
    double left = kWrongTokensAtOnce;  // allowance at the time `last`
    Timestamp last;
    // Counts since the last line about this peer.
    std::uint64_t wrong = 0;
    std::uint64_t unread = 0;
    Timestamp first;  // time of the first of these attempts
    Timestamp due;    // earliest time of the next line
  };
  using Peers = std::unordered_map<std::string, Peer>;

  // Time until the peer's next token is checked; zero: now.
  [[nodiscard]] double wait_s(const Peer& peer, Timestamp now);
  void note_wrong(const std::string& name, Timestamp now);
  // Counts one more attempt of the peer in `which`.
  void count(Peer& peer, std::uint64_t Peer::* which, Timestamp now);
  void look_again(Timestamp at) { next_report_ = next_report_ ? std::min(*next_report_, at) : at; }
  // Forgets the peers whose allowance is full again; if there are none, the peer with the oldest wrong token.
  void make_room(Timestamp now);
  void forget(Peers::iterator peer);

  Peers peers_;
  double all_left_ = 2 * kAllWrongTokensPerSecond;
  Timestamp all_last_;
  std::optional<Timestamp> next_report_;  // empty: nothing to report
  // Counts of peers that were forgotten before a line about them.
  std::uint64_t dropped_wrong_ = 0;
  std::uint64_t dropped_unread_ = 0;
};

}  // namespace cellmirror::web
