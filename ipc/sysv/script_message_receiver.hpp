// SCRIPT commands by message (manual 1.1: key 2351, type 5), and the acknowledgements that we add to them.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/wire/script_message.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/stream_config.hpp"

namespace cellmirror {

struct ScriptMessage {
  std::string text;             // one command; valid UTF-8, not empty
  std::int64_t tag = 0;         // 0: no reply requested
  std::int32_t sender_pid = 0;  // last sender at the time of reception: exact unless several send at once; 0 unknown
  std::optional<std::uint32_t> sender_user = {};  // of that process, if it still runs
};

// A copy for `status`.
struct ScriptMessageStatus {
  std::uint64_t received = 0;            // passed to the handler
  std::uint64_t malformed = 0;           // refused here: no text, no UTF-8, bad tag, too long
  std::uint64_t wrong_type = 0;          // of another type than 5: taken out so that they cannot clog the queue
  std::uint64_t replies = 0;             // sent
  std::uint64_t replies_dropped = 0;     // taken out unread because the reply queue was full, or not deliverable
  std::uint64_t recreated = 0;           // times a removed queue was recreated
  std::uint64_t discarded = 0;           // messages that an earlier process left behind
  std::uint64_t waiting = 0;             // in the input queue now
  std::vector<std::string> last_errors;  // newest last, bounded
  std::string input_problem;             // why no message arrives: the key's queue is not ours; empty: it is
  std::string reply_problem;             // the same of replies
  std::int32_t input_queue = -1;         // the kernel's number of our queue, by which a client knows it
  std::int32_t reply_queue = -1;
};

// Owns the input queue (script_key) and the reply queue (reply_key). One thread waits for messages and calls the
// handler; another looks several times a second whether both queues are still there and ours. The handler may wait (the
// queue then fills up, which its senders see), and must return before stop() does. stop() and the destructor remove
// both queues.
class ScriptMessageReceiver {
 public:
  using Handler = std::function<void(ScriptMessage)>;
  // A message that is no command: it has no text; `why` it is refused.
  using RefusedHandler = std::function<void(const ScriptMessage& message, const std::string& why)>;

  ScriptMessageReceiver(QueueConfig config, std::string instance);
  ~ScriptMessageReceiver();
  ScriptMessageReceiver(const ScriptMessageReceiver&) = delete;
  ScriptMessageReceiver& operator=(const ScriptMessageReceiver&) = delete;

  // Fails where a queue cannot be had; see OwnedQueue::make. Nothing is left behind then.
  [[nodiscard]] Result<void> start(Handler handler, RefusedHandler refused = {});
  // May be called when nothing runs. Not from the handler.
  void stop();

  // Sends the reply to the message with this tag; none for tag 0. Never waits: where the reply queue is full, the
  // oldest replies are taken out. Any thread; after stop() it does nothing.
  void reply(std::int64_t tag, const ScriptReply& reply);

  [[nodiscard]] ScriptMessageStatus status() const;  // any thread

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror
