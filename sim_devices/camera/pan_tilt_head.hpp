// A pan-tilt head: two axes that go where the newest record says, with limits and faults of their own. Virtual time; no
// input or output.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "ipc/wire/camera_record.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/base/time.hpp"
#include "sim_devices/camera/head_axis.hpp"
#include "sim_devices/camera/head_fault.hpp"

namespace cellmirror::sim {

inline constexpr std::size_t kHeadAxes = 2;  // pan, tilt
using HeadAngles = std::array<double, kHeadAxes>;

struct HeadConfig {
  std::array<AxisLimits, kHeadAxes> limits{AxisLimits{-3.0, 3.0, 1.5, 6.0}, AxisLimits{-1.4, 1.4, 1.5, 6.0}};
  HeadAngles start{};  // rad
};

class PanTiltHead {
 public:
  struct Counters {
    std::uint64_t followed = 0;  // records that gave a goal
    std::uint64_t echoes = 0;    // records of its own direction: no target
    std::uint64_t ignored = 0;   // not finite, or the head was deaf
    std::uint64_t beyond = 0;    // records whose goal is beyond a stop
  };
  static constexpr std::size_t kMostFaults = 64;

  explicit PanTiltHead(const HeadConfig& config);

  void start(Timestamp now);
  void follow(const CameraRecord& record, Timestamp now);
  // Moves until `now`; an earlier time than in the last call has no effect.
  void advance(Timestamp now);
  void hold(bool held) { held_ = held; }

  // Its number; windows count from `now`. Refused beyond kMostFaults.
  Result<int> add_fault(const HeadFaultSpec& spec, Timestamp now);
  // By number (0: any) and kind (none: any); how many.
  std::size_t end_faults(int id, std::optional<HeadFaultKind> kind, Timestamp now);
  [[nodiscard]] std::span<const HeadFault> faults() const { return faults_; }

  [[nodiscard]] const HeadAxis& axis(std::size_t i) const { return axes_[i]; }
  [[nodiscard]] const HeadAngles& goal() const { return goal_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  struct Waiting {
    Timestamp due;
    HeadAngles goal;
  };
  static constexpr std::size_t kMostWaiting = 4096;
  static constexpr int kFirstFault = 1001;  // those of the drives count from 1

  [[nodiscard]] HeadFault* in_force(HeadFaultKind kind, int joint, Timestamp now);
  void move(std::size_t axis, Timestamp now, double dt);
  // They make room for others.
  void forget_past_faults(Timestamp now);

  std::array<HeadAxis, kHeadAxes> axes_;
  HeadAngles goal_;
  std::deque<Waiting> waiting_;
  std::vector<HeadFault> faults_;
  Counters counters_;
  Timestamp last_;
  bool held_ = false;
  int next_fault_ = kFirstFault;
};

}  // namespace cellmirror::sim
