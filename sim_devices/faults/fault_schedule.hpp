// Active faults, their selection, and their effect on values. Pure: time is a parameter, random numbers are seeded.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "sim_devices/base/random.hpp"
#include "sim_devices/faults/fault_spec.hpp"
#include "sim_devices/faults/message.hpp"

namespace cellmirror::sim {

inline constexpr Timestamp kNeverEnds{std::numeric_limits<std::int64_t>::max()};

struct ScheduledFault {
  int id = 0;  // from 1, in the order of coming
  FaultSpec spec;
  Timestamp from;
  Timestamp until = kNeverEnds;
  Random random{0};
  std::uint64_t matched = 0;
  std::uint64_t applied = 0;  // messages or values that it struck

  // State of single kinds.
  Timestamp next_insertion;
  bool began = false;  // bus_off: the error frame was sent
  std::map<std::pair<int, int>, JointValue> held_values;

  [[nodiscard]] bool in_force(Timestamp now) const {
    return from <= now && now < until && (spec.most == 0 || applied < spec.most);
  }
};

class FaultSchedule {
 public:
  // Two schedules with the same seed to which the same happens strike the same messages.
  explicit FaultSchedule(std::uint64_t seed) : seed_(seed) {}

  // The window of `spec` counts from `origin`. Returns the fault's id.
  int add(const FaultSpec& spec, Timestamp origin);
  // Removes one fault, or all with id 0, or all of one kind; the faults that were removed.
  std::vector<ScheduledFault> remove(int id);
  std::vector<ScheduledFault> remove(FaultKind kind);

  [[nodiscard]] std::vector<ScheduledFault>& all() { return faults_; }
  [[nodiscard]] const std::vector<ScheduledFault>& all() const { return faults_; }
  [[nodiscard]] bool empty() const { return faults_.empty(); }

  // Does `fault` strike this message? Counts, and draws lots only for messages that match.
  static bool strikes(ScheduledFault& fault, Timestamp now, Source source, MessageKind kind);

  // Freezes, shifts or spoils the joint values of one robot before they are encoded; index 0 is joint 1.
  void shape(Timestamp now, int robot, std::span<JointValue> values);
  // The same for one joint (a drive of its own).
  void shape(Timestamp now, Source source, JointValue& value);
  // False while the device is dead. `joint` 0 means the whole robot.
  [[nodiscard]] bool alive(Timestamp now, Source source) const;
  // When alive() may change next; kNeverEnds where it will not.
  [[nodiscard]] Timestamp next_life_change(Timestamp now) const;

 private:
  std::uint64_t seed_;
  int last_id_ = 0;
  std::vector<ScheduledFault> faults_;
};

}  // namespace cellmirror::sim
