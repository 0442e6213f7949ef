// Motions and faults of sim_haptic: whatever is written, it is refused with words, or it can be played.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "sim_devices/haptic/haptic_device.hpp"

namespace {

using namespace cellmirror;

// A wall that pushes back, for a second: the hand stays somewhere.
void play(sim::HapticOptions options) {
  sim::HapticDevice device(options);
  HapticOutput answer;
  answer.joint_count = 5;
  for (int i = 0; i < 200; ++i) {
    const HapticSample& sample = device.step(answer, Timestamp{i + 1}, i * 5e-3, 5e-3);
    for (std::size_t axis = 0; axis < device.layout().count(); ++axis) {
      if (!std::isfinite(device.hand().coordinates()[axis])) std::abort();
      answer.joint_torques[axis] = -std::fmin(10.0, std::fmax(-10.0, 10 * device.measured()[axis]));
    }
    answer.force_D = {answer.joint_torques[0], answer.joint_torques[1], answer.joint_torques[2]};
    if (sample.axis_count != options.axes) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto fault = sim::parse_haptic_fault(text); !fault && fault.error().what.empty()) std::abort();
  for (std::size_t axes = 4; axes <= kMaxHapticAxes; ++axes) {
    Diagnostics diagnostics;
    sim::HapticOptions options;
    options.axes = axes;
    options.motion = sim::parse_motion(text, "fuzz", sim::AxisLayout(axes), diagnostics);
    if (const auto fault = sim::parse_haptic_fault(text.substr(0, text.find(';'))); fault)
      options.faults.push_back(*fault);
    if (options.motion.size() > sim::kMaxMotionSteps) std::abort();
    if (diagnostics.ok()) play(std::move(options));
  }
  return 0;
}
