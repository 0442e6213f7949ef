#include "rt_core/rt/shared_message_ring.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>

namespace cellmirror {
namespace {

constexpr std::size_t kCapacity = 256;

class SharedMessageRing : public testing::Test {
 protected:
  [[nodiscard]] std::span<std::byte> memory() { return memory_; }
  SharedRingHeader& header() { return *reinterpret_cast<SharedRingHeader*>(memory_.data()); }
  static std::vector<std::byte> message(std::size_t size, int value) {
    return std::vector<std::byte>(size, static_cast<std::byte>(value));
  }
  RingResult read() { return reader_.read(got_, kCapacity); }

  alignas(SharedRingHeader::kLine) std::array<std::byte, shared_ring_bytes(kCapacity)> memory_{};
  SharedRingWriter writer_{memory_};
  SharedRingReader reader_{memory_};
  std::vector<std::byte> got_;
};

TEST_F(SharedMessageRing, BringsMessagesInOrderWithTheirBytes) {
  for (int round = 0; round < 1000; ++round) {
    const auto sent = message(static_cast<std::size_t>(round % 100), round);
    ASSERT_EQ(writer_.write(sent), RingResult::done);
    ASSERT_EQ(read(), RingResult::done);
    ASSERT_EQ(got_, sent) << round;
  }
  EXPECT_EQ(read(), RingResult::none);
}

TEST_F(SharedMessageRing, JoinsHeadAndBody) {
  ASSERT_EQ(writer_.write(message(3, 1), message(5, 2)), RingResult::done);
  ASSERT_EQ(read(), RingResult::done);
  ASSERT_EQ(got_.size(), 8U);
  EXPECT_EQ(got_[2], std::byte{1});
  EXPECT_EQ(got_[3], std::byte{2});
}

TEST_F(SharedMessageRing, RefusesWhenFullAndLosesNothing) {
  int written = 0;
  while (writer_.write(message(20, written)) == RingResult::done) ++written;
  EXPECT_EQ(written, 8);
  for (int i = 0; i < written; ++i) {
    ASSERT_EQ(read(), RingResult::done);
    ASSERT_EQ(got_, message(20, i));
  }
}

TEST_F(SharedMessageRing, AsksForAWakeOnceForEachSleep) {
  EXPECT_FALSE(writer_.reader_sleeps());
  ASSERT_TRUE(reader_.prepare_to_sleep());
  ASSERT_EQ(writer_.write(message(1, 1)), RingResult::done);
  EXPECT_TRUE(writer_.reader_sleeps());
  EXPECT_FALSE(writer_.reader_sleeps());
  EXPECT_FALSE(reader_.prepare_to_sleep()) << "a message is there";
}

TEST_F(SharedMessageRing, ReportsAFalseLengthToItsReader) {
  ASSERT_EQ(writer_.write(message(16, 1)), RingResult::done);
  for (const std::uint64_t length :
       {std::uint64_t{17}, std::uint64_t{kCapacity + 1}, ~std::uint64_t{0}, ~std::uint64_t{7}}) {
    std::memcpy(memory_.data() + sizeof(SharedRingHeader), &length, sizeof length);
    EXPECT_EQ(read(), RingResult::damaged) << length;
  }
}

TEST_F(SharedMessageRing, ReportsAFalseCountToItsReader) {
  for (const std::uint64_t written : {std::uint64_t{1}, std::uint64_t{kCapacity + 1}, ~std::uint64_t{0}}) {
    header().written.store(written);
    EXPECT_EQ(read(), RingResult::damaged) << written;
  }
}

TEST_F(SharedMessageRing, ReportsAFalseCountToItsWriter) {
  ASSERT_EQ(writer_.write(message(16, 1)), RingResult::done);
  header().read.store(1000);
  EXPECT_EQ(writer_.write(message(16, 1)), RingResult::damaged);
  header().read.store(0);
  ASSERT_EQ(writer_.write(message(16, 1)), RingResult::done);
  ASSERT_EQ(read(), RingResult::done);
  ASSERT_EQ(writer_.write(message(16, 1)), RingResult::done);
  header().read.store(0);
  EXPECT_EQ(writer_.write(message(16, 1)), RingResult::damaged) << "a count that goes back";
}

TEST_F(SharedMessageRing, StaysWithinItsMemoryWhateverIsWrittenThere) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 20'000; ++round) {
    const std::size_t at = random() % memory_.size();
    memory_[at] = static_cast<std::byte>(random());
    static_cast<void>(read());
    static_cast<void>(writer_.write(message(random() % 64, round)));
    ASSERT_LE(got_.size(), kCapacity);
  }
}

}  // namespace
}  // namespace cellmirror
