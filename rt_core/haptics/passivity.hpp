// Passivity observer and controller in the time domain (Hannaford, Ryu, IEEE Trans. Robotics and Automation 18(1),
// 2002): counts the energy that goes through the device's handle, and damps what comes out beyond an allowance.
#pragma once

#include <Eigen/Core>

#include "rt_core/base/real_time.hpp"

namespace cellmirror::haptics {

struct PassivitySettings {
  bool control = true;
  double allowance = 1e-3;    // J, and W: what may be generated, at once and every second
  double max_damping = 50.0;  // Ns/m
};

class Passivity {
 public:
  // `p`: where the handle is (m, as the device moves, in axes that do not turn).
  void restart(const Eigen::Vector3d& p) CELL_RT;
  // The handle has come to `p` while `held` (N, on the hand) was being applied. `stored` (J): what the spring may
  // rightfully give back; energy beyond that was taken out by friction or damping and does not come back, so it pays
  // for nothing later.
  void observe(const Eigen::Vector3d& p, const Eigen::Vector3d& held, double stored, const PassivitySettings& settings,
               double period) CELL_RT;
  // The force (N) with as much damping as the deficit asks for. Free space is not damped.
  Eigen::Vector3d control(const Eigen::Vector3d& force, bool in_contact, const PassivitySettings& settings,
                          double period) CELL_RT;

  // J; positive: went in and may come out again; negative: was generated.
  [[nodiscard]] double energy() const CELL_RT { return energy_; }
  [[nodiscard]] double damping() const CELL_RT { return damping_; }  // Ns/m, of the last control()
  // Far more was generated than damping could take.
  [[nodiscard]] bool lost(const PassivitySettings& settings) const CELL_RT;

 private:
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  // m/s, over the last period
  double energy_ = 0;
  double damping_ = 0;
};

}  // namespace cellmirror::haptics
