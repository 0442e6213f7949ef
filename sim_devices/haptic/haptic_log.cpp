#include "sim_devices/haptic/haptic_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <iterator>
#include <system_error>
#include <utility>

namespace cellmirror::sim {
namespace {

constexpr std::size_t kRowsAtOnce = 4096;
constexpr std::chrono::milliseconds kBetweenWrites{100};

}  // namespace

Result<std::unique_ptr<HapticLog>> HapticLog::make(const std::string& path, const AxisLayout& layout) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) {
    return fail(fmt::format("--log {}: {}", path, std::generic_category().message(errno)),
                "name a file in a folder that you may write to");
  }
  fmt::memory_buffer head;
  fmt::format_to(std::back_inserter(head), "time_ns,sequence,sample_time_ns,writer");
  for (const std::string_view name : layout.names()) fmt::format_to(std::back_inserter(head), ",{}", name);
  for (const std::string_view name : layout.names()) fmt::format_to(std::back_inserter(head), ",effort_{}", name);
  fmt::format_to(std::back_inserter(head),
                 ",force_sequence,force_time_ns,answers,phase,fault,force_n,torque_nm,struck\n");
  std::fwrite(head.data(), 1, head.size(), file);
  std::unique_ptr<HapticLog> log(new HapticLog(file, layout.count()));
  log->rows_.reserve(kRowsAtOnce);
  log->thread_ = std::thread([raw = log.get()] { raw->work(); });
  return log;
}

HapticLog::~HapticLog() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  wake_.notify_one();
  thread_.join();
  std::fclose(file_);
}

void HapticLog::add(const HapticLogRow& row) {
  const std::lock_guard lock(mutex_);
  rows_.push_back(row);
}

void HapticLog::flush() {
  std::unique_lock lock(mutex_);
  hurry_ = true;
  wake_.notify_one();
  written_.wait(lock, [this] { return rows_.empty() && !busy_; });
}

void HapticLog::work() {
  std::vector<HapticLogRow> taken;
  taken.reserve(kRowsAtOnce);
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait_for(lock, kBetweenWrites, [this] { return end_ || hurry_; });
    hurry_ = false;
    const bool last = end_;
    taken.swap(rows_);
    busy_ = true;
    lock.unlock();
    write(taken);
    taken.clear();
    lock.lock();
    busy_ = false;
    written_.notify_all();
    if (last && rows_.empty()) return;
  }
}

void HapticLog::write(const std::vector<HapticLogRow>& rows) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  for (const HapticLogRow& row : rows) {
    fmt::format_to(out, "{},{},{},{}", row.time_ns, row.sequence, row.sample_time_ns, row.writer);
    for (std::size_t i = 0; i < axes_; ++i) fmt::format_to(out, ",{:.9g}", row.axes[i]);
    for (std::size_t i = 0; i < axes_; ++i) fmt::format_to(out, ",{:.6g}", row.efforts[i]);
    fmt::format_to(out, ",{},{},{},{},{},{:.6g},{:.6g},{}\n", row.force_sequence, row.force_time_ns, row.answers,
                   row.phase, row.fault, row.force_n, row.torque_nm, row.struck);
  }
  std::fwrite(text.data(), 1, text.size(), file_);
  std::fflush(file_);
}

double force_size(const HapticOutput& output) { return std::max(output.force_D.norm(), output.force_E.norm()); }

double torque_size(const HapticOutput& output) {
  double largest = std::max(output.torque_D.norm(), std::abs(output.gripper_torque));
  for (const double torque : output.joint_torques) largest = std::max(largest, std::abs(torque));
  return largest;
}

}  // namespace cellmirror::sim
