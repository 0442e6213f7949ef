// Soft tissue for the tests of haptics: what a worker beside the tick would say of a half-space of springs and dampers,
// on time, late, or no longer.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>

#include "rig.hpp"

namespace cellmirror::haptics::test_rig {

// N/m, of a flat tip with a radius of 4 mm on tissue of this Young's modulus and a Poisson's ratio of 0.45:
// 2 E r / (1 - v^2).
[[nodiscard]] double stiffness_of_tissue(double youngs_modulus_pa);

struct TissueParameters {
  double stiffness = 100;       // N/m
  double damping = 0.2;         // Ns/m
  int every = 1;                // ticks from one response to the next
  int delay = 1;                // ticks from the posture to the tick that has the response; at least 1
  bool local_stiffness = true;  // false: it says no stiffness, only forces
  double smoothing = 1;         // share of a new force in what it says; 1: none
  bool smooths_place = true;    // and of a new place
  double grips_at = 1e9;        // s: its surface sticks to the tip, from where the tip is then
  double releases_at = 1e9;     // s
  double removed_at = 1e9;      // s: it was cut off, and has no force any more
  double stops_at = 1e9;        // s: the last response
};

// The half-space z < 0. Linear and passive: any energy that appears is the renderer's.
class StandInTissue {
 public:
  explicit StandInTissue(const TissueParameters& parameters) : parameters_(parameters) {}
  // Rig::tissue_worker.
  void operator()(Rig& rig);
  [[nodiscard]] bool held() const { return held_; }

 private:
  [[nodiscard]] TissueForce response(const Rig& rig);
  void smooth(TissueForce& response);

  TissueParameters parameters_;
  std::deque<TissueForce> under_way_;
  TissueForce smoothed_;
  std::uint64_t ticks_ = 0;
  std::uint64_t sequence_ = 0;
  bool known_ = false;
  bool held_ = false;
  Eigen::Vector3d before_ = Eigen::Vector3d::Zero();  // tip in the last tick
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();  // where the held place rests without force
};

}  // namespace cellmirror::haptics::test_rig
