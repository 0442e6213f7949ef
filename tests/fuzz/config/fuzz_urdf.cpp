// Any bytes as a URDF: findings or a component that makes a cell, never a crash.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "config/parse.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/cell/cell.hpp"
#include "rt_core/cell/robot_chain.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Diagnostics of_chain;
  const auto chain = parse_urdf_between(text, "fuzz.urdf", "base_link", "tool0", of_chain);
  CELLMIRROR_EXPECTS(chain.has_value() || !of_chain.ok());
  if (chain) (void)chain_between(*chain, "base_link", "tool0");
  Diagnostics diagnostics;
  auto component = parse_urdf(text, "fuzz.urdf", "/fuzz.urdf", AnyFile(), diagnostics);
  CELLMIRROR_EXPECTS(component.has_value() || !diagnostics.ok());
  if (!component || !diagnostics.ok()) return 0;
  const auto cell = Cell::build(std::make_shared<const Component>(std::move(*component)), nullptr, diagnostics);
  CELLMIRROR_EXPECTS(cell.has_value() == diagnostics.ok());
  if (!cell) return 0;
  CellPoses poses;
  compute_poses(*cell->compile(), cell->start_positions(), poses);
  return 0;
}
