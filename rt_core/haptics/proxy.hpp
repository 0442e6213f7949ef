// The proxy: where the instrument's tip stands. It follows the hand, stops at every constraint, and clings by friction.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "rt_core/base/real_time.hpp"
#include "rt_core/haptics/contact_model.hpp"
#include "rt_core/haptics/nearest_point.hpp"

namespace cellmirror::haptics {

struct Friction {  // coefficients of Coulomb's law
  double at_rest = 0;
  double sliding = 0;
};

// What one tick of following gave.
struct ProxyContact {
  // From the hand to the proxy, as far as a contact bears it: what the spring between them feels. m, world.
  Eigen::Vector3d elongation = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit vector, against the sum of the pressures; zero: no contact
  NearestPoint held;                                 // by which constraints; multipliers as the spring feels them
  std::uint8_t contacts = 0;
  bool arrived = false;  // the proxy stands where it belongs: it was neither too far away nor held back by `reach`
};

class Proxy {
 public:
  // Puts it there without asking; what was felt before is forgotten. Until it has arrived at the hand, and where it
  // touches something two models in a row have found it well placed, nothing is felt: what lies deep around it shows
  // only bit by bit. A hand that is inside of a body then feels it only when it presses on: the depth at which it began
  // counts as none, and shrinks as the hand comes out.
  void start(const Eigen::Vector3d& x) CELL_RT;

  // `model` null: nothing is known, so nothing is in the way. `longest_step` (m): what it may move in this tick.
  ProxyContact follow(const ContactModel* model, const Eigen::Vector3d& hand, const Friction& friction,
                      double longest_step) CELL_RT;

  // Where the instrument's tip really came to stand (limits of joints).
  void settle_at(const Eigen::Vector3d& x) CELL_RT { x_ = x; }

  [[nodiscard]] const Eigen::Vector3d& x() const CELL_RT { return x_; }
  [[nodiscard]] bool sticking() const CELL_RT { return sticking_; }
  [[nodiscard]] bool approaching() const CELL_RT { return approaching_; }

 private:
  ProxyContact press(const ContactModel& model, const Eigen::Vector3d& hand, const Friction& friction,
                     Eigen::Vector3d& target) CELL_RT;
  ProxyContact jammed(const Eigen::Vector3d& hand) CELL_RT;
  double felt_share(double depth) CELL_RT;
  void settle(const ContactModel& model) CELL_RT;
  Eigen::Vector3d cling(const ContactModel& model, const NearestPoint& nearest, double limit_at_rest,
                        double limit_sliding) CELL_RT;

  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  bool sticking_ = false;
  bool approaching_ = true;
  int settled_ = 0;              // models in a row that left it where it stood
  std::uint64_t looked_at_ = 0;  // sequence of the last of them
  double forgiven_depth_ = 0;    // m
};

}  // namespace cellmirror::haptics
