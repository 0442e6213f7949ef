// Passivity observer and controller in the time domain (Hannaford, Ryu, IEEE Trans. Robotics and Automation 18(1),
// 2002; with a look ahead as in Ryu, Preusche, Hannaford, Hirzinger, IEEE Trans. Control Systems Technology 13(4),
// 2005): observes the energy through the device's handle, and returns no more than was put in.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::haptics {

struct PassivitySettings {
  bool control = true;
  double allowance = 1e-3;      // J, that may be generated at once; a tenth of it again in every second
  double max_damping = 1000.0;  // Ns/m
};

// A device applies the force of a tick from its next sample on and holds it until the one after; so a force is paid for
// with the motion of the period after next. A device that is quicker is counted as slightly worse than it is.
class Passivity {
 public:
  // `p`: where the handle is (m, as the device moves, in axes that do not turn).
  void restart(const Eigen::Vector3d& p) CELL_RT;
  // The handle has come to `p`; `force` (N, on the hand) is what the last tick gave. `stored` (J): what the spring may
  // rightfully give back; energy beyond that was taken out by friction or damping and does not come back, so it pays
  // for nothing later.
  void observe(const Eigen::Vector3d& p, const Eigen::Vector3d& force, double stored, const PassivitySettings& settings,
               double period) CELL_RT;
  // The force (N), clipped so that it releases no more energy than stored. It only reduces the force: damping with a
  // sample's delay would shake a light hand. The reduction fades within a tenth of a second, so the wall is softer for
  // a while.
  Eigen::Vector3d control(const Eigen::Vector3d& force, const PassivitySettings& settings, double period) CELL_RT;

  // J; positive: stored and may be released; negative: generated.
  [[nodiscard]] double energy() const CELL_RT { return energy_; }
  [[nodiscard]] double damping() const CELL_RT { return damping_; }  // Ns/m, that the last cut is worth
  // Far more was generated than could be taken.
  [[nodiscard]] bool lost(const PassivitySettings& settings) const CELL_RT;

  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(p_, step_, change_, applied_, energy_, damping_, share_);
  }

 private:
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero();     // m, in the last period
  Eigen::Vector3d change_ = Eigen::Vector3d::Zero();   // m, by which it differs from the one before
  Eigen::Vector3d applied_ = Eigen::Vector3d::Zero();  // N, from the newest sample on
  double energy_ = 0;
  double damping_ = 0;
  double share_ = 1;  // of the force that is let through after a cut
};

}  // namespace cellmirror::haptics
