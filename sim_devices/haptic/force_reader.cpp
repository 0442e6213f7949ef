#include "sim_devices/haptic/force_reader.hpp"

#include <algorithm>
#include <cmath>

#include "ipc/wire/haptic_block.hpp"
#include "sim_devices/haptic/haptic_log.hpp"

namespace cellmirror::sim {
namespace {

// A device's own amplifier would switch off where its host says nothing any more.
constexpr Nanoseconds kSilence{20'000'000};
constexpr double kMostEffort = 1000;  // N or Nm

double bounded(double value) { return std::isfinite(value) ? std::clamp(value, -kMostEffort, kMostEffort) : 0.0; }

HapticOutput bounded(HapticOutput output) {
  for (int i = 0; i < 3; ++i) {
    output.force_E[i] = bounded(output.force_E[i]);
    output.force_D[i] = bounded(output.force_D[i]);
    output.torque_D[i] = bounded(output.torque_D[i]);
  }
  output.gripper_torque = bounded(output.gripper_torque);
  for (double& torque : output.joint_torques) torque = bounded(torque);
  return output;
}

void drop_force(HapticOutput& output) {
  output.force_E.setZero();
  output.force_D.setZero();
  output.torque_D.setZero();
  output.gripper_torque = 0;
  output.joint_torques.fill(0);
}

}  // namespace

bool ForceReader::read(std::span<const std::byte> memory, Timestamp now, const WriteTimes& written) {
  HapticOutput output;
  const bool whole = !memory.empty() && read_haptic_output(memory, output);
  const bool news = whole && (!started_ || output.sequence != output_.sequence);
  if (news) {
    output = bounded(output);
    count(output, now, written);
    output_ = output;
    last_news_ = now;
    started_ = true;
    silent_ = false;
    return true;
  }
  if (!whole && !memory.empty()) ++summary_.torn_reads;
  if (!silent_ && now - last_news_ > kSilence) {
    silent_ = true;
    ++summary_.silences;
    drop_force(output_);
  }
  return false;
}

void ForceReader::count(const HapticOutput& output, Timestamp now, const WriteTimes& written) {
  ++summary_.forces;
  if (started_ && output.sequence > output_.sequence + 1 && output.sequence - output_.sequence < 1'000'000) {
    summary_.skipped_forces += output.sequence - output_.sequence - 1;
  }
  if (output.fault != 0 && output.fault != summary_.last_fault) ++summary_.gateway_faults;
  summary_.last_phase = output.phase;
  summary_.last_fault = output.fault;
  summary_.max_force_n = std::max(summary_.max_force_n, force_size(output));
  summary_.max_torque_nm = std::max(summary_.max_torque_nm, torque_size(output));
  if (output.answers == last_answers_) return;
  const Timestamp wrote = written.of(output.answers);
  if (wrote.known()) {
    summary_.latency.add(now - wrote);
    summary_.tick_latency.add(output.time - wrote);
    if (output.answers > last_answers_ + 1 && written.of(last_answers_).known()) {
      summary_.skipped_samples += output.answers - last_answers_ - 1;
    }
  }
  last_answers_ = output.answers;
}

}  // namespace cellmirror::sim
