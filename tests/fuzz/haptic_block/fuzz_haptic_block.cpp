// The input is what a peer left in the memory: reading ends, gives plain values or nothing, and the gateway's own
// writing heals its section whatever stood there.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "ipc/wire/haptic_block.hpp"
#include "rt_core/base/contract.hpp"

namespace {

using namespace cellmirror;

constexpr std::size_t kMost = haptic_block_offset::kSize + 64;
struct alignas(8) Memory {
  std::array<std::byte, kMost> bytes{};
};

void read_everything(std::span<const std::byte> memory) {
  std::uint64_t last = 0;
  HapticSample sample;
  const HapticRead read = read_haptic_sample(memory, last, sample);
  CELLMIRROR_EXPECTS(sample.axis_count <= kMaxHapticAxes);
  CELLMIRROR_EXPECTS((read == HapticRead::fresh) == (last != 0));
  CELLMIRROR_EXPECTS(last % 2 == 0 && sample.time.ns >= 0);
  if (read == HapticRead::fresh) {
    CELLMIRROR_EXPECTS(read_haptic_sample(memory, last, sample) == HapticRead::unchanged);
  }
  HapticOutput output;
  static_cast<void>(read_haptic_output(memory, output));
  CELLMIRROR_EXPECTS(output.joint_count <= kMaxJointsPerRobot);
  static_cast<void>(haptic_block_gateway(memory));
}

// What the device finds after a tick: finite, and as it was meant where that was finite.
void write_and_read(std::span<std::byte> memory, const HapticOutput& output) {
  restore_haptic_header(memory, output.joint_count, 77);
  write_haptic_output(memory, output);
  HapticOutput felt;
  const bool felt_anything = read_haptic_output(memory, felt);
  CELLMIRROR_EXPECTS(felt_anything == (memory.size() >= haptic_block_offset::kSize));
  CELLMIRROR_EXPECTS(felt.force_E.allFinite() && felt.force_D.allFinite() && felt.torque_D.allFinite());
  CELLMIRROR_EXPECTS(std::isfinite(felt.gripper_torque) && std::isfinite(felt.max_force));
  CELLMIRROR_EXPECTS(std::all_of(felt.joint_torques.begin(), felt.joint_torques.end(),
                                 [](double torque) { return std::isfinite(torque); }));
  if (felt_anything) CELLMIRROR_EXPECTS(felt.sequence == output.sequence && haptic_block_gateway(memory) == 77);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Memory block;
  const std::size_t used = std::min(size, kMost);
  if (used > 0) std::memcpy(block.bytes.data(), data, used);
  const auto memory = std::span(block.bytes).first(used);
  read_everything(memory);

  // The input's numbers as forces too: of any size and kind.
  HapticOutput output;
  double number = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (8 * i + 8 <= used) std::memcpy(&number, block.bytes.data() + 8 * i, 8);
    output.force_D[static_cast<int>(i)] = output.force_E[static_cast<int>(2 - i)] = output.joint_torques[i] = number;
  }
  output.sequence = used;
  output.joint_count = used == 0 ? 0 : data[0];
  write_and_read(memory, output);
  write_haptic_sample(memory, {});
  read_everything(memory);
  end_haptic_block(memory);
  CELLMIRROR_EXPECTS(haptic_block_gateway(memory) == 0);
  read_everything(memory);
  return 0;
}
