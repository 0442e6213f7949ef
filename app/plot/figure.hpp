// Figures of measurements as PNG: histograms and lines in panels with axes, units and a legend. What is drawn is plain
// data; the drawing library stays inside this folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "rt_core/base/result.hpp"

namespace cellmirror::plot {

struct Axis {
  std::string label;  // with its unit: "time [us]"
  bool logarithmic = false;
  // The range where it is not to be that of the data. Equal: that of the data.
  double low = 0;
  double high = 0;
};

// Values that are not finite leave a gap.
struct Line {
  std::string label;  // for the legend; empty: not in it
  std::vector<double> x;
  std::vector<double> y;  // of the same length
};

// How often a value occurs; bins are as wide as each other on the axis as it is drawn.
struct Histogram {
  std::vector<double> values;
  std::size_t bins = 60;
};

// A vertical line with a word beside it: a median, a limit.
struct Mark {
  double x = 0;
  std::string label;
};

// From `begin` to `end` on the x axis, in a row of its panel; as high as the part of the row from `top` to `bottom`
// (0..1).
struct Bar {
  std::size_t row = 0;
  double begin = 0;
  double end = 0;
  std::size_t colour = 0;  // as the lines of a panel are coloured, by number
  std::string label = {};  // shown where it fits into the bar
  double top = 0.1;
  double bottom = 0.9;
};

// Shades of grey over the whole of a panel, whose axes say their ranges; as wide as high in the units of the axes.
struct Image {
  int width = 0;  // pixels
  int height = 0;
  std::vector<std::uint8_t> grey;  // row by row from below: x + width * y
};

struct Panel {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Histogram> histograms;
  std::vector<Line> lines;
  std::vector<Mark> marks;
  // A panel with rows shows bars over x instead of values over y: the names of the rows from above to below, and the
  // bars.
  std::vector<std::string> rows = {};
  std::vector<Bar> bars = {};
  Image image = {};  // without pixels: none
};

struct Figure {
  std::string title;
  std::string subtitle;
  std::vector<Panel> panels;  // row by row
  std::size_t columns = 2;
  int panel_width = 800;  // pixels
  int panel_height = 440;
};

// The bytes of a PNG file. Refused: no panel, and more pixels than a picture may have (kMostPixels).
inline constexpr double kMostPixels = 64e6;
[[nodiscard]] Result<std::string> png_of(const Figure& figure);

// Writes it; an existing file is replaced as a whole or left as it is.
[[nodiscard]] Result<void> write_png(const Figure& figure, const std::string& path);

}  // namespace cellmirror::plot
