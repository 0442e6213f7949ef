#include "sim_devices/haptic/haptic_device.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::sim {
namespace {

double at_resolution(double value, double resolution) {
  return resolution > 0 ? resolution * std::round(value / resolution) : value;
}

}  // namespace

HapticDevice::HapticDevice(const HapticOptions& options)
    : options_(options),
      layout_(options.axes),
      hand_(layout_, options.hand, options.start),
      player_(options.motion, options.start, options.repeat) {}

const HapticSample& HapticDevice::step(const HapticOutput& answer, Timestamp now, double since_start, double dt) {
  since_start_ = since_start;
  efforts_ = layout_.efforts(answer);
  const HandTarget& wish = player_.step(hand_.coordinates(), efforts_, dt);
  Coordinates begin = wish.position;
  for (std::size_t i = 0; i < begin.size(); ++i) begin[i] -= wish.rate[i] * dt;
  hand_.step(begin, wish.rate, efforts_, wish.holding, dt);
  measure(now);
  healthy_.buttons = wish.buttons;
  sample_ = healthy_;
  struck_ = 0;
  for (std::size_t i = 0; i < options_.faults.size(); ++i) {
    const HapticFaultSpec& fault = options_.faults[i];
    if (since_start < fault.from_s || since_start >= fault.until_s) continue;
    struck_ |= 1U << i;
    if (fault.kind == HapticFaultKind::stuck && !stuck_at_) stuck_at_ = healthy_;
    strike(fault, stuck_at_.value_or(healthy_), sample_);
  }
  if (in_force(HapticFaultKind::stuck) == nullptr) stuck_at_.reset();
  return sample_;
}

bool HapticDevice::add_fault(HapticFaultSpec fault) {
  if (options_.faults.size() >= kMaxFaults) return false;
  fault.from_s += since_start_;
  fault.until_s += since_start_;
  options_.faults.push_back(std::move(fault));
  return true;
}

void HapticDevice::clear_faults() {
  options_.faults.clear();
  struck_ = 0;
}

const HapticFaultSpec* HapticDevice::in_force(HapticFaultKind kind) const {
  for (std::size_t i = 0; i < options_.faults.size(); ++i) {
    if ((struck_ >> i & 1U) != 0 && options_.faults[i].kind == kind) return &options_.faults[i];
  }
  return nullptr;
}

void HapticDevice::measure(Timestamp now) {
  for (std::size_t i = 0; i < layout_.count(); ++i) {
    const bool length = layout_.kind(i) == AxisKind::length;
    measured_[i] =
        at_resolution(hand_.coordinates()[i], length ? options_.length_resolution : options_.angle_resolution);
  }
  healthy_.time = now;
  healthy_.valid = true;
  layout_.show(measured_, healthy_);
}

}  // namespace cellmirror::sim
