// Draws one panel. Private to this folder.
#pragma once

#include "app/plot/canvas.hpp"
#include "app/plot/figure.hpp"

namespace cellmirror::plot {

inline constexpr Colour kBackground{1.0, 1.0, 1.0};
inline constexpr Colour kInk{0.13, 0.16, 0.20};
inline constexpr Colour kFaintInk{0.36, 0.40, 0.45};

// What a panel needs beside its axes, in pixels: on the left for the words of the y axis, on the right for the legend.
struct Sides {
  double left = 0;
  double right = 0;
};
[[nodiscard]] Sides sides_of(Canvas& canvas, const Panel& panel);

void draw_panel(Canvas& canvas, const Rectangle& area, const Sides& sides, const Panel& panel);

}  // namespace cellmirror::plot
