// System V shared memory: a segment that the gateway makes and owns, and one that somebody attaches to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "ipc/sysv/key_lock.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

inline constexpr std::size_t kMaxSegmentBytes = std::size_t{1} << 20;

struct SegmentUsers {
  bool gone = false;              // removed under us (log-out, ipcrm): others can no longer find it
  std::uint64_t attached = 0;     // how often it is attached, by ourselves too: 1 means that nobody else has it
  std::int32_t last_process = 0;  // that attached or detached last
};

// Made, owned and removed by one thread at a time; its memory is anybody's. Nothing here is for the tick (system
// calls), except to load and store in memory().
class SharedSegment {
 public:
  struct Options {
    std::string purpose;  // for messages, e.g. "haptic device of LAP_LEFT"
    std::int32_t key = 0;
    std::size_t bytes = 0;      // 1 to kMaxSegmentBytes
    std::uint32_t mode = 0600;  // shmget(2): read and write for owner, group, others
    std::string instance = "default";
  };

  // Takes the key's lock and makes the segment, all zero. One that is there already (left behind by a gateway that was
  // killed, or made by the device's process before us) is taken where it belongs to this user, lets in nobody beyond
  // `mode` and is large enough: as it stands where somebody is attached to it, else zeroed. One that is too small and
  // that nobody uses is replaced. Refused, with the remedy: a key that another gateway holds, a segment of another
  // user, one that lets in more users, one that is too small and in use, one beyond kMaxSegmentBytes.
  static Result<std::unique_ptr<SharedSegment>> make(Options options);
  // Detaches and removes it: those who are attached keep the memory until they let go.
  ~SharedSegment();
  SharedSegment(const SharedSegment&) = delete;
  SharedSegment& operator=(const SharedSegment&) = delete;

  // At a page's beginning; as many bytes as were asked for. Constant while this lives. Every page has been written to,
  // so that access to it does not fault where memory is locked or not short.
  [[nodiscard]] std::span<std::byte> memory() const;
  [[nodiscard]] const Options& options() const;
  // A segment was there already, and somebody was attached to it.
  [[nodiscard]] bool taken_over() const;
  [[nodiscard]] SegmentUsers users() const;
  // After `gone`: makes it anew at the same address, zeroed, whatever other threads do in memory() meanwhile (their
  // next access may wait for the kernel once). Nothing happens where it is not gone. Fails where the key was lost to
  // somebody else: the old memory stays, shared with those who are still attached.
  [[nodiscard]] Result<void> renew();
  [[nodiscard]] std::uint64_t renewed() const;

 private:
  struct State;
  explicit SharedSegment(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// The other side: simulators and tests. Moved, not copied. Nothing here is for the tick, except memory().
class AttachedSegment {
 public:
  // Refused where nobody has made it, it belongs to somebody else, or is smaller than `bytes`.
  static Result<AttachedSegment> attach(std::int32_t key, std::size_t bytes, bool read_only);
  ~AttachedSegment();
  AttachedSegment(AttachedSegment&& other) noexcept;
  AttachedSegment& operator=(AttachedSegment&& other) noexcept;
  AttachedSegment(const AttachedSegment&) = delete;
  AttachedSegment& operator=(const AttachedSegment&) = delete;

  // As many bytes as were asked for; aligned to a page. Nothing may be written where it was attached for reading.
  [[nodiscard]] std::span<std::byte> memory() const { return memory_; }
  // The one who made it has removed it, or was made to: attach anew.
  [[nodiscard]] bool removed() const;

 private:
  AttachedSegment(std::span<std::byte> memory, int id) : memory_(memory), id_(id) {}
  std::span<std::byte> memory_;
  int id_ = -1;
};

}  // namespace cellmirror
