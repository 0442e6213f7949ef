// Commands of the monitor page that wait for their acknowledgement, by tags of their own: negative ones, which no
// sender of messages can have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "ipc/web/web_backend.hpp"
#include "ipc/wire/script_message.hpp"

namespace cellmirror::app {

// Any thread.
class PageCommands {
 public:
  using Reply = std::function<void(const web::CommandReply&)>;
  static constexpr std::size_t kMaxWaiting = 512;

  [[nodiscard]] static bool owns(std::int64_t tag) { return tag < 0; }

  // None, and `reply` as it was, where too many wait.
  [[nodiscard]] std::optional<std::int64_t> add(Reply& reply) {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= kMaxWaiting) return std::nullopt;
    waiting_.emplace(--last_, std::move(reply));
    return last_;
  }
  void answer(std::int64_t tag, const ScriptReply& text) {
    if (const auto reply = take(tag)) (*reply)({text.done, text.text});
  }
  // The same, for what never reached the owner; none: it was answered already.
  [[nodiscard]] std::optional<Reply> take(std::int64_t tag) {
    const std::scoped_lock lock(mutex_);
    const auto found = waiting_.find(tag);
    if (found == waiting_.end()) return std::nullopt;
    Reply reply = std::move(found->second);
    waiting_.erase(found);
    return reply;
  }

 private:
  std::mutex mutex_;
  std::int64_t last_ = 0;
  std::map<std::int64_t, Reply> waiting_;
};

}  // namespace cellmirror::app
