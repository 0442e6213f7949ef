// The stretch between a simulated device and its channel: timed messages go in and come out unchanged, delayed,
// repeated, corrupted or not at all. Pure: no clock, no channel. M is the protocol's message; FaultTraits<M> provides
// protocol details (position of bits and identity).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "sim_devices/faults/fault_schedule.hpp"

namespace cellmirror::sim {

// To be specialised:
//   static void flip_bits(M&, unsigned bits, Random&);
//   static void change_identity(M&, std::optional<std::uint32_t> id, Random&);
//   static void change_length(M&, int by);
//   static M foreign(std::optional<std::uint32_t> id, Random&);
//   static M bus_off();        an error frame; only for protocols with bus-off
//   static M bus_restarted();
template <class M>
struct FaultTraits;

template <class M>
class FaultPipeline {
 public:
  // What may wait inside (delayed, held); beyond it messages are dropped and counted.
  static constexpr std::size_t kMostWaiting = 200'000;
  static constexpr std::size_t kMostHeld = 10'000;
  static constexpr unsigned kMostCopiesOfOne = 10'000;
  static constexpr int kMostInsertionsAtOnce = 1000;
  static constexpr Nanoseconds kLongestHold{1'000'000'000};

  explicit FaultPipeline(std::uint64_t seed) : schedule_(seed) {}

  [[nodiscard]] FaultSchedule& schedule() { return schedule_; }
  [[nodiscard]] const FaultSchedule& schedule() const { return schedule_; }

  // Takes a message that the device sends at `now`; it leaves at message.time or later.
  void push(Timestamp now, Outgoing<M> message) {
    copies_left_ = kMostCopiesOfOne;
    run(0, now, std::move(message));
  }

  // Appends what leaves at `now`, in its order.
  void poll(Timestamp now, std::vector<Outgoing<M>>& out) {
    bool bus_off = false;
    for (ScheduledFault& fault : schedule_.all()) {
      if (fault.spec.kind == FaultKind::insert) insert(fault, now);
      if (fault.spec.kind == FaultKind::bus_off) bus_off = bus_is_off(fault, now, out) || bus_off;
    }
    release_overdue(now);
    while (!waiting_.empty() && waiting_.front().message.time <= now) {
      std::pop_heap(waiting_.begin(), waiting_.end(), later);
      if (bus_off) {
        count_bus_off();
      } else {
        out.push_back(std::move(waiting_.back().message));
      }
      waiting_.pop_back();
    }
  }

  // When poll() has something to do next; kNeverEnds where nothing waits.
  [[nodiscard]] Timestamp next() const {
    Timestamp next = waiting_.empty() ? kNeverEnds : waiting_.front().message.time;
    for (const Held& held : held_) next = std::min(next, held.latest);
    for (const ScheduledFault& fault : schedule_.all()) {
      if (fault.spec.kind == FaultKind::insert && fault.next_insertion < fault.until &&
          (fault.spec.most == 0 || fault.applied < fault.spec.most)) {
        next = std::min(next, fault.next_insertion);
      }
      if (fault.spec.kind == FaultKind::bus_off) next = std::min(next, fault.began ? fault.until : fault.from);
    }
    return next;
  }

  // Ends faults by command: 0 ends all. Returns how many; what they held leaves with the next poll.
  std::size_t end(int id, Timestamp now) { return ended(schedule_.remove(id), now); }
  std::size_t end(FaultKind kind, Timestamp now) { return ended(schedule_.remove(kind), now); }

  [[nodiscard]] std::uint64_t overflowed() const { return overflowed_; }

 private:
  struct Waiting {
    std::uint64_t sequence;
    Outgoing<M> message;
  };
  struct Held {
    int fault;
    unsigned to_pass;
    Timestamp latest;
    Outgoing<M> message;
  };

  static bool later(const Waiting& a, const Waiting& b) {
    return std::pair(a.message.time, a.sequence) > std::pair(b.message.time, b.sequence);
  }

  void enqueue(Outgoing<M> message) {
    if (waiting_.size() >= kMostWaiting) {
      ++overflowed_;
      return;
    }
    waiting_.push_back({++sequence_, std::move(message)});
    std::push_heap(waiting_.begin(), waiting_.end(), later);
  }

  // The message goes through the faults from number `i` on, in the order in which they were added.
  void run(std::size_t i, Timestamp now, Outgoing<M> message) {
    for (; i < schedule_.all().size(); ++i) {
      ScheduledFault& fault = schedule_.all()[i];
      if (fault.spec.kind == FaultKind::reorder) return reorder(fault, i, now, std::move(message));
      if (!is_of_messages(fault.spec.kind) || !FaultSchedule::strikes(fault, now, message.source, message.kind))
        continue;
      if (fault.spec.kind == FaultKind::loss) return;
      if (fault.spec.kind == FaultKind::repeat) {
        for (unsigned copy = 1; copy <= fault.spec.number; ++copy) {
          if (copies_left_ == 0) {
            ++overflowed_;
            break;
          }
          --copies_left_;
          Outgoing<M> again = message;
          again.time = message.time + nanoseconds(fault.spec.seconds * copy);
          run(i + 1, now, std::move(again));
        }
        continue;
      }
      spoil(fault, now, message);
    }
    enqueue(std::move(message));
  }

  static bool is_of_messages(FaultKind kind) {
    switch (kind) {
      case FaultKind::loss:
      case FaultKind::delay:
      case FaultKind::repeat:
      case FaultKind::corrupt:
      case FaultKind::wrong_id:
      case FaultKind::wrong_length:
      case FaultKind::burst:
        return true;
      default:
        return false;
    }
  }

  static void spoil(ScheduledFault& fault, Timestamp now, Outgoing<M>& message) {
    const FaultSpec& spec = fault.spec;
    switch (spec.kind) {
      case FaultKind::delay:
        message.time =
            std::max(message.time, now) + nanoseconds(spec.seconds + spec.jitter_s * fault.random.fraction());
        break;
      case FaultKind::burst: {
        const std::int64_t period = std::max<std::int64_t>(nanoseconds(spec.seconds).count(), 1);
        const std::int64_t gone = (std::max(message.time, now) - fault.from).count();
        message.time = fault.from + Nanoseconds((gone / period + 1) * period);
        break;
      }
      case FaultKind::corrupt:
        FaultTraits<M>::flip_bits(message.message, spec.number, fault.random);
        break;
      case FaultKind::wrong_id:
        FaultTraits<M>::change_identity(message.message, spec.id, fault.random);
        break;
      case FaultKind::wrong_length:
        FaultTraits<M>::change_length(message.message, spec.change);
        break;
      default:
        break;
    }
  }

  void reorder(ScheduledFault& fault, std::size_t i, Timestamp now, Outgoing<M> message) {
    if (held_.size() < kMostHeld && FaultSchedule::strikes(fault, now, message.source, message.kind)) {
      held_.push_back({fault.id, fault.spec.number, now + kLongestHold, std::move(message)});
      return;
    }
    const int id = fault.id;
    const int robot = message.source.robot;
    const Timestamp time = message.time;
    run(i + 1, now, std::move(message));
    for (Held& held : held_) {
      if (held.fault == id && held.message.source.robot == robot && held.to_pass > 0) --held.to_pass;
    }
    for (;;) {
      const auto free = std::find_if(held_.begin(), held_.end(),
                                     [id](const Held& held) { return held.fault == id && held.to_pass == 0; });
      if (free == held_.end()) return;
      Outgoing<M> released = std::move(free->message);
      held_.erase(free);
      released.time = std::max(released.time, time);
      run(i + 1, now, std::move(released));
    }
  }

  void release_overdue(Timestamp now) {
    std::erase_if(held_, [&](Held& held) {
      if (held.latest > now) return false;
      enqueue(std::move(held.message));
      return true;
    });
  }

  void insert(ScheduledFault& fault, Timestamp now) {
    const Nanoseconds period = std::max(nanoseconds(1.0 / fault.spec.rate_hz), Nanoseconds(1));
    for (int n = 0; n < kMostInsertionsAtOnce && fault.next_insertion <= now && fault.in_force(fault.next_insertion);
         ++n) {
      enqueue(
          {fault.next_insertion, Source{}, MessageKind::foreign, FaultTraits<M>::foreign(fault.spec.id, fault.random)});
      ++fault.applied;
      fault.next_insertion = fault.next_insertion + period;
    }
  }

  bool bus_is_off(ScheduledFault& fault, Timestamp now, std::vector<Outgoing<M>>& out) {
    if constexpr (requires { FaultTraits<M>::bus_off(); }) {
      if (!fault.began && fault.in_force(now)) {
        fault.began = true;
        out.push_back({now, Source{}, MessageKind::bus_error, FaultTraits<M>::bus_off()});
      } else if (fault.began && now >= fault.until) {
        fault.began = false;
        fault.from = kNeverEnds;  // over for good
        out.push_back({now, Source{}, MessageKind::bus_error, FaultTraits<M>::bus_restarted()});
      }
      return fault.began;
    } else {
      return false;
    }
  }

  void count_bus_off() {
    for (ScheduledFault& fault : schedule_.all()) {
      if (fault.spec.kind == FaultKind::bus_off && fault.began) ++fault.applied;
    }
  }

  std::size_t ended(const std::vector<ScheduledFault>& removed, Timestamp now) {
    for (const ScheduledFault& fault : removed) {
      for (Held& held : held_) {
        if (held.fault == fault.id) held.latest = now;
      }
      if constexpr (requires { FaultTraits<M>::bus_restarted(); }) {
        if (fault.began) enqueue({now, Source{}, MessageKind::bus_error, FaultTraits<M>::bus_restarted()});
      }
    }
    return removed.size();
  }

  static Nanoseconds nanoseconds(double seconds) { return Nanoseconds(std::llround(seconds * 1e9)); }

  FaultSchedule schedule_;
  std::vector<Waiting> waiting_;  // a heap, earliest in front
  std::vector<Held> held_;        // messages that others have to pass
  std::uint64_t sequence_ = 0;
  std::uint64_t overflowed_ = 0;
  unsigned copies_left_ = kMostCopiesOfOne;  // of the message under way: repetitions of repetitions multiply
};

}  // namespace cellmirror::sim
