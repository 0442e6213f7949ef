#include "app/gateway/program_reader.hpp"

#include <utility>

#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

void ProgramReader::read(std::uint64_t id, const program::Language& language, std::filesystem::path path) {
  {
    const std::scoped_lock lock(mutex_);
    orders_.push_back({id, &language, std::move(path)});
  }
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
  ordered_.notify_one();
}

void ProgramReader::forget(std::uint64_t id) {
  const std::scoped_lock lock(mutex_);
  std::erase_if(orders_, [&](const Order& order) { return order.id == id; });
}

std::optional<ProgramReader::Read> ProgramReader::take() {
  const std::scoped_lock lock(mutex_);
  if (read_.empty()) return std::nullopt;
  std::optional<Read> next = std::move(read_.front());
  read_.pop_front();
  return next;
}

void ProgramReader::loop(const std::stop_token& stop) {
  set_thread_name("programs");
  std::unique_lock lock(mutex_);
  while (ordered_.wait(lock, stop, [this] { return !orders_.empty(); }) && !stop.stop_requested()) {
    const Order order = std::move(orders_.front());
    orders_.pop_front();
    lock.unlock();
    Read read = {order.id, read_program(home_, *order.language, order.path)};
    lock.lock();
    read_.push_back(std::move(read));
  }
}

}  // namespace cellmirror::app
