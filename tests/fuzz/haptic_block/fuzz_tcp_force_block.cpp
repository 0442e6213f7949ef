// The input is what another process left in the memory: it is read as a block or not at all, and writing heals it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "ipc/wire/tcp_force_block.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  struct alignas(8) {
    std::array<std::byte, tcp_force_block_offset::kSize + 64> bytes{};
  } block;
  const std::size_t used = std::min(size, block.bytes.size());
  if (used > 0) std::memcpy(block.bytes.data(), data, used);
  const auto memory = std::span(block.bytes).first(used);

  TcpForce force;
  const bool read = read_tcp_force(memory, force);
  CELLMIRROR_EXPECTS(!read || used >= tcp_force_block_offset::kSize);
  CELLMIRROR_EXPECTS(force.robot.view().size() <= 64);
  // The input's own numbers, with whatever text it has for a name.
  if (used >= sizeof force.values) std::memcpy(force.values.data(), data, sizeof force.values);
  force.flags |= kTcpForceValid;
  write_tcp_force(memory, force);
  TcpForce again;
  CELLMIRROR_EXPECTS(read_tcp_force(memory, again) == (used >= tcp_force_block_offset::kSize));
  CELLMIRROR_EXPECTS(
      std::all_of(again.values.begin(), again.values.end(), [](float value) { return std::isfinite(value); }));
  CELLMIRROR_EXPECTS(again.robot.view() == force.robot.view().substr(0, 63) || used < tcp_force_block_offset::kSize);
  return 0;
}
