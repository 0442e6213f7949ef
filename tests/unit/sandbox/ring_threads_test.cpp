#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstring>
#include <thread>

#include "rt_core/rt/shared_message_ring.hpp"

namespace cellmirror {
namespace {

// The wake-ups of a Channel, with an atomic in place of its socket.
TEST(SharedMessageRingThreads, NoMessageIsLeftBehindWhileItsReaderSleeps) {
  constexpr std::uint64_t kMessages = 200'000;
  constexpr std::size_t kCapacity = 1024;
  alignas(SharedRingHeader::kLine) static std::array<std::byte, shared_ring_bytes(kCapacity)> memory{};
  std::atomic<int> wakes{0};
  std::thread producer([&] {
    SharedRingWriter writer(memory);
    for (std::uint64_t i = 0; i < kMessages;) {
      if (writer.write(std::as_bytes(std::span(&i, 1))) != RingResult::done) {
        std::this_thread::yield();
        continue;
      }
      ++i;
      if (writer.reader_sleeps()) {
        wakes.fetch_add(1, std::memory_order_release);
        wakes.notify_one();
      }
    }
  });
  SharedRingReader reader(memory);
  std::vector<std::byte> got;
  for (std::uint64_t expected = 0; expected < kMessages;) {
    if (reader.read(got, kCapacity) == RingResult::done) {
      std::uint64_t value = 0;
      ASSERT_EQ(got.size(), sizeof value);
      std::memcpy(&value, got.data(), sizeof value);
      ASSERT_EQ(value, expected++);
      continue;
    }
    const int before = wakes.load(std::memory_order_acquire);
    if (reader.prepare_to_sleep()) wakes.wait(before, std::memory_order_acquire);  // for ever, if a wake were lost
    reader.awake();
  }
  producer.join();
}

}  // namespace
}  // namespace cellmirror
