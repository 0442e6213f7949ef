#include "drivers/footswitch/switch_reader.hpp"

#include <time.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "ipc/wire/shared_words.hpp"
#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::footswitch {

namespace {

constexpr std::size_t kSwitchBits = 8;

std::span<const std::byte> looked_at(std::span<const std::byte> memory) {
  return memory.first(std::min(memory.size(), kMostSwitchBytes));
}

void sleep_until(Timestamp time) {
  const timespec until{static_cast<time_t>(time.ns / 1'000'000'000), static_cast<long>(time.ns % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) != 0) {
  }
}

}  // namespace

void copy_shared_bytes(std::span<const std::byte> from, std::span<std::uint8_t> to) {
  const std::size_t count = std::min(from.size(), to.size());
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = shared_words::load<std::uint8_t>(from, i);
  }
}

class SwitchReader::Thread {
 public:
  explicit Thread(SwitchReader& reader)
      : thread_([&reader](const std::stop_token& stop) {
          set_thread_name("switches");
          if (reader.options_.priority > 0)
            static_cast<void>(set_real_time_scheduling(RealTimePolicy::prefer, reader.options_.priority));
          const Clock& clock = reader.clock_;
          Timestamp next = clock.now();
          while (!stop.stop_requested()) {
            const Timestamp now = clock.now();
            reader.look(now);
            // After a pause of the machine missed readings are not repeated.
            next = std::max(next + reader.options_.period, now);
            sleep_until(next);
          }
        }) {}

 private:
  std::jthread thread_;
};

SwitchReader::SwitchReader(std::span<const std::byte> memory, const Clock& clock, Options options)
    : memory_(looked_at(memory)),
      clock_(clock),
      options_(std::move(options)),
      edges_(memory_.size(), options_.debounce),
      copy_(memory_.size()) {
  found_.reserve(2 * kSwitchBits * memory_.size());
  // The first state is that of this moment, whenever the thread gets its first turn.
  look(clock_.now());
  thread_ = std::make_unique<Thread>(*this);
}

SwitchReader::~SwitchReader() = default;

void SwitchReader::stop() {
  thread_.reset();
  options_.wake = {};  // the owner is here
  look(clock_.now());
}

void SwitchReader::look(Timestamp now) {
  copy_shared_bytes(memory_, copy_);
  found_.clear();
  edges_.look(copy_, now, found_);
  const bool first = looks_.fetch_add(1, std::memory_order_relaxed) == 0;
  bounces_.store(edges_.bounces(), std::memory_order_relaxed);
  if (found_.empty() && !first) return;
  for (const SwitchEdge& edge : found_) queue_.push(edge);
  std::copy_n(edges_.reported().begin(), memory_.size(), reported_.writable().begin());  // the rest is 0 for ever
  reported_.publish();
  if (!found_.empty() && options_.wake) options_.wake();
}

SwitchReader::Counters SwitchReader::counters() const {
  return {looks_.load(std::memory_order_relaxed), queue_.pushed(), queue_.dropped(),
          bounces_.load(std::memory_order_relaxed)};
}

std::vector<std::uint32_t> SwitchReader::inputs_on(std::size_t most) {
  std::vector<std::uint32_t> inputs;
  const Inputs& reported = reported_.read().value;
  for (std::size_t i = 0; i < memory_.size(); ++i) {
    const std::uint8_t byte = reported[i];
    for (std::size_t bit = 0; bit < kSwitchBits && inputs.size() < most; ++bit) {
      if (((byte >> bit) & 1U) != 0) inputs.push_back(static_cast<std::uint32_t>(i * kSwitchBits + bit + 1));
    }
  }
  return inputs;
}

}  // namespace cellmirror::footswitch
