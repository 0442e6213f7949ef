// What arrives for the wall, between the threads that receive and the one that shows it. Bounded: of each sender so
// many messages a second, of all together so many bytes; what is beyond is dropped and counted, and the receiving
// threads never wait for more than a short lock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "app/wall/wall_cells.hpp"
#include "ipc/web/flow.hpp"

namespace cellmirror::app {

inline constexpr double kSummariesPerSecond =
    20;  // of a sender: twice what a gateway sends at most; twice as many at once
inline constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20U;
inline constexpr std::size_t kMostWaitingMessages = 8'192;

// Any thread.
class WallInbox {
 public:
  struct Refused {
    std::uint64_t dropped = 0;   // more than a sender may send
    std::uint64_t rejected = 0;  // no summaries
    std::string why;             // of the last of those
  };
  struct Taken {
    std::vector<WallMessage> messages;                    // as they came
    std::vector<std::string> gone;                        // senders
    std::map<std::string, Refused, std::less<>> refused;  // by sender
    std::uint64_t left_out = 0;                           // too many senders
  };

  void received(WallMessage message);
  void rejected(std::string_view sender, const std::string& why);
  void gone(std::string_view sender);
  // Everything since the last call.
  [[nodiscard]] Taken take();

 private:
  struct Sender {
    web::RateLimit limit{kSummariesPerSecond};
    Timestamp last;
  };
  Refused* refused_of(std::string_view sender);
  bool admits(const std::string& sender, Timestamp now);

  std::mutex mutex_;
  Taken waiting_;
  std::size_t bytes_ = 0;
  std::map<std::string, Sender, std::less<>> senders_;
};

}  // namespace cellmirror::app
