// Leases between threads, also under ThreadSanitizer.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <utility>

#include "rt_core/rt/fifo.hpp"
#include "rt_core/rt/lease.hpp"

namespace cellmirror {
namespace {

struct Number {
  explicit Number(int n, std::atomic<int>& alive_now) : value(n), alive(&alive_now) { alive->fetch_add(1); }
  ~Number() {
    value = -1;
    alive->fetch_sub(1);
  }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;
  int value;
  std::atomic<int>* alive;
};

// The owner lends and collects; the user holds a few leases at a time. Where the queue is full the owner ends the lease
// itself, so that two threads give back at once.
TEST(LeaseConcurrency, EveryObjectIsFreedOnceAndNoneWhileItIsUsed) {
  constexpr int kObjects = 5'000;
  std::atomic<int> alive{0};
  Lender sut;
  Fifo<Lease<const Number>, 16> queue;
  std::atomic<bool> done{false};
  int wrong = 0;
  int used = 0;
  std::thread user([&] {
    Lease<const Number> before;
    Lease<const Number> lease;
    for (bool more = true; more;) {
      more = !done.load(std::memory_order_acquire);
      while (queue.pop(lease)) {
        ++used;
        wrong += lease->value >= 0 ? 0 : 1;
        if (before) wrong += before->value < lease->value ? 0 : 1;
        before = std::move(lease);
      }
    }
  });
  int refused = 0;
  for (int i = 0; i < kObjects; ++i) {
    Lease<const Number> lease = sut.lend(std::shared_ptr<const Number>(std::make_shared<Number>(i, alive)));
    if (!queue.push_from(lease)) {
      ++refused;
      lease.give_back();
      std::this_thread::yield();
    }
    sut.collect();
  }
  done.store(true, std::memory_order_release);
  user.join();
  sut.collect();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(used + refused, kObjects);
  EXPECT_GT(used, 0);
  EXPECT_EQ(sut.outstanding(), 0U);
  EXPECT_EQ(alive.load(), 0);
}

}  // namespace
}  // namespace cellmirror
