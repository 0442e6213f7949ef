// What an instrument feels: the force of the last steps, and how it changes where the instrument moves.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "rt_core/tissue/description/step.hpp"
#include "rt_core/tissue/instruments/instrument.hpp"

namespace cellmirror::tissue {

inline constexpr double kLargestStiffness = 2000.0;  // N/m

// Estimates the static stiffness of the tissue about an instrument along the direction of the force: by regression of
// force on way over some hundredths of a second, drawn to that of a rigid punch on an elastic half-space where the
// instrument hardly moves. Cf. Peterlik et al. 2011 (a local compliance beside the planes of contacts).
class ResponseEstimate {
 public:
  void reset() { *this = ResponseEstimate(); }
  // `modulus`: Young's modulus divided by 1 - nu^2 of what is touched, Pa; 0: nothing. `largest_force`: N; 0: no limit.
  InstrumentResponse update(const Instrument& instrument, double modulus, double largest_force);

 private:
  static constexpr std::size_t kWindow = 8;  // steps over which ways and forces are compared

  struct Sample {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
  };

  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();  // m, of the tool centre point, smoothed as the force is
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();  // smoothed
  Eigen::Vector3d torque_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d directions_ = Eigen::Matrix3d::Zero();
  std::array<Sample, kWindow> past_{};
  std::size_t samples_ = 0;
  double way_squared_ = 0;  // m2, weighted sum
  double way_force_ = 0;    // N m
};

}  // namespace cellmirror::tissue
