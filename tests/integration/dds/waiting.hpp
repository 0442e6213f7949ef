// Waiting for what other threads and processes do, with a generous end.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "rt_core/ports/joint_stream.hpp"

namespace cellmirror::dds::test {

inline constexpr std::chrono::seconds kObserverTimeout{60};

// Asks every few milliseconds until `done()` holds; false where patience ended first.
template <class Done>
bool eventually(Done done) {
  const auto end = std::chrono::steady_clock::now() + kObserverTimeout;
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

// Keeps what a stream pushes.
class CollectingSink final : public JointSampleSink {
 public:
  bool push(const JointSample& sample) noexcept override {
    const std::scoped_lock lock(mutex_);
    samples_.push_back(sample);
    return true;
  }
  [[nodiscard]] std::vector<JointSample> samples() const {
    const std::scoped_lock lock(mutex_);
    return samples_;
  }
  [[nodiscard]] std::size_t size() const {
    const std::scoped_lock lock(mutex_);
    return samples_.size();
  }

 private:
  mutable std::mutex mutex_;
  std::vector<JointSample> samples_;
};

}  // namespace cellmirror::dds::test
