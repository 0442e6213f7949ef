#include "app/owner/programs/program_reader.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "rt_core/rt/scheduling.hpp"

namespace cellmirror::app {

Result<void> ProgramReader::read(std::uint64_t id, const program::Language& language, std::filesystem::path path) {
  if (auto started = start_thread(); !started) return started;
  {
    const std::scoped_lock lock(mutex_);
    orders_.push_back({id, &language, std::move(path)});
  }
  ordered_.notify_one();
  return {};
}

Result<void> ProgramReader::start_thread() {
  if (thread_.joinable()) return {};
  try {
    thread_ = std::jthread([this](const std::stop_token& stop) { loop(stop); });
  } catch (const std::exception& error) {
    return fail(fmt::format("the thread that reads long robot programs cannot be started: {}", error.what()),
                "end other programs, or raise the limits on threads and memory (`ulimit -a`), and load it again");
  }
  return {};
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
    Read read = {order.id, text_of(order)};
    lock.lock();
    read_.push_back(std::move(read));
  }
}

// Nobody catches what leaves a thread: the gateway would end.
ProgramText ProgramReader::text_of(const Order& order) const {
  try {
    return reading_(*order.language, order.path);
  } catch (const std::exception& error) {
    return {.program = fail(fmt::format("{} cannot be read: {}", order.path.string(), error.what()),
                            "free memory and load it again, or make several programs of it"),
            .findings = {}};
  }
}

}  // namespace cellmirror::app
