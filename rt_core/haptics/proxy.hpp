// The proxy: position of the instrument's tip. It follows the hand, stops at every constraint, and sticks by friction.
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
  // Vector from the hand to the proxy, as far as a contact supports it: the extension of the spring. m, world.
  Eigen::Vector3d elongation = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit vector, against the sum of the pressures; zero: no contact
  NearestPoint held;                                 // by which constraints; multipliers as the spring feels them
  std::uint8_t contacts = 0;
  bool arrived = false;  // the proxy position is valid: neither too far away nor limited by `reach`
};

class Proxy {
 public:
  // Sets it without checks and resets the force. There is no force until it has arrived at the hand and, in contact,
  // two successive models have a valid position, since deep bodies are found incrementally. A hand inside a body then
  // feels only further pressing: the initial depth counts as zero, and shrinks as the hand comes out.
  void start(const Eigen::Vector3d& x) CELL_RT;

  // `model` null: nothing is known, so nothing is in the way. `longest_step` (m): what it may move in this tick.
  ProxyContact follow(const ContactModel* model, const Eigen::Vector3d& hand, const Friction& friction,
                      double longest_step) CELL_RT;

  // The position that the instrument's tip has reached (limits of joints).
  void settle_at(const Eigen::Vector3d& x) CELL_RT { x_ = x; }

  [[nodiscard]] const Eigen::Vector3d& x() const CELL_RT { return x_; }
  [[nodiscard]] bool sticking() const CELL_RT { return sticking_; }
  [[nodiscard]] bool approaching() const CELL_RT { return approaching_; }

  // All that the next ticks depend on, for a recording of the tick (rt_core/base/state_bytes.hpp).
  template <class Archive>
  void transfer(Archive& archive) CELL_RT {
    archive(x_, sticking_, approaching_, settled_, looked_at_, forgiven_depth_);
  }

 private:
  ProxyContact press(const ContactModel& model, const Eigen::Vector3d& hand, const Friction& friction,
                     Eigen::Vector3d& target) CELL_RT;
  ProxyContact jammed(const Eigen::Vector3d& hand) CELL_RT;
  double felt_share(double depth) CELL_RT;
  void settle(const ContactModel& model) CELL_RT;
  Eigen::Vector3d stick(const ContactModel& model, const NearestPoint& nearest, double limit_at_rest,
                        double limit_sliding) CELL_RT;

  Eigen::Vector3d x_ = Eigen::Vector3d::Zero();
  bool sticking_ = false;
  bool approaching_ = true;
  unsigned settled_ = 0;         // successive models that did not move it
  std::uint64_t looked_at_ = 0;  // sequence of the last of them
  double forgiven_depth_ = 0;    // m
};

}  // namespace cellmirror::haptics
