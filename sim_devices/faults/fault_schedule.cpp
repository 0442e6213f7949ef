#include "sim_devices/faults/fault_schedule.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::sim {
namespace {

Timestamp instant(Timestamp origin, double after_s) {
  if (std::isinf(after_s)) return kNeverEnds;
  return origin + Nanoseconds(std::llround(after_s * 1e9));
}

bool concerns(const FaultSpec& spec, Source source) {
  return (spec.robot == 0 || source.robot == 0 || spec.robot == source.robot) &&
         (spec.joint == 0 || spec.joint == source.joint);
}

template <class Condition>
std::vector<ScheduledFault> take_out(std::vector<ScheduledFault>& faults, Condition condition) {
  std::vector<ScheduledFault> removed;
  std::vector<ScheduledFault> kept;
  for (ScheduledFault& fault : faults) (condition(fault) ? removed : kept).push_back(std::move(fault));
  faults = std::move(kept);
  return removed;
}

}  // namespace

int FaultSchedule::add(const FaultSpec& spec, Timestamp origin) {
  ScheduledFault fault;
  fault.id = ++last_id_;
  fault.spec = spec;
  fault.from = instant(origin, spec.from_s);
  fault.until = instant(origin, spec.until_s);
  // A generator of its own, so that one fault more does not change whom the others strike.
  fault.random = Random(seed_ ^ (0xD1B54A32D192ED03ULL * static_cast<std::uint64_t>(fault.id)));
  fault.next_insertion = fault.from;
  faults_.push_back(std::move(fault));
  return last_id_;
}

std::vector<ScheduledFault> FaultSchedule::remove(int id) {
  return take_out(faults_, [id](const ScheduledFault& fault) { return id == 0 || fault.id == id; });
}

std::vector<ScheduledFault> FaultSchedule::remove(FaultKind kind) {
  return take_out(faults_, [kind](const ScheduledFault& fault) { return fault.spec.kind == kind; });
}

bool FaultSchedule::strikes(ScheduledFault& fault, Timestamp now, Source source, MessageKind kind) {
  const FaultSpec& spec = fault.spec;
  if (!fault.in_force(now) || !concerns(spec, source) || (spec.only && *spec.only != kind)) return false;
  ++fault.matched;
  const bool struck = spec.every > 0 ? fault.matched % spec.every == 0
                                     : spec.probability >= 1 || fault.random.fraction() < spec.probability;
  if (struck) ++fault.applied;
  return struck;
}

void FaultSchedule::shape(Timestamp now, Source source, JointValue& value) {
  for (ScheduledFault& fault : faults_) {
    const FaultKind kind = fault.spec.kind;
    if (kind != FaultKind::frozen && kind != FaultKind::jump && kind != FaultKind::nan) continue;
    if (!strikes(fault, now, source, MessageKind::sample)) continue;
    if (kind == FaultKind::frozen) {
      value = fault.held_values.try_emplace({source.robot, source.joint}, value).first->second;
    } else if (kind == FaultKind::jump) {
      value.position += fault.spec.amount;
    } else {
      value.position = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

void FaultSchedule::shape(Timestamp now, int robot, std::span<JointValue> values) {
  if (faults_.empty()) return;
  for (std::size_t i = 0; i < values.size(); ++i) {
    shape(now, Source{robot, static_cast<int>(i) + 1}, values[i]);
  }
}

bool FaultSchedule::alive(Timestamp now, Source source) const {
  return std::none_of(faults_.begin(), faults_.end(), [&](const ScheduledFault& fault) {
    return fault.spec.kind == FaultKind::death && fault.in_force(now) && concerns(fault.spec, source);
  });
}

Timestamp FaultSchedule::next_life_change(Timestamp now) const {
  Timestamp next = kNeverEnds;
  for (const ScheduledFault& fault : faults_) {
    if (fault.spec.kind != FaultKind::death) continue;
    if (fault.from > now) next = std::min(next, fault.from);
    if (fault.until > now) next = std::min(next, fault.until);
  }
  return next;
}

}  // namespace cellmirror::sim
