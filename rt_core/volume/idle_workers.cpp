#include "rt_core/volume/idle_workers.hpp"

#include <sched.h>

#include <algorithm>
#include <system_error>

namespace cellmirror::volume {

namespace {

constexpr int kMostThreads = 64;

void enter_idle_class() {
  const sched_param parameters{};
  // Refused in some containers; then it competes with the others.
  static_cast<void>(sched_setscheduler(0, SCHED_IDLE, &parameters));
}

}  // namespace

IdleWorkers::IdleWorkers(int threads) {
  for (int i = 0; i < std::min(threads, kMostThreads); ++i) {
    try {
      threads_.emplace_back([this] {
        enter_idle_class();
        serve();
      });
    } catch (const std::system_error&) {
      return;
    }
  }
}

IdleWorkers::~IdleWorkers() {
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void IdleWorkers::take_all() {
  for (std::uint64_t i = next_.fetch_add(1, std::memory_order_relaxed); i < count_;
       i = next_.fetch_add(1, std::memory_order_relaxed))
    (*work_)(i);
}

void IdleWorkers::serve() {
  std::uint64_t served = 0;
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return ended_ || (round_ != served && work_ != nullptr); });
    if (ended_) return;
    served = round_;
    ++busy_;
    lock.unlock();
    take_all();
    lock.lock();
    if (--busy_ == 0) done_.notify_one();
  }
}

void IdleWorkers::run(std::size_t count, const std::function<void(std::size_t)>& work) {
  {
    const std::scoped_lock lock(mutex_);
    work_ = &work;
    count_ = count;
    next_.store(0, std::memory_order_relaxed);
    ++round_;
  }
  if (count > 1) wake_.notify_all();
  take_all();
  std::unique_lock lock(mutex_);
  work_ = nullptr;  // who wakes up only now finds nothing to do
  done_.wait(lock, [&] { return busy_ == 0; });
}

}  // namespace cellmirror::volume
