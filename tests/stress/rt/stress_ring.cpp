#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include "rt_core/rt/ring.hpp"
#include "tests/stress/rt/patterned.hpp"

namespace cellmirror {
namespace {

constexpr std::size_t kCapacity = 64;
using PatternedRing = Ring<Patterned, kCapacity>;

struct Tally {
  std::uint64_t wrong = 0;
  std::uint64_t copied = 0;
  std::uint64_t copies = 0;
};

Tally read_until(const PatternedRing& sut, const std::atomic<bool>& done) {
  Tally tally;
  std::vector<Patterned> entries(kCapacity);
  std::uint64_t newest = 0;
  for (bool more = true; more;) {
    more = !done.load(std::memory_order_acquire);
    const std::size_t count = sut.newest(std::span<Patterned>(entries));
    for (std::size_t i = 0; i < count; ++i) {
      const bool in_order = i == 0 || entries[i].number == entries[i - 1].number + 1;
      tally.wrong += in_order && entries[i].number != 0 && entries[i].whole() ? 0 : 1;
    }
    if (count > 0) {
      tally.wrong += entries[count - 1].number >= newest ? 0 : 1;
      newest = entries[count - 1].number;
    }
    tally.copied += count;
    ++tally.copies;
  }
  return tally;
}

TEST(RingStress, CopiesMadeMeanwhileHoldOnlyWholeEntriesInOrder) {
  const auto sut = std::make_unique<PatternedRing>();
  for (std::uint64_t n = 1; n <= kCapacity; ++n) {
    sut->push(Patterned::of(n));
  }
  std::atomic<bool> done{false};
  Tally first;
  Tally second;
  std::thread first_reader([&] { first = read_until(*sut, done); });
  std::thread second_reader([&] { second = read_until(*sut, done); });
  for (std::uint64_t n = kCapacity + 1; n <= kOperations; ++n) {
    sut->push(Patterned::of(n));
  }
  done.store(true, std::memory_order_release);
  first_reader.join();
  second_reader.join();
  EXPECT_EQ(first.wrong + second.wrong, 0U);
  EXPECT_GE(first.copied + second.copied + sut->torn(), (first.copies + second.copies) * kCapacity)
      << "each entry asked for was either copied or counted as torn (more than once where a copy began anew)";
  EXPECT_GT(first.copied, 0U);
  EXPECT_GT(second.copied, 0U);
  const auto last = sut->newest();
  ASSERT_EQ(last.size(), kCapacity);
  EXPECT_EQ(last.back().number, kOperations);
  EXPECT_EQ(last.front().number, kOperations - kCapacity + 1);
  RecordProperty("torn", std::to_string(sut->torn()));
}

}  // namespace
}  // namespace cellmirror
