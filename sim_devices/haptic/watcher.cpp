#include "sim_devices/haptic/watcher.hpp"

#include "ipc/wire/haptic_block.hpp"
#include "sim_devices/base/pacer.hpp"
#include "sim_devices/base/process.hpp"

namespace cellmirror::sim {
namespace {

constexpr double kUsualPollUs = 200;

}  // namespace

HapticWatcher::HapticWatcher(const HapticOptions& options, HapticLog* log)
    : options_(options),
      log_(log),
      layout_(options.axes),
      seeker_(options.key, haptic_block_offset::kSize, true),
      reader_(summary_) {
  summary_.watching = true;
  summary_.axes = options.axes;
}

void HapticWatcher::run() {
  static_cast<void>(become_punctual(options_.priority));
  const Nanoseconds period(static_cast<std::int64_t>(1e3 * (options_.poll_us > 0 ? options_.poll_us : kUsualPollUs)));
  const Timestamp started = clock_.now();
  Pacer pacer(started, period);
  Timestamp now = started;
  while (!signalled() && !(options_.for_s > 0 && seconds(now - started) >= options_.for_s)) {
    sleep_until(pacer.next());
    now = clock_.now();
    if (!pacer.due(now)) continue;
    pacer.advance(now);
    if (seeker_.look(now)) look(now);
  }
  summary_.missed_periods = pacer.missed();
  summary_.attachments = seeker_.attachments();
  summary_.duration_s = seconds(clock_.now() - started);
  summary_.rate_hz = 1 / seconds(period);
}

void HapticWatcher::look(Timestamp now) {
  if (seeker_.attachments() != attachments_) reader_.restart();
  attachments_ = seeker_.attachments();
  if (read_haptic_sample(seeker_.memory(), device_lock_, sample_) == HapticRead::fresh) ++summary_.samples;
  if (!reader_.read(seeker_.memory(), now, nothing_written_) || log_ == nullptr) return;
  const HapticOutput& answer = reader_.output();
  HapticLogRow row;
  row.time_ns = now.ns;
  row.sequence = sample_.sequence;
  row.sample_time_ns = sample_.time.ns;
  row.writer = sample_.writer;
  row.axes = sample_.axes;
  row.efforts = layout_.efforts(answer);
  row.force_sequence = answer.sequence;
  row.force_time_ns = answer.time.ns;
  row.answers = answer.answers;
  row.phase = answer.phase;
  row.fault = answer.fault;
  row.force_n = force_size(answer);
  row.torque_nm = torque_size(answer);
  log_->add(row);
}

}  // namespace cellmirror::sim
