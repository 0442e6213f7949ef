// Threads for work that has to give way to everything else: in the idle class of the scheduler (SCHED_IDLE).
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace cellmirror::volume {

class IdleWorkers {
 public:
  // Threads beside the calling one, at most 64; none where less than 1 is asked for. A thread that the system refuses
  // is left out.
  explicit IdleWorkers(int threads);
  ~IdleWorkers();
  IdleWorkers(const IdleWorkers&) = delete;
  IdleWorkers& operator=(const IdleWorkers&) = delete;

  // Calls work(i) once for each i below count, on the threads and the calling one, in any order; returns when all are
  // done. `work` does not throw. One caller at a time.
  void run(std::size_t count, const std::function<void(std::size_t)>& work);
  [[nodiscard]] std::size_t threads() const { return threads_.size(); }

 private:
  void serve();
  void take_all();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  std::uint64_t round_ = 0;
  std::size_t busy_ = 0;
  bool ended_ = false;
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t count_ = 0;
  std::atomic<std::uint64_t> next_{0};  // relaxed: the mutex orders what the work reads and writes
  std::vector<std::thread> threads_;
};

}  // namespace cellmirror::volume
