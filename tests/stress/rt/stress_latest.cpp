#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "rt_core/rt/latest.hpp"
#include "tests/stress/rt/patterned.hpp"

namespace cellmirror {
namespace {

void readings_are_whole_and_never_go_back(bool in_place) {
  const auto sut = std::make_unique<Latest<Patterned>>();
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t n = 1; n <= kOperations; ++n) {
      if (in_place) {
        sut->writable().fill(n);
        sut->publish();
      } else {
        sut->write(Patterned::of(n));
      }
    }
    done.store(true, std::memory_order_release);
  });
  std::uint64_t wrong = 0;
  std::uint64_t taken = 0;
  std::uint64_t last = 0;
  for (bool more = true; more;) {
    more = !done.load(std::memory_order_acquire);
    const auto reading = sut->read();
    // Twice: it has to stay as it is while the writer goes on.
    for (int look = 0; look < 2; ++look) {
      wrong += reading.value.whole() && reading.value.number == reading.sequence ? 0 : 1;
    }
    wrong += reading.is_new == (reading.sequence > last) && reading.sequence >= last ? 0 : 1;
    taken += reading.is_new ? 1 : 0;
    last = reading.sequence;
  }
  writer.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(last, kOperations) << "the last publication is not forgotten";
  EXPECT_EQ(sut->published(), kOperations);
  EXPECT_EQ(sut->overwritten() + taken, kOperations) << "each value was either read or counted";
}

TEST(LatestStress, CopiedValuesAreWholeAndNeverGoBack) { readings_are_whole_and_never_go_back(false); }
TEST(LatestStress, ValuesFilledInPlaceAreWholeAndNeverGoBack) { readings_are_whole_and_never_go_back(true); }

}  // namespace
}  // namespace cellmirror
