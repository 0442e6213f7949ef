#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "rt_core/rt/fifo.hpp"
#include "tests/stress/rt/patterned.hpp"

namespace cellmirror {
namespace {

// Looks again at once for a while: to yield at every turn hands the processor to whatever else the machine does, a time
// slice for each value.
class Patience {
 public:
  void wait() {
    if (++turns_ % kTurnsBeforeYielding == 0) {
      std::this_thread::yield();
    }
  }

 private:
  static constexpr std::uint64_t kTurnsBeforeYielding = 10'000;
  std::uint64_t turns_ = 0;
};

template <std::size_t Capacity>
void nothing_is_lost_where_the_producer_tries_again() {
  const auto sut = std::make_unique<Fifo<Patterned, Capacity>>();
  constexpr std::uint64_t kValues =
      Capacity > 1 ? kOperations : kOperations / 10;  // capacity 1: both threads wait for each value
  std::uint64_t refused = 0;
  std::thread producer([&] {
    Patience patience;
    for (std::uint64_t n = 1; n <= kValues; ++n) {
      const Patterned value = Patterned::of(n);
      while (!sut->push(value)) {
        ++refused;
        patience.wait();
      }
    }
  });
  std::uint64_t wrong = 0;
  Patterned value;
  Patience patience;
  for (std::uint64_t n = 1; n <= kValues; ++n) {
    while (!sut->pop(value)) {
      patience.wait();
    }
    wrong += value.number == n && value.whole() ? 0 : 1;
  }
  producer.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_FALSE(sut->pop(value));
  EXPECT_EQ(sut->pushed(), kValues);
  EXPECT_EQ(sut->dropped(), refused);
  EXPECT_LE(sut->high_water(), Capacity);
}

TEST(FifoStress, NothingIsLostCapacity1) { nothing_is_lost_where_the_producer_tries_again<1>(); }
TEST(FifoStress, NothingIsLostCapacity7) { nothing_is_lost_where_the_producer_tries_again<7>(); }
TEST(FifoStress, NothingIsLostCapacity1024) { nothing_is_lost_where_the_producer_tries_again<1024>(); }

TEST(FifoStress, WhatIsDroppedIsCountedAndTheRestKeepsItsOrder) {
  const auto sut = std::make_unique<Fifo<Patterned, 16>>();
  std::atomic<bool> done{false};
  std::uint64_t refused = 0;
  std::thread producer([&] {
    for (std::uint64_t n = 1; n <= kOperations; ++n) {
      refused += sut->push(Patterned::of(n)) ? 0 : 1;
    }
    done.store(true, std::memory_order_release);
  });
  std::uint64_t wrong = 0;
  std::uint64_t popped = 0;
  std::uint64_t last = 0;
  Patterned value;
  for (bool more = true; more;) {
    more = !done.load(std::memory_order_acquire);
    while (sut->pop(value)) {
      wrong += value.number > last && value.whole() ? 0 : 1;
      last = value.number;
      ++popped;
    }
  }
  producer.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(sut->dropped(), refused);
  EXPECT_EQ(popped + refused, kOperations);
  EXPECT_EQ(sut->pushed(), popped);
}

}  // namespace
}  // namespace cellmirror
