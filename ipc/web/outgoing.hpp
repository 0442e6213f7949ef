// What waits to be sent on one socket. Sending never waits. Belongs to the server's thread.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

namespace cellmirror::web {

// Bytes and what keeps them; shared where several clients get the same.
struct Chunk {
  std::shared_ptr<const void> owner;
  std::string_view bytes;
};
[[nodiscard]] Chunk chunk_of(std::string text);
// Of bytes that are part of the program.
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
  // As much as the socket takes now.
  [[nodiscard]] Progress write_some(int socket);

 private:
  void drop_sent(std::size_t bytes);

  std::deque<Chunk> chunks_;
  std::size_t pending_ = 0;
  bool progressed_ = false;
};

}  // namespace cellmirror::web
