// The few things that are drawn, on a picture in memory. Private to this folder, as the drawing library is.
#pragma once

#include <cairo.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "rt_core/base/result.hpp"

namespace cellmirror::plot {

struct Colour {
  double red, green, blue;  // 0..1
  double alpha = 1.0;
};

struct Rectangle {
  double x, y, width, height;  // pixels; y downwards

  [[nodiscard]] double right() const { return x + width; }
  [[nodiscard]] double bottom() const { return y + height; }
};

enum class Anchor { left, middle, right };

class Canvas {
 public:
  Canvas(int width, int height, Colour background);

  void fill(const Rectangle& area, Colour colour);
  // `dash`: pixels on and off; 0: a solid line. Lines that run along an axis are kept on whole pixels.
  void line(double x1, double y1, double x2, double y2, Colour colour, double width = 1.0, double dash = 0.0);
  void begin_path(Colour colour, double width, double dash);
  void move_to(double x, double y) { cairo_move_to(context_.get(), x, y); }
  void line_to(double x, double y) { cairo_line_to(context_.get(), x, y); }
  void end_path() { cairo_stroke(context_.get()); }
  // `grey`: width x height values, row by row from above.
  void image(const Rectangle& area, int width, int height, std::span<const std::uint8_t> grey);
  void clip(const Rectangle& area);
  void unclip() { cairo_reset_clip(context_.get()); }

  // UTF-8; y is the base line.
  void text(double x, double y, const std::string& words, double size, Colour colour, Anchor anchor = Anchor::left,
            bool bold = false);
  // Upwards, centred at (x, y).
  void upright_text(double x, double y, const std::string& words, double size, Colour colour);
  [[nodiscard]] double text_width(const std::string& words, double size, bool bold = false);

  [[nodiscard]] Result<std::string> png() const;

 private:
  struct Release {
    void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
    void operator()(cairo_t* context) const { cairo_destroy(context); }
  };
  void colour(Colour colour);
  void font(double size, bool bold);

  std::unique_ptr<cairo_surface_t, Release> surface_;
  std::unique_ptr<cairo_t, Release> context_;
};

}  // namespace cellmirror::plot
