#include "drivers/can/canopen/fault_gate.hpp"

#include <algorithm>
#include <utility>

#include "drivers/can/canopen/cob_id.hpp"
#include "drivers/can/canopen/earlier_due.hpp"

namespace cellmirror::can {
namespace {

// PDOs may have any identifier: what is nothing else. Boot-up messages have that of heartbeats.
NodeFrames frames_of(const CanFrame& frame) {
  const auto is_of = [&frame](std::uint32_t base) {
    return !frame.extended && frame.id > base && frame.id <= base + kMaxNodeId;
  };
  if (is_of(kHeartbeatBase)) return NodeFrames::heartbeat;
  if (is_of(kSdoResponseBase)) return NodeFrames::sdo;
  if (is_of(kEmcyBase)) return NodeFrames::emergency;
  return NodeFrames::pdo;
}

bool strikes(const NodeFault& fault, const CanFrame& frame) {
  return fault.only == NodeFrames::all || fault.only == frames_of(frame);
}

}  // namespace

bool FaultGate::add(const NodeFault& fault, Timestamp now) {
  if (faults_.size() >= kMostFaults) return false;
  faults_.push_back({fault, fault.lasts.count() > 0 ? now + fault.lasts : Timestamp{}});
  return true;
}

void FaultGate::end_all() {
  ended_.death = ended_.death || has(NodeFaultKind::death);
  ended_.emergency = ended_.emergency || has(NodeFaultKind::emergency);
  faults_.clear();
  for (const auto& [time, frame] : waiting_) output_->send(frame);
  waiting_.clear();
}

FaultGate::Ended FaultGate::advance(Timestamp now) {
  now_ = now;
  Ended ended = std::exchange(ended_, {});
  if (faults_.empty() && waiting_.empty()) return ended;
  std::erase_if(faults_, [&](const Active& active) {
    if (!active.until.known() || now < active.until) return false;
    if (active.fault.kind == NodeFaultKind::death) ended.death = true;
    if (active.fault.kind == NodeFaultKind::emergency) ended.emergency = true;
    return true;
  });
  // Another one may last longer.
  if (has(NodeFaultKind::death)) ended.death = false;
  if (has(NodeFaultKind::emergency)) ended.emergency = false;
  while (!waiting_.empty() && waiting_.begin()->first <= now) {
    output_->send(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
  }
  return ended;
}

Timestamp FaultGate::next_due() const {
  Timestamp due = waiting_.empty() ? Timestamp{} : waiting_.begin()->first;
  for (const Active& active : faults_) due = earlier_due(due, active.until);
  return due;
}

void FaultGate::send(const CanFrame& frame) {
  Nanoseconds by{0};
  for (const auto& [fault, until] : faults_) {
    if (fault.kind == NodeFaultKind::death) return;
    if (!strikes(fault, frame)) continue;
    if (fault.kind == NodeFaultKind::loss && std::generate_canonical<double, 32>(chance_) < fault.probability) return;
    if (fault.kind == NodeFaultKind::delay) by += fault.by;
  }
  if (by.count() == 0) return output_->send(frame);
  if (waiting_.size() < kMostWaiting) waiting_.emplace(now_ + by, frame);
}

IoInputs FaultGate::seen(IoInputs inputs) const {
  for (const auto& [fault, until] : faults_) {
    if (fault.kind != NodeFaultKind::stuck) continue;
    if (fault.analogue) {
      inputs.analogue.at(fault.input) = fault.value;
      continue;
    }
    const std::uint32_t bit = 1U << fault.input;
    inputs.digital = fault.value != 0 ? inputs.digital | bit : inputs.digital & ~bit;
  }
  return inputs;
}

std::uint8_t FaultGate::kinds() const {
  unsigned kinds = 0;
  for (const Active& active : faults_) kinds |= 1U << static_cast<unsigned>(active.fault.kind);
  return static_cast<std::uint8_t>(kinds);
}

bool FaultGate::has(NodeFaultKind kind) const {
  return std::ranges::any_of(faults_, [kind](const Active& active) { return active.fault.kind == kind; });
}

}  // namespace cellmirror::can
