// Replies to clients whose reader of replies is not known yet: a client may ask as soon as it knows the server, which
// learns of the client's writer and reader one after the other. Pure. One thread at a time.
#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "drivers/dds/service_mapping.hpp"

namespace cellmirror::dds {

struct HeldReply {
  RequestName to;
  std::vector<std::byte> payload;
};

class HeldReplies {
 public:
  static constexpr std::size_t kMost = 16;

  // False where the oldest one was dropped for it.
  bool hold(const RequestName& to, std::span<const std::byte> payload);
  // Those for which `reaches(to)` holds now, the oldest first; they are no longer held.
  template <class Reaches>
  [[nodiscard]] std::vector<HeldReply> take(const Reaches& reaches) {
    std::vector<HeldReply> out;
    std::erase_if(held_, [&](HeldReply& one) {
      if (!reaches(one.to)) return false;
      out.push_back(std::move(one));
      return true;
    });
    return out;
  }

 private:
  std::deque<HeldReply> held_;
};

}  // namespace cellmirror::dds
