// Any bytes as a component file: findings or a component, never a crash. A component without findings is built into a
// cell, so that what the parser lets through is safe for the model.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "config/parse.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/cell/cell.hpp"

namespace {

class NoFiles final : public cellmirror::ComponentSource {
 public:
  cellmirror::Result<std::shared_ptr<const cellmirror::Component>> component(std::string_view) override {
    return cellmirror::fail("no file");
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  Diagnostics diagnostics;
  auto component = parse_component({reinterpret_cast<const char*>(data), size}, "fuzz.mpc", AnyFile(), diagnostics);
  CELLMIRROR_EXPECTS(component.has_value() || !diagnostics.ok());
  if (!component || !diagnostics.ok()) return 0;
  const auto cell =
      Cell::build(std::make_shared<const Component>(std::move(*component)), std::make_shared<NoFiles>(), diagnostics);
  CELLMIRROR_EXPECTS(cell.has_value() == diagnostics.ok());
  if (!cell) return 0;
  const auto picture = cell->compile();
  CellPoses poses;
  compute_poses(*picture, cell->start_positions(), poses);
  for (const std::string& path : *picture->paths) static_cast<void>(cell->find(path));
  return 0;
}
