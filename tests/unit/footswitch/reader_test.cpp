// The watching thread, on a memory of this process.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <semaphore>
#include <thread>
#include <vector>

#include "drivers/footswitch/switch_reader.hpp"

namespace cellmirror::footswitch {
namespace {

constexpr std::chrono::seconds kLongEnough{20};

struct Watched {
  explicit Watched(std::size_t bytes, Nanoseconds debounce = Nanoseconds(0)) : memory(bytes) {
    sut = std::make_unique<SwitchReader>(
        memory, clock, SwitchReader::Options{.debounce = debounce, .wake = [this] { woken.release(); }});
  }
  void write(std::size_t byte, std::uint8_t value) {
    __atomic_store_n(reinterpret_cast<std::uint8_t*>(&memory[byte]), value, __ATOMIC_RELAXED);
  }
  bool next(SwitchEdge& edge) {
    while (!sut->next(edge)) {
      if (!woken.try_acquire_for(kLongEnough)) return false;
    }
    return true;
  }

  SystemClock clock;
  std::vector<std::byte> memory;
  std::counting_semaphore<> woken{0};
  std::unique_ptr<SwitchReader> sut;
};

TEST(SwitchReader, HandsOnEveryChangeInOrderAndWakesItsOwner) {
  Watched watched(2);
  for (int round = 0; round < 20; ++round) {
    SwitchEdge edge;
    watched.write(1, 0x10);
    ASSERT_TRUE(watched.next(edge));
    EXPECT_EQ(edge.input, 13U);
    EXPECT_TRUE(edge.on);
    EXPECT_EQ(watched.sut->inputs_on(8), std::vector<std::uint32_t>{13});
    watched.write(1, 0);
    ASSERT_TRUE(watched.next(edge));
    EXPECT_EQ(edge.input, 13U);
    EXPECT_FALSE(edge.on);
  }
  EXPECT_EQ(watched.sut->counters().edges, 40U);
  EXPECT_EQ(watched.sut->counters().dropped, 0U);
}

TEST(SwitchReader, AnInputThatIsOnFromTheStartIsShownButNoChange) {
  std::vector<std::byte> memory{std::byte{0x81}};
  const SystemClock clock;
  SwitchReader sut(memory, clock, {});
  EXPECT_EQ(sut.inputs_on(8), (std::vector<std::uint32_t>{1, 8}));
  EXPECT_EQ(sut.inputs_on(1), std::vector<std::uint32_t>{1});
  SwitchEdge edge;
  EXPECT_FALSE(sut.next(edge));
}

TEST(SwitchReader, LooksAtTheFirstBytesOfALargeMemoryOnly) {
  Watched watched(kMostSwitchBytes + 100);
  watched.write(kMostSwitchBytes, 0xff);
  watched.write(kMostSwitchBytes - 1, 0x80);
  SwitchEdge edge;
  ASSERT_TRUE(watched.next(edge));
  EXPECT_EQ(edge.input, 8 * kMostSwitchBytes);
  EXPECT_FALSE(watched.sut->next(edge));
}

TEST(SwitchReader, HandsOnWhatChangedJustBeforeItsEnd) {
  for (int round = 0; round < 20; ++round) {
    Watched watched(1);
    SwitchEdge edge;
    watched.write(0, 1);
    ASSERT_TRUE(watched.next(edge));
    watched.write(0, 0);
    watched.sut->stop();
    const SwitchReader::Counters last = watched.sut->counters();
    EXPECT_EQ(last.edges, 2U);
    ASSERT_TRUE(watched.sut->next(edge));
    EXPECT_FALSE(edge.on);
    watched.write(0, 1);
    EXPECT_FALSE(watched.sut->next(edge));
    EXPECT_EQ(watched.sut->counters().looks, last.looks) << "nobody watches any more";
  }
}

TEST(SwitchReader, CountsWhatItsOwnerDidNotTakeInTime) {
  Watched watched(kMostSwitchBytes);
  std::uint8_t value = 0;
  const auto until = std::chrono::steady_clock::now() + kLongEnough;
  while (watched.sut->counters().dropped == 0 && std::chrono::steady_clock::now() < until) {
    value = static_cast<std::uint8_t>(~value);
    for (std::size_t i = 0; i < kMostSwitchBytes; ++i) watched.write(i, value);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_GT(watched.sut->counters().dropped, 0U);
  EXPECT_EQ(watched.sut->counters().edges, kEdgeQueue);
}

}  // namespace
}  // namespace cellmirror::footswitch
