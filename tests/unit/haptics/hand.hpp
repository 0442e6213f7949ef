// A hand that holds a device, against whatever force it is given: a mass (hand and device), damping and stiffness about
// where its owner wants it. What the hand is made of is linear and passive, so that any energy that appears is the
// renderer's. Second-order models of this kind are what hands holding a stylus or a knob have been measured as (Hasser,
// Cutkosky, HAPTICS 2002; Israr, Choi, Tan, IROS 2006; Fiene, Kuchenbecker, World Haptics 2007).
#pragma once

#include <Eigen/Core>
#include <functional>

#include "rig.hpp"

namespace cellmirror::haptics::test_rig {

struct HandParameters {
  double mass = 0.15;          // kg, with that of the device
  double damping = 5.0;        // Ns/m
  double stiffness = 300.0;    // N/m, between the hand and where it is wanted
  double encoder_step = 2e-5;  // m
};

// What became of a hand that was moved for a while.
struct HandRun {
  double least_energy = 0;   // J: the smallest sum of what went into the renderer; negative: generated
  double largest_force = 0;  // N
  double largest_step = 0;   // N: change of the force from one tick to the next
  double peak_to_peak = 0;   // m, in the last tenth: a hand at rest is at rest
  double depth_at_end = 0;   // m, from the hand to the proxy
  double force_at_end = 0;   // N
  bool faulted = false;
};

// Moves the hand of a rig (drive pose, scale 1) for `ticks` periods; `wanted`: where its owner wants it after t
// seconds. A force that the tick has written takes effect one period later; the device holds it until the next.
HandRun run_hand(Rig& rig, const HandParameters& hand, int ticks, const std::function<Eigen::Vector3d(double)>& wanted);

// A press onto a wall at z = 0 from 10 mm above, held, at that depth below it; the wall is `stiffness` N/m.
HandRun press_wall(const HapticSettings& settings, const HandParameters& hand, double depth, double seconds);

}  // namespace cellmirror::haptics::test_rig
