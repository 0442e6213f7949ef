// Threads for what takes longer than the server's thread may be held up.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace cellmirror::web {

class JobPool {
 public:
  static constexpr std::size_t kMostWaiting = 32;

  explicit JobPool(std::size_t threads);
  // Jobs that wait are forgotten; those under way end first.
  ~JobPool();
  JobPool(const JobPool&) = delete;
  JobPool& operator=(const JobPool&) = delete;

  // False, at once, where too many wait.
  [[nodiscard]] bool submit(std::function<void()> job);
  // Before all that wait, however many these are: for the one job that everybody waits for. False: the pool ends.
  [[nodiscard]] bool submit_first(std::function<void()> job);

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace cellmirror::web
