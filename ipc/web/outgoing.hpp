// The output queue of one socket. Sending never waits. Server's thread.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

namespace cellmirror::web {

// Bytes and their owner; shared between clients that get the same.
struct Chunk {
  std::shared_ptr<const void> owner;
  std::string_view bytes;
};
[[nodiscard]] Chunk chunk_of(std::string text);
// Of bytes with static storage.
[[nodiscard]] inline Chunk chunk_of_constant(std::string_view bytes) { return {nullptr, bytes}; }

class Outgoing {
 public:
  enum class Progress { finished, waiting, failed };

  void push(Chunk chunk);
  void push(std::string text) { push(chunk_of(std::move(text))); }
  [[nodiscard]] std::size_t pending() const { return pending_; }
  [[nodiscard]] bool empty() const { return pending_ == 0; }
  // Whether the last write_some() sent anything.
  [[nodiscard]] bool progressed() const { return progressed_; }
  // Sends as much as the socket accepts now.
  [[nodiscard]] Progress write_some(int socket);

 private:
  void drop_sent(std::size_t bytes);

  std::deque<Chunk> chunks_;
  std::size_t pending_ = 0;
  bool progressed_ = false;
};

}  // namespace cellmirror::web
