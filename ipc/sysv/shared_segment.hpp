// System V shared memory: a segment that the gateway creates and owns, and one that a client attaches to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "ipc/sysv/force_guard.hpp"
#include "ipc/sysv/key_lock.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

inline constexpr std::size_t kMaxSegmentBytes = std::size_t{1} << 20;

struct SegmentUsers {
  bool gone = false;              // removed under us (log-out, ipcrm): others can no longer find it
  std::uint64_t attached = 0;     // number of attachments, including ours: 1 means no other process
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
    ForceGuard* guard = nullptr;  // outlives the segment; null: nobody clears what a killed gateway leaves
    GuardedBlock block = GuardedBlock::none;
  };

  // Takes the key's lock and creates the segment, zeroed. An existing one (left by a killed gateway, or created earlier
  // by the device program) is used if it belongs to this user, has no wider mode than `mode` and is large enough:
  // unchanged if a process is attached, else zeroed. One that is too small and unused is replaced. Refused, with the
  // remedy: a key that another gateway holds, a segment of another user, one with a wider mode, one that is too small
  // and in use, one beyond kMaxSegmentBytes.
  static Result<std::unique_ptr<SharedSegment>> make(Options options);
  // Detaches and removes it: attached processes keep the memory until they detach.
  ~SharedSegment();
  SharedSegment(const SharedSegment&) = delete;
  SharedSegment& operator=(const SharedSegment&) = delete;

  // Page-aligned; of the requested size. Constant while this lives. Every page has been written to, so that access to
  // it does not fault where memory is locked or not short.
  [[nodiscard]] std::span<std::byte> memory() const;
  [[nodiscard]] const Options& options() const;
  // A segment existed already, with an attached process.
  [[nodiscard]] bool taken_over() const;
  [[nodiscard]] SegmentUsers users() const;
  // After `gone`: recreates it at the same address, zeroed, even while other threads access memory() (their next access
  // may wait for the kernel once). No effect if it is not gone. Fails if another process has taken the key: the old
  // memory stays, shared with the attached processes.
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
  // Refused if it does not exist, belongs to another user, or is smaller than `bytes`.
  static Result<AttachedSegment> attach(std::int32_t key, std::size_t bytes, bool read_only);
  ~AttachedSegment();
  AttachedSegment(AttachedSegment&& other) noexcept;
  AttachedSegment& operator=(AttachedSegment&& other) noexcept;
  AttachedSegment(const AttachedSegment&) = delete;
  AttachedSegment& operator=(const AttachedSegment&) = delete;

  // Of the requested size; page-aligned. Must not be written if attached for reading.
  [[nodiscard]] std::span<std::byte> memory() const { return memory_; }
  // Its creator, or another process, has removed it: attach again.
  [[nodiscard]] bool removed() const;

 private:
  AttachedSegment(std::span<std::byte> memory, int id) : memory_(memory), id_(id) {}
  std::span<std::byte> memory_;
  int id_ = -1;
};

}  // namespace cellmirror
