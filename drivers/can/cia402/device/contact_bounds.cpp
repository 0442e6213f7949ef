#include "drivers/can/cia402/device/contact_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cellmirror::can {
namespace {

constexpr double kLeastShare = 0.01;

void bound(const DepthRates& rates, const JointVelocities& velocities, JointBounds& bounds) {
  double largest = 0;
  double deepening = 0;  // m/s, of the contact as the joints move now
  for (std::size_t i = 0; i < rates.size(); ++i) {
    largest = std::max(largest, std::abs(rates[i]));
    deepening += rates[i] * velocities[i];
  }
  for (std::size_t i = 0; i < rates.size(); ++i) {
    if (!(std::abs(rates[i]) > kLeastShare * largest)) continue;
    const double others = deepening - rates[i] * velocities[i];
    const double room = std::max(0.0, -others) / std::abs(rates[i]);
    if (rates[i] > 0) {
      bounds[i].upper = std::min(bounds[i].upper, room);
    } else {
      bounds[i].lower = std::max(bounds[i].lower, -room);
    }
  }
}

}  // namespace

JointBounds contact_bounds(const RobotContacts& contacts, const JointVelocities& velocities) {
  JointBounds bounds;
  for (std::size_t i = 0; i < contacts.count; ++i) bound(contacts.rates.at(i), velocities, bounds);
  return bounds;
}

}  // namespace cellmirror::can
