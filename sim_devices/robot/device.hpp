// What the program needs of a simulated device, whatever it speaks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "sim_devices/faults/fault_pipeline.hpp"
#include "sim_devices/robot/control_command.hpp"

namespace cellmirror::sim {

struct FaultStatus {
  int id = 0;
  std::string text;
  bool in_force = false;
  std::uint64_t applied = 0;
};

struct DeviceStatus {
  std::string endpoint;
  int first_robot = 1;
  int robots = 0;
  std::array<std::uint64_t, kMessageKindNames.size()> sent{};  // passed to the channel, by MessageKind
  std::uint64_t refused = 0;                                   // by the channel
  std::uint64_t received = 0;
  std::uint64_t missed_periods = 0;
  double latest_s = 0;  // the largest delay of a period's start
  std::vector<std::uint64_t> samples_of_robot;
  std::vector<std::pair<std::string, std::uint64_t>> details;
  std::vector<std::pair<std::string, double>> quantities;  // SI, with the unit in the name
  std::vector<FaultStatus> faults;
};

// Life: made -> start(now) -> { work(now), wait_until(next()) } ... One thread does these; the others may be called
// from another thread under the same lock that covers start() and work().
class SimulatedDevice {
 public:
  virtual ~SimulatedDevice() = default;
  // The windows of all faults given so far, and the motion, count from here.
  virtual void start(Timestamp now) = 0;
  // Sends what is due, answers what was received.
  virtual void work(Timestamp now) = 0;
  [[nodiscard]] virtual Timestamp next() const = 0;
  // Returns at `t`, or earlier where something came in that work() has to see. Without the lock.
  virtual void wait_until(Timestamp t) = 0;

  // One sentence what was done, or why not.
  virtual Result<std::string> execute(const ControlCommand& command, Timestamp now) = 0;
  // A line for this kind of device only; none: it is for execute().
  virtual std::optional<Result<std::string>> execute_own(std::string_view /*line*/, Timestamp /*now*/) { return {}; }
  [[nodiscard]] virtual DeviceStatus status(Timestamp now) const = 0;
};

// The part of a device that all protocols share.
template <class M>
class FaultyDevice : public SimulatedDevice {
 public:
  static constexpr std::size_t kMostFaults = 256;

  explicit FaultyDevice(std::uint64_t seed) : pipeline_(seed) {}

  Result<std::string> execute(const ControlCommand& command, Timestamp now) override {
    if (const auto* add = std::get_if<AddFault>(&command)) {
      if (pipeline_.schedule().all().size() >= kMostFaults) {
        return fail("there are " + std::to_string(kMostFaults) + " faults already", "`clear` ends them");
      }
      if (auto fits = check(add->spec); !fits) return std::unexpected(fits.error());
      return "fault " + std::to_string(pipeline_.schedule().add(add->spec, now));
    }
    if (const auto* end = std::get_if<EndFaults>(&command)) {
      const std::size_t ended = end->kind ? pipeline_.end(*end->kind, now) : pipeline_.end(end->id, now);
      if (ended == 0 && end->id != 0) return fail("there is no fault " + std::to_string(end->id), "ask `status`");
      return std::to_string(ended) + " ended";
    }
    if (const auto* emergency = std::get_if<SendEmergency>(&command)) return send_emergency(*emergency, now);
    if (const auto* held = std::get_if<SetHeld>(&command)) {
      hold(held->held, now);
      return std::string(held->held ? "the motion stops" : "the motion continues");
    }
    return fail("not a command for a device");
  }

 protected:
  // Refuses faults that this protocol cannot have.
  [[nodiscard]] virtual Result<void> check(const FaultSpec& spec) const = 0;
  virtual Result<std::string> send_emergency(const SendEmergency&, Timestamp) {
    return fail("this device has no emergency messages", "they are part of CANopen: sim_robot cia402");
  }
  // False where the channel refused it.
  virtual bool transmit(const M& message) = 0;

  // Seconds of motion at `now`: time during hold does not count.
  [[nodiscard]] double motion_time_s(Timestamp now) const { return seconds((held_ ? held_at_ : now) - motion_start_); }
  void start_motion(Timestamp now) { motion_start_ = now; }

  // Sends what leaves the pipeline at `now`.
  void flush(Timestamp now) {
    out_.clear();
    pipeline_.poll(now, out_);
    for (const Outgoing<M>& message : out_) {
      if (!transmit(message.message)) {
        ++counters_.refused;
        continue;
      }
      ++counters_.sent[static_cast<std::size_t>(message.kind)];
      const auto robot = static_cast<std::size_t>(message.source.robot - counters_.first_robot);
      if (message.kind == MessageKind::sample && robot < counters_.samples_of_robot.size()) {
        ++counters_.samples_of_robot[robot];
      }
    }
  }

  [[nodiscard]] DeviceStatus common_status(Timestamp now) const {
    DeviceStatus status = counters_;
    for (const ScheduledFault& fault : pipeline_.schedule().all()) {
      status.faults.push_back({fault.id, fault.spec.text, fault.in_force(now), fault.applied});
    }
    status.details.emplace_back("pipeline_overflowed", pipeline_.overflowed());
    return status;
  }

  void note_lateness(Timestamp due, Timestamp now) {
    counters_.latest_s = std::max(counters_.latest_s, seconds(now - due));
  }

  FaultPipeline<M> pipeline_;
  DeviceStatus counters_;

 private:
  void hold(bool held, Timestamp now) {
    if (held == held_) return;
    if (held) {
      held_at_ = now;
    } else {
      motion_start_ = motion_start_ + (now - held_at_);
    }
    held_ = held;
  }

  std::vector<Outgoing<M>> out_;
  Timestamp motion_start_;
  Timestamp held_at_;
  bool held_ = false;
};

}  // namespace cellmirror::sim
