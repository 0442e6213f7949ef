// Figures of measurements as PNG: histograms and lines in panels with axes, units and a legend. What is drawn is plain
// data; the drawing library stays inside this folder.
#pragma once

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

struct Panel {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Histogram> histograms;
  std::vector<Line> lines;
  std::vector<Mark> marks;
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
