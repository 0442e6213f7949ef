#include "app/plot/panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/plot/scale.hpp"

namespace cellmirror::plot {

namespace {

constexpr Colour kGrid{0.90, 0.92, 0.94};
constexpr double kTitleSize = 17;
constexpr double kLabelSize = 15;
constexpr double kTickSize = 13;

// Okabe and Ito, Color Universal Design: eight colours that people with any colour vision can distinguish; without
// black, which is the ink, and yellow, which is weak on white.
constexpr std::array<Colour, 6> kPalette = {{{0.000, 0.447, 0.698},
                                             {0.835, 0.369, 0.000},
                                             {0.000, 0.620, 0.451},
                                             {0.800, 0.475, 0.655},
                                             {0.337, 0.706, 0.914},
                                             {0.902, 0.624, 0.000}}};

Colour colour_of(std::size_t series) { return kPalette[series % kPalette.size()]; }
// After the last colour the first is used again, dashed.
double dash_of(std::size_t series) {
  const std::size_t round = series / kPalette.size();
  return 4.0 * static_cast<double>(round);
}

class PanelDrawing {
 public:
  PanelDrawing(Canvas& canvas, const Rectangle& area, const Sides& sides, const Panel& panel)
      : canvas_(canvas),
        panel_(panel),
        plot_(fitted(inner(area, sides), panel)),
        x_(panel.x, values_of_x(), ticks_in(plot_.width, 90)),
        bars_(bars()),
        y_(y_axis(), values_of_y(), ticks_in(plot_.height, 45)) {}

  void draw(const Rectangle& area) {
    draw_grid();
    canvas_.clip(plot_);
    draw_image();
    for (const auto& bars : bars_) draw_bars(bars);
    for (const Bar& bar : panel_.bars) draw_bar(bar);
    for (std::size_t i = 0; i < panel_.lines.size(); ++i) draw_line(panel_.lines[i], i);
    canvas_.unclip();
    draw_marks();
    draw_words(area);
    draw_legend();
  }

 private:
  static std::size_t ticks_in(double pixels, double pixels_each) {
    return std::max<std::size_t>(static_cast<std::size_t>(std::max(pixels, 0.0) / pixels_each), 2);
  }

  [[nodiscard]] static Rectangle inner(const Rectangle& area, const Sides& sides) {
    constexpr double kTop = 44, kBottom = 68;
    return {area.x + sides.left, area.y + kTop, std::max(area.width - sides.left - sides.right, 10.0),
            std::max(area.height - kTop - kBottom, 10.0)};
  }

  // With an image, x and y have the same scale.
  [[nodiscard]] static Rectangle fitted(Rectangle plot, const Panel& panel) {
    const double width = panel.x.high - panel.x.low;
    const double height = panel.y.high - panel.y.low;
    if (panel.image.grey.empty() || !(width > 0) || !(height > 0)) return plot;
    const double scale = std::min(plot.width / width, plot.height / height);
    plot.y += plot.height - scale * height;
    plot.width = std::max(scale * width, 10.0);
    plot.height = std::max(scale * height, 10.0);
    return plot;
  }

  void draw_image() {
    const Image& image = panel_.image;
    if (image.grey.empty()) return;
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<std::uint8_t> from_above;
    from_above.reserve(image.grey.size());
    for (std::size_t row = static_cast<std::size_t>(image.height); row-- > 0;) {
      const auto begin = image.grey.begin() + static_cast<std::ptrdiff_t>(row * width);
      from_above.insert(from_above.end(), begin, begin + image.width);
    }
    canvas_.image(plot_, image.width, image.height, from_above);
  }

  [[nodiscard]] std::vector<double> values_of_x() const {
    std::vector<double> values;
    for (const Line& line : panel_.lines) values.insert(values.end(), line.x.begin(), line.x.end());
    for (const Histogram& histogram : panel_.histograms)
      values.insert(values.end(), histogram.values.begin(), histogram.values.end());
    for (const Bar& bar : panel_.bars) values.insert(values.end(), {bar.begin, bar.end});
    if (values.empty()) return values;
    for (const Mark& mark : panel_.marks) values.push_back(mark.x);
    return values;
  }

  [[nodiscard]] std::vector<std::vector<double>> bars() const {
    std::vector<std::vector<double>> out;
    for (const Histogram& histogram : panel_.histograms) out.push_back(counts(histogram, x_));
    return out;
  }

  // Bars stand on zero, and the highest must not touch the upper edge.
  [[nodiscard]] Axis y_axis() const {
    Axis axis = panel_.y;
    if (!panel_.rows.empty()) return {"", false, 0.0, static_cast<double>(panel_.rows.size())};
    if (bars_.empty() || axis.low < axis.high || axis.logarithmic) return axis;
    double highest = 1;
    for (const auto& bars : bars_) highest = std::max(highest, *std::max_element(bars.begin(), bars.end()));
    axis.low = 0;
    axis.high = 1.08 * highest;
    return axis;
  }

  [[nodiscard]] std::vector<double> values_of_y() const {
    std::vector<double> values;
    for (const Line& line : panel_.lines) values.insert(values.end(), line.y.begin(), line.y.end());
    for (const auto& bars : bars_) values.insert(values.end(), bars.begin(), bars.end());
    return values;
  }

  [[nodiscard]] double at_x(double value) const { return plot_.x + x_.fraction(value) * plot_.width; }
  [[nodiscard]] double at_y(double value) const { return plot_.bottom() - y_.fraction(value) * plot_.height; }

  void draw_grid() {
    for (const Tick& tick : x_.ticks()) {
      const double x = at_x(tick.value);
      canvas_.line(x, plot_.y, x, plot_.bottom(), kGrid);
      if (tick.label.empty()) continue;
      canvas_.line(x, plot_.bottom(), x, plot_.bottom() + 5, kFaintInk);
      canvas_.text(x, plot_.bottom() + 21, tick.label, kTickSize, kFaintInk, Anchor::middle);
    }
    for (std::size_t row = 0; row < panel_.rows.size(); ++row) draw_row(row);
    for (const Tick& tick : y_.ticks()) {
      if (!panel_.rows.empty()) break;
      const double y = at_y(tick.value);
      canvas_.line(plot_.x, y, plot_.right(), y, kGrid);
      if (tick.label.empty()) continue;
      canvas_.line(plot_.x - 5, y, plot_.x, y, kFaintInk);
      canvas_.text(plot_.x - 9, y + 0.36 * kTickSize, tick.label, kTickSize, kFaintInk, Anchor::right);
    }
    canvas_.line(plot_.x, plot_.bottom(), plot_.right(), plot_.bottom(), kFaintInk);
    canvas_.line(plot_.x, plot_.y, plot_.x, plot_.bottom(), kFaintInk);
  }

  // Rows count from above.
  [[nodiscard]] double at_row(double row) const {
    return plot_.y + row * plot_.height / static_cast<double>(panel_.rows.size());
  }

  void draw_row(std::size_t row) {
    const double top = at_row(static_cast<double>(row));
    const double middle = at_row(static_cast<double>(row) + 0.5);
    canvas_.line(plot_.x, top, plot_.right(), top, kGrid);
    canvas_.text(plot_.x - 9, middle + 0.36 * kTickSize, panel_.rows[row], kTickSize, kInk, Anchor::right);
  }

  void draw_bar(const Bar& bar) {
    if (bar.row >= panel_.rows.size() || !std::isfinite(bar.begin) || !std::isfinite(bar.end)) return;
    Colour colour = colour_of(bar.colour);
    colour.alpha = 0.85;
    const double left = at_x(bar.begin);
    const double top = at_row(static_cast<double>(bar.row) + bar.top);
    const double bottom = at_row(static_cast<double>(bar.row) + bar.bottom);
    // Neighbours stay apart, and what is there at all stays visible.
    const double width = std::max(at_x(bar.end) - left - 1.0, 1.0);
    canvas_.fill({left, top, width, bottom - top}, colour);
    if (bar.label.empty() || canvas_.text_width(bar.label, kTickSize) + 8 > width || bottom - top < kTickSize) return;
    canvas_.text(left + 4, 0.5 * (top + bottom) + 0.36 * kTickSize, bar.label, kTickSize, kBackground);
  }

  void draw_bars(const std::vector<double>& bars) {
    Colour colour = colour_of(0);
    colour.alpha = 0.85;
    const double width = plot_.width / static_cast<double>(bars.size());
    for (std::size_t i = 0; i < bars.size(); ++i) {
      if (bars[i] <= 0.0) continue;
      // What is there at all stays visible beside high bars.
      const double top = std::min(at_y(bars[i]), plot_.bottom() - 1.0);
      const double left = plot_.x + width * static_cast<double>(i);
      canvas_.fill({left, top, std::max(width - 1.0, 1.0), plot_.bottom() - top}, colour);
    }
  }

  // Of the points that fall into one column of pixels only the first, the highest, the lowest and the last are drawn:
  // the picture is the same, and a million points cost no more than thousands.
  void draw_line(const Line& line, std::size_t series) {
    canvas_.begin_path(colour_of(series), 2.0, dash_of(series));
    const std::size_t count = std::min(line.x.size(), line.y.size());
    bool pen_down = false;
    for (std::size_t i = 0; i < count;) {
      if (!std::isfinite(line.x[i]) || !std::isfinite(line.y[i])) {
        pen_down = false;
        ++i;
        continue;
      }
      const double column = std::floor(at_x(line.x[i]));
      const double first = at_y(line.y[i]);
      double lowest = first, highest = first, last = first;
      const double x = at_x(line.x[i]);
      double last_x = x;
      for (++i; i < count && std::isfinite(line.x[i]) && std::isfinite(line.y[i]); ++i) {
        last_x = at_x(line.x[i]);
        if (std::floor(last_x) != column) break;
        last = at_y(line.y[i]);
        lowest = std::min(lowest, last);
        highest = std::max(highest, last);
      }
      pen_down ? canvas_.line_to(x, first) : canvas_.move_to(x, first);
      pen_down = true;
      if (lowest != first) canvas_.line_to(x, lowest);
      if (highest != first) canvas_.line_to(x, highest);
      canvas_.line_to(x, last);
    }
    canvas_.end_path();
  }

  void draw_marks() {
    constexpr double kLineHeight = 18;
    double y = plot_.y + kTickSize + 3;
    for (std::size_t i = 0; i < panel_.marks.size(); ++i) {
      const Mark& mark = panel_.marks[i];
      const Colour colour = colour_of(i + 1);
      const double x = at_x(mark.x);
      canvas_.line(x, plot_.y, x, plot_.bottom(), colour, 1.5, 5.0);
      const double width = canvas_.text_width(mark.label, kTickSize);
      const bool fits = x + 8 + width < plot_.right();
      const double left = fits ? x + 6 : x - 6 - width;
      Colour paper = kBackground;
      paper.alpha = 0.85;
      canvas_.fill({left - 2, y - kTickSize, width + 4, kTickSize + 5}, paper);
      canvas_.text(left, y, mark.label, kTickSize, kInk);
      y += kLineHeight;
    }
  }

  void draw_words(const Rectangle& area) {
    canvas_.text(plot_.x, area.y + 28, panel_.title, kTitleSize, kInk, Anchor::left, true);
    canvas_.text(plot_.x + 0.5 * plot_.width, plot_.bottom() + 47, panel_.x.label, kLabelSize, kInk, Anchor::middle);
    canvas_.upright_text(area.x + 24, plot_.y + 0.5 * plot_.height, panel_.y.label, kLabelSize, kInk);
    if (values_of_x().empty() && panel_.image.grey.empty())
      canvas_.text(plot_.x + 0.5 * plot_.width, plot_.y + 0.5 * plot_.height, "no data", kLabelSize, kFaintInk,
                   Anchor::middle);
  }

  void draw_legend() {
    double y = plot_.y + 10;
    for (std::size_t i = 0; i < panel_.lines.size(); ++i) {
      if (panel_.lines[i].label.empty() || y > plot_.bottom()) continue;
      canvas_.line(plot_.right() + 12, y, plot_.right() + 38, y, colour_of(i), 2.5, dash_of(i));
      canvas_.text(plot_.right() + 45, y + 0.36 * kTickSize, panel_.lines[i].label, kTickSize, kInk);
      y += 21;
    }
  }

  Canvas& canvas_;
  const Panel& panel_;
  Rectangle plot_;
  Scale x_;
  std::vector<std::vector<double>> bars_;
  Scale y_;
};

}  // namespace

Sides sides_of(Canvas& canvas, const Panel& panel) {
  constexpr double kLeft = 92, kRight = 26;
  Sides sides{kLeft, kRight};
  for (const std::string& row : panel.rows) sides.left = std::max(sides.left, canvas.text_width(row, kTickSize) + 24);
  for (const Line& line : panel.lines) {
    if (!line.label.empty())
      sides.right = std::max(sides.right, kRight + 48 + canvas.text_width(line.label, kTickSize));
  }
  return sides;
}

void draw_panel(Canvas& canvas, const Rectangle& area, const Sides& sides, const Panel& panel) {
  PanelDrawing(canvas, area, sides, panel).draw(area);
}

}  // namespace cellmirror::plot
