#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "ipc/wire/haptic_block.hpp"
#include "rt_core/base/text.hpp"
#include "sim_devices/base/process.hpp"
#include "sim_devices/haptic/haptic_device.hpp"

namespace cellmirror::sim {
namespace {

constexpr Nanoseconds kWaiting{10'000'000};
constexpr Nanoseconds kBetweenCommands{20'000'000};
constexpr Nanoseconds kBeforeNext{50'000};  // polling ends so long before the next period
constexpr std::int64_t kMostPeriodsAtOnce = 100;
constexpr std::size_t kMostNotes = 1000;  // faults in the summary

Nanoseconds from_seconds(double s) { return Nanoseconds(static_cast<std::int64_t>(s * 1e9)); }

}  // namespace

HapticLoop::HapticLoop(const HapticOptions& options, HapticLog* log, ControlFifo* control)
    : options_(options),
      log_(log),
      control_(control),
      device_(options),
      seeker_(options.key, haptic_block_offset::kSize, false),
      reader_(summary_),
      period_(from_seconds(1 / options.rate_hz)) {
  summary_.axes = options.axes;
  summary_.rate_hz = options.rate_hz;
}

bool HapticLoop::wait_for_memory() {
  const Timestamp begin = clock_.now();
  bool announced = options_.quiet;
  while (!seeker_.look(clock_.now())) {
    const double waited = seconds(clock_.now() - begin);
    if (signalled() || (options_.wait_s > 0 && waited > options_.wait_s)) {
      fmt::print(stderr, "sim_haptic: {}\n", seeker_.reason());
      return false;
    }
    if (!announced && waited > 1) {
      fmt::print(stderr, "sim_haptic: waiting: {}\n", seeker_.reason());
      announced = true;
    }
    sleep_until(clock_.now() + kWaiting);
  }
  summary_.waited_s = seconds(clock_.now() - begin);
  return true;
}

bool HapticLoop::over(Timestamp now) const {
  if (signalled() || quit_) return true;
  if (options_.for_s > 0) return seconds(now - started_) >= options_.for_s;
  return options_.for_s < 0 && control_ == nullptr && !options_.motion.empty() && device_.done();
}

bool HapticLoop::run() {
  if (!become_punctual(options_.priority)) {
    fmt::print(stderr, "sim_haptic: no SCHED_FIFO for this user; continuing with ordinary priority\n");
  }
  if (!wait_for_memory()) return false;
  started_ = clock_.now();
  Pacer pacer(started_ + period_, period_);
  Timestamp now = started_;
  while (!over(now)) {
    wait_for_answer(pacer.next() - kBeforeNext);
    sleep_until(pacer.next());
    now = clock_.now();
    if (!pacer.due(now)) continue;  // a signal
    summary_.latest_start_us = std::max(summary_.latest_start_us, 1e6 * seconds(now - pacer.next()));
    const Timestamp planned = pacer.next();
    pacer.advance(now);
    const std::int64_t periods = std::min((pacer.next() - planned) / period_, kMostPeriodsAtOnce);
    listen(now);
    const bool there = seeker_.look(now);
    if (seeker_.attachments() != attachments_) reader_.restart();
    attachments_ = seeker_.attachments();
    if (there) period(now, seconds(period_) * static_cast<double>(periods));
  }
  second_.end();
  summary_.missed_periods = pacer.missed();
  summary_.attachments = seeker_.attachments();
  summary_.duration_s = seconds(clock_.now() - started_);
  summary_.motion_done = device_.done();
  return true;
}

void HapticLoop::period(Timestamp now, double dt) {
  reader_.read(seeker_.memory(), now, written_);
  const HapticSample& sample = device_.step(reader_.output(), now, seconds(now - started_), dt);
  summary_.work_j = device_.hand().work();
  summary_.max_work_j = std::max(summary_.max_work_j, summary_.work_j);
  note_faults(now);
  const bool torn = device_.in_force(HapticFaultKind::torn) != nullptr;
  if (torn || device_.in_force(HapticFaultKind::dead) != nullptr) end_by_fault(torn);
  if (device_.in_force(HapticFaultKind::twice) != nullptr) {
    last_ = sample;
    last_.sequence = sequence_;
    second_.begin(seeker_.memory(), last_, period_);
  } else {
    second_.end();
  }
  if (device_.in_force(HapticFaultKind::freeze) == nullptr) write(sample);
  log(now);
}

void HapticLoop::write(const HapticSample& sample) {
  last_ = sample;
  last_.sequence = ++sequence_;
  last_.writer = static_cast<std::uint32_t>(::getpid());
  written_.note(sequence_, clock_.now());
  write_haptic_sample(seeker_.memory(), last_);
  ++summary_.samples;
}

void HapticLoop::note_faults(Timestamp now) {
  const std::uint32_t begun = device_.struck() & ~noted_;
  for (std::size_t i = 0; begun != 0 && i < device_.faults().size(); ++i) {
    if ((begun >> i & 1U) == 0 || summary_.faults.size() >= kMostNotes) continue;
    summary_.faults.push_back({device_.faults()[i].text, now.ns, sequence_ + 1});
  }
  noted_ |= begun;
}

// The record is saved first: what happened up to here is what one wants to see afterwards.
void HapticLoop::end_by_fault(bool torn) {
  if (log_ != nullptr) log_->flush();
  if (torn) tear(seeker_.memory());
  std::raise(SIGKILL);
}

void HapticLoop::listen(Timestamp now) {
  if (control_ == nullptr || now < next_listen_) return;
  next_listen_ = now + kBetweenCommands;
  for (const std::string& line : control_->lines()) {
    if (const std::string problem = execute(line); !problem.empty()) fmt::print(stderr, "sim_haptic: {}\n", problem);
  }
}

std::string HapticLoop::execute(std::string_view line) {
  line = trimmed(line);
  const std::size_t end = std::min(line.find(' '), line.size());
  const std::string_view word = line.substr(0, end);
  const std::string_view rest = trimmed(line.substr(end));
  if (word == "motion") {
    Diagnostics diagnostics;
    auto steps = parse_motion(rest, "motion", device_.layout(), diagnostics);
    if (!diagnostics.ok()) return std::string(trimmed(diagnostics.text()));
    device_.play(std::move(steps));
  } else if (word == "fault") {
    auto fault = parse_haptic_fault(rest);
    if (!fault) return fault.error().text();
    if (!device_.add_fault(std::move(*fault))) return "there are too many faults; use clear first";
  } else if (word == "clear") {
    device_.clear_faults();
    noted_ = 0;
  } else if (word == "quit") {
    quit_ = true;
  } else if (!line.empty()) {
    return fmt::format("'{}' is not a command; use motion MOTION, fault FAULT, clear or quit", printable(line, 40));
  }
  return {};
}

void HapticLoop::wait_for_answer(Timestamp until) {
  if (options_.poll_us <= 0 || seeker_.memory().empty()) return;
  const Nanoseconds step = from_seconds(options_.poll_us * 1e-6);
  while (reader_.answered() < sequence_) {
    const Timestamp next = clock_.now() + step;
    if (next >= until || signalled()) return;
    sleep_until(next);
    reader_.read(seeker_.memory(), clock_.now(), written_);
  }
}

void HapticLoop::log(Timestamp now) {
  if (log_ == nullptr) return;
  const HapticOutput& answer = reader_.output();
  HapticLogRow row;
  row.time_ns = now.ns;
  row.sequence = last_.sequence;
  row.sample_time_ns = last_.time.ns;
  row.writer = last_.writer;
  row.axes = last_.axes;
  row.efforts = device_.efforts();
  row.force_sequence = answer.sequence;
  row.force_time_ns = answer.time.ns;
  row.answers = answer.answers;
  row.phase = answer.phase;
  row.fault = answer.fault;
  row.force_n = force_size(answer);
  row.torque_nm = torque_size(answer);
  row.struck = device_.struck();
  log_->add(row);
}

}  // namespace cellmirror::sim
