// Monitors a memory written by another process: a thread reads its bytes once a millisecond and passes on changes. The
// other process may be hostile, die or return: its bytes are only read by value, one by one.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "drivers/footswitch/switch_edges.hpp"
#include "rt_core/base/time.hpp"
#include "rt_core/rt/fifo.hpp"
#include "rt_core/rt/latest.hpp"

namespace cellmirror::footswitch {

inline constexpr std::size_t kMostSwitchBytes = 4096;  // bytes beyond are ignored
inline constexpr std::size_t kEdgeQueue = 8192;        // changes on their way to the owner

class SwitchReader {
 public:
  struct Options {
    Nanoseconds period{1'000'000};
    Nanoseconds debounce{0};
    int priority = 0;            // SCHED_FIFO of the thread, where it is to be had; 0: none
    std::function<void()> wake;  // called by the thread after it has passed on changes; may be empty
  };
  struct Counters {
    std::uint64_t looks = 0;
    std::uint64_t edges = 0;    // passed on
    std::uint64_t dropped = 0;  // the queue was full
    std::uint64_t bounces = 0;
  };

  // Starts the thread. `memory` (at most kMostSwitchBytes of it are read) and `clock` outlive the reader. The thread
  // sleeps by the monotonic clock of the system, whatever `clock` says.
  SwitchReader(std::span<const std::byte> memory, const Clock& clock, Options options);
  ~SwitchReader();
  SwitchReader(const SwitchReader&) = delete;
  SwitchReader& operator=(const SwitchReader&) = delete;

  // The owner's thread: ends the watching, once. Then all that changed before it can be had from next().
  void stop();
  // The owner's thread: the next change, in order. False if there is none.
  bool next(SwitchEdge& edge) { return queue_.pop(edge); }
  // Any thread.
  [[nodiscard]] Counters counters() const;
  // The owner's thread: inputs that are on, from 1, at most `most` of them.
  [[nodiscard]] std::vector<std::uint32_t> inputs_on(std::size_t most);

 private:
  class Thread;
  using Inputs = std::array<std::uint8_t, kMostSwitchBytes>;

  void look(Timestamp now);

  std::span<const std::byte> memory_;
  const Clock& clock_;
  Options options_;
  SwitchEdges edges_;
  std::vector<std::uint8_t> copy_;
  std::vector<SwitchEdge> found_;
  Fifo<SwitchEdge, kEdgeQueue> queue_;
  Latest<Inputs> reported_;
  std::atomic<std::uint64_t> looks_{0};
  std::atomic<std::uint64_t> bounces_{0};
  std::unique_ptr<Thread> thread_;  // last: ends before what it uses
};

// Copies bytes that others may be writing to.
void copy_shared_bytes(std::span<const std::byte> from, std::span<std::uint8_t> to);

}  // namespace cellmirror::footswitch
