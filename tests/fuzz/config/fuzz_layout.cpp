// Any bytes as a layout file: findings, or a layout that every display can be drawn with.
#include <cstddef>
#include <cstdint>

#include "config/layout_file.hpp"
#include "rt_core/base/contract.hpp"
#include "rt_core/cell/view.hpp"

namespace {

using namespace cellmirror;

bool lies_in_the_picture(const LayoutPane& pane) {
  return pane.left >= 0 && pane.top >= 0 && pane.width >= kSmallestPane && pane.height >= kSmallestPane &&
         pane.left + pane.width <= 1 + kPaneTolerance && pane.top + pane.height <= 1 + kPaneTolerance;
}

// Along one axis both begin before the other one ends.
bool meet(double begin_a, double size_a, double begin_b, double size_b) {
  return begin_a + size_a > begin_b + kPaneTolerance && begin_b + size_b > begin_a + kPaneTolerance;
}

void check_display(const LayoutDisplay& display) {
  CELLMIRROR_EXPECTS(!display.name.empty() && display.name.size() <= kLongestLayoutName);
  CELLMIRROR_EXPECTS(!display.panes.empty() && display.panes.size() <= kViews);
  for (std::size_t i = 0; i < display.panes.size(); ++i) {
    const LayoutPane& pane = display.panes[i];
    CELLMIRROR_EXPECTS(check_view_id(pane.view).has_value());
    CELLMIRROR_EXPECTS(lies_in_the_picture(pane));
    for (std::size_t k = 0; k < i; ++k) {
      const LayoutPane& other = display.panes[k];
      CELLMIRROR_EXPECTS(pane.view != other.view);
      CELLMIRROR_EXPECTS(!(meet(pane.left, pane.width, other.left, other.width) &&
                           meet(pane.top, pane.height, other.top, other.height)));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Diagnostics diagnostics;
  const auto layout = parse_layout({reinterpret_cast<const char*>(data), size}, "fuzz.lay", diagnostics);
  CELLMIRROR_EXPECTS(layout.has_value() == diagnostics.ok());
  if (!layout) return 0;
  for (const LayoutDisplay& display : layout->displays) check_display(display);
  for (const View& view : views_of_extent(Extent{}, *layout)) CELLMIRROR_EXPECTS(check_view(0, view).has_value());
  return 0;
}
