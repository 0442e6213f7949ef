#include "ipc/web/job_pool.hpp"

#include <utility>

#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::web {

JobPool::JobPool(std::size_t threads) {
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

JobPool::~JobPool() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
    jobs_.clear();
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool JobPool::submit(std::function<void()> job) {
  {
    const std::scoped_lock lock(mutex_);
    if (stopping_ || jobs_.size() >= kMostWaiting) return false;
    jobs_.push_back(std::move(job));
  }
  changed_.notify_one();
  return true;
}

bool JobPool::submit_first(std::function<void()> job) {
  {
    const std::scoped_lock lock(mutex_);
    if (stopping_) return false;
    jobs_.push_front(std::move(job));
  }
  changed_.notify_one();
  return true;
}

void JobPool::work() {
  set_thread_name("web-work");
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (stopping_) return;
    const std::function<void()> job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    job();
    lock.lock();
  }
}

}  // namespace cellmirror::web
