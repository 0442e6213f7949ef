#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/sandbox/sandbox.hpp"

namespace cellmirror {

// A sandbox around sandbox_probe.
class ProbeSandbox {
 public:
  ProbeSandbox()
      : sandbox({.program = "sandbox_probe",
                 .subject = "a test",
                 .channel = {.to_child_bytes = 1U << 14U, .to_owner_bytes = 1U << 14U, .longest_message = 1U << 10U},
                 .memory_bytes = 64ULL << 20U,
                 .most_fruitless_s = 1.5},
                {.started = [this] { count(starts_); },
                 .received =
                     [this](std::span<const std::byte> message) {
                       const std::scoped_lock lock(mutex_);
                       answers_.emplace_back(reinterpret_cast<const char*>(message.data()), message.size());
                       changed_.notify_all();
                       return answers_.back() != "not allowed";
                     },
                 .ended =
                     [this](const std::string& why) {
                       const std::scoped_lock lock(mutex_);
                       ends_.push_back(why);
                       changed_.notify_all();
                     },
                 .stopping = {}},
                "probe") {}

  bool tell(std::string_view what) { return sandbox.send(std::as_bytes(std::span(what))); }
  // The answer to what is told; empty: there was none within a minute.
  std::string ask(std::string_view what) {
    const std::size_t before = [&] {
      const std::scoped_lock lock(mutex_);
      return answers_.size();
    }();
    if (!tell(what)) return {};
    return wait([&] { return answers_.size() > before; }) ? answers_[before] : std::string();
  }
  // The reason of the n-th end (from 1); empty: there was none within a minute.
  std::string end(std::size_t n) {
    return wait([&] { return ends_.size() >= n; }) ? ends_[n - 1] : std::string();
  }
  bool started(int n) {
    return wait([&] { return starts_ >= n; });
  }

 private:
  template <class Condition>
  bool wait(const Condition& condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::minutes(1), condition);
  }
  void count(int& counter) {
    const std::scoped_lock lock(mutex_);
    ++counter;
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> answers_;
  std::vector<std::string> ends_;
  int starts_ = 0;

 public:
  Sandbox sandbox;  // last: its thread calls the above
};

}  // namespace cellmirror
