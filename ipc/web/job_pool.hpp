// Threads for work that would block the server's thread for too long.
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
  // Drops waiting jobs; waits for those that run.
  ~JobPool();
  JobPool(const JobPool&) = delete;
  JobPool& operator=(const JobPool&) = delete;

  // False, at once, if too many wait.
  [[nodiscard]] bool submit(std::function<void()> job);
  // Ahead of all waiting jobs, however many there are: for the live document. False: the pool ends.
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
