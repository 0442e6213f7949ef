#include "rt_core/haptics/proxy.hpp"

#include <algorithm>
#include <cmath>

#include "rt_core/haptics/appearance.hpp"

namespace cellmirror::haptics {

namespace {

constexpr double kSame = 1e-9;        // m
constexpr double kPlaced = 1e-4;      // m: deeper inside, a tip that begins is not where it belongs
constexpr unsigned kModelsAgree = 2;  // the first of them may be of the posture before

// Moves `target` back towards `from` until it is within `longest` of it.
bool shorten(const Eigen::Vector3d& from, double longest, Eigen::Vector3d& target) CELL_RT {
  const Eigen::Vector3d way = target - from;
  const double length = way.norm();
  if (length <= longest) return false;
  target = from + way * (longest / length);
  return true;
}

}  // namespace

void Proxy::start(const Eigen::Vector3d& x) CELL_RT {
  x_ = x;
  sticking_ = false;
  approaching_ = true;
  forgiven_depth_ = 0;
  settled_ = 0;
}

void Proxy::settle(const ContactModel& model) CELL_RT {
  if (model.sequence == looked_at_) return;
  looked_at_ = model.sequence;
  settled_ = tip_depth(model, x_) <= kPlaced ? std::min(settled_ + 1, kModelsAgree) : 0U;
}

// The share of a depth that is felt: what is beyond the depth at which the engagement began.
double Proxy::felt_share(double depth) CELL_RT {
  forgiven_depth_ = approaching_ ? depth : std::min(forgiven_depth_, depth);
  return depth > 0 ? (depth - forgiven_depth_) / depth : 0.0;
}

// Where friction holds the proxy back. The spring pulls it along the surface by the distance between its position and
// the position without friction; up to `limit_at_rest` it sticks, beyond that it slides until `limit_sliding` is left
// (Salisbury, Tarr, ASME DSC 61, 1997; Hayward, Armstrong, Experimental Robotics VI, 2000). Both limits are m:
// coefficient times the depth that is felt.
Eigen::Vector3d Proxy::stick(const ContactModel& model, const NearestPoint& nearest, double limit_at_rest,
                             double limit_sliding) CELL_RT {
  const Eigen::Vector3d back = held_directions(model, nearest).free_part(x_ - nearest.x);
  const double length = back.norm();
  sticking_ = length <= (sticking_ ? limit_at_rest : limit_sliding);
  if (sticking_ || length <= kSame) return back;
  return back * (limit_sliding / length);
}

// Constraints that no point meets: the tip is clamped, and stays where it is.
ProxyContact Proxy::jammed(const Eigen::Vector3d& hand) CELL_RT {
  ProxyContact contact;
  contact.held.found = false;
  const Eigen::Vector3d way = x_ - hand;
  const double depth = way.norm();
  contact.elongation = way * felt_share(depth);
  if (depth > kSame) {
    contact.contacts = 1;
    contact.normal = way / depth;
  }
  return contact;
}

ProxyContact Proxy::press(const ContactModel& model, const Eigen::Vector3d& hand, const Friction& friction,
                          Eigen::Vector3d& target) CELL_RT {
  NearestPoint nearest = nearest_point(model, hand);
  if (!nearest.found) {
    target = x_;
    return jammed(hand);
  }
  target = nearest.x;
  ProxyContact contact;
  const Eigen::Vector3d push = nearest.x - hand;
  const double depth = push.norm();
  const double share = felt_share(depth);
  if (nearest.active_count == 0 || depth <= 0) {
    sticking_ = false;
    return contact;
  }
  double pressure = 0;  // sum of the normals' shares, m
  for (std::size_t k = 0; k < nearest.active_count; ++k) {
    nearest.multiplier[k] *= share;
    pressure += nearest.multiplier[k] * model.constraints[nearest.active[k]].a.norm();
  }
  contact.held = nearest;
  contact.contacts = nearest.active_count;
  contact.normal = push / depth;
  const Eigen::Vector3d back = stick(model, nearest, friction.at_rest * pressure, friction.sliding * pressure);
  contact.elongation = push * share;
  if (back.squaredNorm() > 0) {
    // Friction may not hold the proxy in a place that another constraint forbids.
    const NearestPoint clung = nearest_point(model, nearest.x + back);
    if (clung.found) {
      target = clung.x;
      contact.elongation += held_directions(model, nearest).free_part(clung.x - nearest.x);
    }
  }
  return contact;
}

ProxyContact Proxy::follow(const ContactModel* model, const Eigen::Vector3d& hand, const Friction& friction,
                           double longest_step) CELL_RT {
  ProxyContact contact;
  Eigen::Vector3d target = hand;
  if (model != nullptr && approaching_) settle(*model);
  if (model != nullptr) contact = press(*model, hand, friction, target);
  bool held_back = shorten(x_, longest_step, target);
  // Beyond its reach the model has no obstacles.
  if (model != nullptr && model->reach > 0 && shorten(model->x_ref, model->reach, target)) {
    held_back = true;
    const NearestPoint allowed = nearest_point(*model, target);
    if (allowed.found) target = allowed.x;
  }
  contact.arrived = !held_back;
  if (approaching_) {
    approaching_ = held_back || (contact.contacts > 0 && settled_ < kModelsAgree);
    contact.elongation.setZero();
  }
  x_ = target;
  return contact;
}

}  // namespace cellmirror::haptics
