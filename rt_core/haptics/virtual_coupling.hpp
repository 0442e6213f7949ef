// The spring and damper between hand and proxy. Forces are those on the hand.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::haptics {

struct CouplingSettings {
  double stiffness = 0;    // N/m
  double damping = 0;      // Ns/m
  double engage_time = 0;  // s, in which the force fades in
};

class VirtualCoupling {
 public:
  void restart() CELL_RT;
  // N. `elongation`: from the hand to the proxy (m); `normal`: the unit vector that pushes the hand out, or zero. The
  // damper never pulls the hand into a surface. `period` in s.
  Eigen::Vector3d force(const Eigen::Vector3d& elongation, const Eigen::Vector3d& normal,
                        const CouplingSettings& settings, double period) CELL_RT;
  // Continues fading in, by one period.
  void fade(double engage_time, double period) CELL_RT;
  [[nodiscard]] double faded_in() const CELL_RT { return share_; }  // 0 to 1

  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(share_, last_, rate_);
  }

 private:
  double share_ = 0;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // m/s
};

}  // namespace cellmirror::haptics
