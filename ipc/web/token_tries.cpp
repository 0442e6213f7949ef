#include "ipc/web/token_tries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "ipc/web/access.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror::web {

namespace {

double refilled(double left, double per_second, double most, Timestamp last, Timestamp now) {
  return last.known() ? std::min(most, left + per_second * std::max(0.0, seconds(now - last))) : left;
}

std::string line_about(std::string_view who, std::uint64_t wrong, std::uint64_t unread, double over_s) {
  std::string out = fmt::format("{} wrong token{} from {}", wrong, wrong == 1 ? "" : "s", who);
  if (wrong + unread > 1) out += fmt::format(" within {:.0f} s", std::ceil(over_s));
  if (unread > 0) out += fmt::format(", and {} more attempts that were refused without a check", unread);
  return out;
}

}  // namespace

std::string too_many_wrong_tokens_text(int wait_s) {
  return fmt::format(
      "too many wrong tokens from your address: this one was not checked; wait {} s, then send the token that "
      "cellmirror page prints",
      wait_s);
}

double TokenTries::wait_s(const Peer& peer, Timestamp now) {
  all_left_ = refilled(all_left_, kAllWrongTokensPerSecond, 2 * kAllWrongTokensPerSecond, all_last_, now);
  all_last_ = now;
  const double left = refilled(peer.left, kWrongTokensPerSecond, kWrongTokensAtOnce, peer.last, now);
  const double of_peer = left >= 1 ? 0 : (1 - left) / kWrongTokensPerSecond;
  const double of_all = all_left_ >= 1 ? 0 : (1 - all_left_) / kAllWrongTokensPerSecond;
  return std::max(of_peer, of_all);
}

TokenTries::Check TokenTries::check(std::string_view given, std::string_view token, const std::string& peer,
                                    Timestamp now) {
  if (given.empty()) return {};
  if (const auto known = peers_.find(peer); known != peers_.end()) {
    if (const double wait = wait_s(known->second, now); wait > 0) {
      count(known->second, &Peer::unread, now);
      return {Verdict::unread, std::max(1, static_cast<int>(std::ceil(wait)))};
    }
  }
  if (token_matches(given, token)) return {Verdict::right, 0};
  note_wrong(peer, now);
  return {Verdict::wrong, 0};
}

void TokenTries::note_wrong(const std::string& name, Timestamp now) {
  if (!peers_.contains(name) && peers_.size() >= kMostWrongPeers) make_room(now);
  const auto [entry, is_new] = peers_.try_emplace(name);
  Peer& peer = entry->second;
  if (is_new) peer.due = now;
  peer.left = refilled(peer.left, kWrongTokensPerSecond, kWrongTokensAtOnce, peer.last, now) - 1;
  peer.last = now;
  all_left_ = refilled(all_left_, kAllWrongTokensPerSecond, 2 * kAllWrongTokensPerSecond, all_last_, now);
  all_left_ = std::max(0.0, all_left_ - 1);
  all_last_ = now;
  count(peer, &Peer::wrong, now);
}

void TokenTries::count(Peer& peer, std::uint64_t Peer::* which, Timestamp now) {
  if (peer.wrong + peer.unread == 0) peer.first = now;
  ++(peer.*which);
  look_again(std::max(peer.due, now));
}

void TokenTries::make_room(Timestamp now) {
  const double all_back_s = kWrongTokensAtOnce / kWrongTokensPerSecond;
  for (auto at = peers_.begin(); at != peers_.end();) {
    const auto next = std::next(at);
    if (seconds(now - at->second.last) >= all_back_s) forget(at);
    at = next;
  }
  if (peers_.size() < kMostWrongPeers) return;
  forget(std::ranges::min_element(peers_, {}, [](const auto& entry) { return entry.second.last; }));
}

void TokenTries::forget(Peers::iterator peer) {
  dropped_wrong_ += peer->second.wrong;
  dropped_unread_ += peer->second.unread;
  peers_.erase(peer);
}

std::vector<std::string> TokenTries::take_reports(Timestamp now) {
  std::vector<std::string> out;
  if (!next_report_ || now < *next_report_) return out;
  next_report_.reset();
  std::uint64_t wrong = std::exchange(dropped_wrong_, 0);
  std::uint64_t unread = std::exchange(dropped_unread_, 0);
  double longest_s = 0;
  for (auto& [name, peer] : peers_) {
    if (peer.wrong + peer.unread == 0) continue;
    if (now < peer.due) {
      look_again(peer.due);
      continue;
    }
    const double over_s = seconds(now - peer.first);
    if (out.size() < kMostLines) {
      out.push_back(line_about(printable(name), peer.wrong, peer.unread, over_s));
    } else {
      wrong += peer.wrong;
      unread += peer.unread;
      longest_s = std::max(longest_s, over_s);
    }
    peer.wrong = 0;
    peer.unread = 0;
    peer.due = now + kReportPeriod;
  }
  if (wrong + unread > 0) out.push_back(line_about("other addresses", wrong, unread, longest_s));
  return out;
}

}  // namespace cellmirror::web
