#include "rt_core/tissue/instruments/response.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kSmoothing = 0.3;       // of a new force: about three steps
constexpr double kForget = 0.98;         // a step: about fifty
constexpr double kPriorWay = 2e-4;       // m: ways much smaller than this leave the prior stiffness
constexpr double kSmallestForce = 1e-4;  // N
constexpr double kShortestWay = 1e-5;    // m in a window
constexpr double kLongestWay = 0.005;    // m in a window; farther is a jump

}  // namespace

InstrumentResponse ResponseEstimate::update(const Instrument& instrument, double modulus, double largest_force) {
  InstrumentResponse response;
  response.slot = instrument.slot;
  // The force lags behind by its smoothing, so its place does too: a force of an earlier instant than its place would
  // act as negative damping. Not over a jump.
  const Vector3d tip = instrument.X_end.translation();
  const bool near = samples_ > 0 && (tip - place_).norm() < kLongestWay;
  place_ = near ? Vector3d(place_ + kSmoothing * (tip - place_)) : tip;
  response.x_ref = place_;
  response.contacts = instrument.contacts;
  response.held = static_cast<std::uint32_t>(instrument.held.size());

  force_ += kSmoothing * (instrument.force - force_);
  torque_ += kSmoothing * (instrument.torque - torque_);
  directions_ += kSmoothing * (instrument.directions - directions_);
  const bool touches = instrument.contacts > 0 || response.held > 0;
  const double size = force_.norm();
  if (!touches && size < kSmallestForce) {
    reset();
    return response;
  }
  response.force_W = force_;
  response.torque_W = torque_;
  if (largest_force > 0 && size > largest_force) {
    response.force_W *= largest_force / size;
    response.torque_W *= largest_force / size;
  }
  const Sample now{response.x_ref, force_};
  Sample& oldest = past_.at(samples_ % kWindow);
  if (size > kSmallestForce && samples_ >= kWindow) {
    const Vector3d n = force_ / size;
    const double way = n.dot(now.x - oldest.x);
    // While it rests nothing is learnt, and nothing forgotten.
    if (std::abs(way) > kShortestWay && std::abs(way) < kLongestWay) {
      way_squared_ *= kForget;
      way_force_ *= kForget;
      way_squared_ += way * way;
      way_force_ -= way * n.dot(now.force - oldest.force);
    }
  }
  oldest = now;
  ++samples_;
  if (!touches || size < kSmallestForce) return response;

  // A flat punch of radius a: k = 2 a E / (1 - nu^2); jaws hold a piece of about the effector's length.
  const double radius = response.held > 0 ? 0.5 * instrument.shape.effector_length_m : instrument.contact_radius();
  const double prior = std::clamp(2.0 * radius * modulus, 0.0, kLargestStiffness);
  const double weight = kPriorWay * kPriorWay;
  const double k = std::clamp((way_force_ + prior * weight) / (way_squared_ + weight), 0.0, kLargestStiffness);
  const double trace = directions_.trace();
  if (!(trace > 0)) return response;
  const Vector3d n = force_ / size;
  const Eigen::Matrix3d shares = directions_ / trace;
  const double along = std::max(n.dot(shares * n), 1.0 / 3.0);
  response.stiffness = 0.5 * (k / along) * (shares + shares.transpose());
  // The trace is not less than the largest eigenvalue.
  const double sum = response.stiffness.trace();
  if (sum > kLargestStiffness) response.stiffness *= kLargestStiffness / sum;
  return response;
}

}  // namespace cellmirror::tissue
