#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "rt_core/rt/broadcast.hpp"
#include "tests/stress/rt/patterned.hpp"

namespace cellmirror {
namespace {

struct BroadcastTally {
  std::uint64_t wrong = 0;
  std::uint64_t taken = 0;
  std::uint64_t last = 0;
};

BroadcastTally take_until(Broadcast<Patterned>::Reader& reader, const std::atomic<bool>& done) {
  BroadcastTally tally;
  for (bool more = true; more;) {
    more = !done.load(std::memory_order_acquire);
    const auto reading = reader.read();
    // Twice: it has to stay as it is while the writer goes on.
    for (int look = 0; look < 2; ++look) {
      tally.wrong += reading.value.whole() && reading.value.number == reading.sequence ? 0 : 1;
    }
    tally.wrong += reading.is_new == (reading.sequence > tally.last) && reading.sequence >= tally.last ? 0 : 1;
    tally.taken += reading.is_new ? 1 : 0;
    tally.last = reading.sequence;
  }
  return tally;
}

TEST(BroadcastStress, ReadingsOfSeveralReadersAreWholeAndNeverGoBack) {
  constexpr std::size_t kReaders = 3;
  Broadcast<Patterned> sut;
  std::array<Broadcast<Patterned>::Reader*, kReaders> readers{};
  for (auto& reader : readers) reader = &sut.subscribe();
  std::atomic<bool> done{false};
  std::array<BroadcastTally, kReaders> tallies;
  std::array<std::thread, kReaders> threads;
  for (std::size_t i = 0; i < kReaders; ++i)
    threads[i] = std::thread([&, i] { tallies[i] = take_until(*readers[i], done); });
  for (std::uint64_t n = 1; n <= kOperations; ++n) {
    sut.writable().fill(n);
    sut.publish();
  }
  done.store(true, std::memory_order_release);
  for (std::size_t i = 0; i < kReaders; ++i) {
    threads[i].join();
    EXPECT_EQ(tallies[i].wrong, 0U);
    EXPECT_EQ(tallies[i].last, kOperations) << "the last publication is not forgotten";
    EXPECT_EQ(readers[i]->overwritten() + tallies[i].taken, kOperations) << "each value was either read or counted";
  }
}

}  // namespace
}  // namespace cellmirror
