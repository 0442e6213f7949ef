// Any bytes as a URDF: findings or a component that makes a cell, never a crash.
#include <cstddef>
#include <cstdint>
#include <memory>

#include "config/parse.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/cell/cell.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  Diagnostics diagnostics;
  auto component =
      parse_urdf({reinterpret_cast<const char*>(data), size}, "fuzz.urdf", "/fuzz.urdf", AnyFile(), diagnostics);
  CELLMIRROR_EXPECTS(component.has_value() || !diagnostics.ok());
  if (!component || !diagnostics.ok()) return 0;
  const auto cell = Cell::build(std::make_shared<const Component>(std::move(*component)), nullptr, diagnostics);
  CELLMIRROR_EXPECTS(cell.has_value() == diagnostics.ok());
  if (!cell) return 0;
  CellPoses poses;
  compute_poses(*cell->compile(), cell->start_positions(), poses);
  return 0;
}
