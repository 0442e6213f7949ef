#include "sim_devices/footswitch/switch_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>

#include "rt_core/base/json_writer.hpp"
#include "rt_core/base/text.hpp"
#include "sim_devices/base/pacer.hpp"
#include "sim_devices/base/process.hpp"
#include "sim_devices/footswitch/switch_bits.hpp"

namespace cellmirror::sim {
namespace {

constexpr Nanoseconds kNap{20'000'000};

Nanoseconds from_seconds(double s) { return Nanoseconds(static_cast<std::int64_t>(s * 1e9)); }

}  // namespace

std::string to_json(const FootSwitchSummary& s) {
  JsonWriter out;
  return out.begin_object()
      .member("device", "foot switches")
      .fixed_member("duration_s", s.duration_s, 3)
      .fixed_member("waited_s", s.waited_s, 3)
      .member("attachments", s.attachments)
      .member("changes", s.changes)
      .member("bounces", s.bounces)
      .member("left_out", s.left_out)
      .fixed_member("latest_us", s.latest_us, 1)
      .end_object()
      .take();
}

SwitchLoop::SwitchLoop(FootSwitchOptions options)
    : options_(std::move(options)), seeker_(options_.key, options_.bytes, false) {}

SwitchLoop::~SwitchLoop() {
  if (log_ != nullptr) std::fclose(log_);
}

Result<std::unique_ptr<SwitchLoop>> SwitchLoop::make(FootSwitchOptions options) {
  std::unique_ptr<SwitchLoop> loop(new SwitchLoop(std::move(options)));
  if (!loop->options_.control.empty()) {
    auto opened = ControlFifo::open(loop->options_.control);
    if (!opened) return std::unexpected(opened.error());
    loop->control_ = std::move(*opened);
  }
  if (loop->options_.log.empty()) return loop;
  loop->log_ = std::fopen(loop->options_.log.c_str(), "w");
  if (loop->log_ == nullptr) {
    return fail(fmt::format("--log {}: {}", loop->options_.log, std::generic_category().message(errno)),
                "name a file in a folder that you may write to");
  }
  fmt::print(loop->log_, "time_ns,input,on,bounce\n");
  return loop;
}

bool SwitchLoop::wait_for_memory() {
  const Timestamp begin = clock_.now();
  bool announced = options_.quiet;
  while (!seeker_.look(clock_.now())) {
    const double waited = seconds(clock_.now() - begin);
    if (signalled() || (options_.wait_s > 0 && waited > options_.wait_s)) {
      fmt::print(stderr, "sim_footswitch: {}\n", seeker_.reason());
      return false;
    }
    if (!announced && waited > 1) {
      fmt::print(stderr, "sim_footswitch: waiting: {}\n", seeker_.reason());
      announced = true;
    }
    sleep_until(clock_.now() + kNap);
  }
  summary_.waited_s = seconds(clock_.now() - begin);
  return true;
}

void SwitchLoop::wait_until(Timestamp t) {
  while (!signalled() && !quit_) {
    const Timestamp now = clock_.now();
    if (now >= t) return;
    static_cast<void>(seeker_.look(now));
    listen(now);
    Timestamp next = std::min(t, now + kNap);
    if (!told_.empty()) next = std::min(next, started_ + from_seconds(told_.front().at_s));
    sleep_until(next);
    put_told();
  }
}

// Sequences by command: their first change comes at once.
void SwitchLoop::listen(Timestamp now) {
  if (!control_) return;
  for (const std::string& line : control_->lines()) {
    if (trimmed(line) == "quit") {
      quit_ = true;
      return;
    }
    Diagnostics diagnostics;
    const auto changes = parse_switch_sequence(line, "command", options_.gap_s, diagnostics);
    if (!diagnostics.ok()) {
      fmt::print(stderr, "{}", diagnostics.text());
      continue;
    }
    if (told_.size() + changes.size() > kMaxSwitchChanges) continue;
    for (SwitchChange change : changes) {
      change.at_s += seconds(now - started_);
      told_.push_back(change);
    }
    sort_by_time(told_);
  }
}

void SwitchLoop::put_told() {
  while (!told_.empty() && started_ + from_seconds(told_.front().at_s) <= clock_.now()) {
    std::size_t end = 0;
    while (end < told_.size() && told_[end].at_s == told_.front().at_s) ++end;
    put(std::span(told_).first(end), started_ + from_seconds(told_.front().at_s));
    told_.erase(told_.begin(), told_.begin() + static_cast<std::ptrdiff_t>(end));
  }
}

bool SwitchLoop::run() {
  if (!become_punctual(options_.priority)) {
    fmt::print(stderr, "sim_footswitch: no SCHED_FIFO for this user; continuing with ordinary priority\n");
  }
  if (!wait_for_memory()) return false;
  started_ = clock_.now();
  const std::vector<SwitchChange>& plan = options_.plan;
  for (std::size_t i = 0; i < plan.size() && !signalled() && !quit_;) {
    std::size_t end = i;
    while (end < plan.size() && plan[end].at_s == plan[i].at_s) ++end;
    const Timestamp due = started_ + from_seconds(plan[i].at_s);
    wait_until(due);
    if (!signalled() && !quit_) put(std::span(plan).subspan(i, end - i), due);
    i = end;
  }
  wait_until(options_.for_s < 0 ? Timestamp{std::numeric_limits<std::int64_t>::max()}
                                : started_ + from_seconds(options_.for_s));
  release();
  summary_.attachments = seeker_.attachments();
  summary_.duration_s = seconds(clock_.now() - started_);
  return true;
}

// A foot that goes away presses nothing any more: what it held, and after a signal whatever it was about to open.
void SwitchLoop::release() {
  std::vector<std::uint32_t> inputs = options_.holds;
  if (signalled() || quit_) {
    for (const SwitchChange& change : options_.plan) inputs.push_back(change.input);
  }
  std::ranges::sort(inputs);
  const auto same = std::ranges::unique(inputs);
  inputs.erase(same.begin(), same.end());
  std::vector<SwitchChange> open;
  for (const std::uint32_t input : inputs) open.push_back({0, input, false, false});
  if (!open.empty()) put(open, clock_.now());
}

void SwitchLoop::put(std::span<const SwitchChange> changes, Timestamp due) {
  const Timestamp now = clock_.now();
  summary_.latest_us = std::max(summary_.latest_us, 1e6 * seconds(now - due));
  summary_.left_out += put_switches(seeker_.memory(), changes);
  for (const SwitchChange& change : changes) {
    ++(change.bounce ? summary_.bounces : summary_.changes);
    if (log_ != nullptr) {
      fmt::print(log_, "{},{},{},{}\n", now.ns, change.input, change.on ? 1 : 0, change.bounce ? 1 : 0);
    }
  }
}

}  // namespace cellmirror::sim
