#include "app/plot/canvas.hpp"

#include <cmath>
#include <cstring>
#include <numbers>

#include "rt_core/base/utf8.hpp"

namespace cellmirror::plot {

namespace {

double on_pixel(double at) { return std::floor(at) + 0.5; }

}  // namespace

Canvas::Canvas(int width, int height, Colour background)
    : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)), context_(cairo_create(surface_.get())) {
  fill({0, 0, static_cast<double>(width), static_cast<double>(height)}, background);
}

void Canvas::colour(Colour colour) {
  cairo_set_source_rgba(context_.get(), colour.red, colour.green, colour.blue, colour.alpha);
}

void Canvas::font(double size, bool bold) {
  // Debian's fontconfig brings DejaVu along; where it is missing, fontconfig takes the system's own sans-serif.
  cairo_select_font_face(context_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context_.get(), size);
}

void Canvas::fill(const Rectangle& area, Colour colour_of_area) {
  colour(colour_of_area);
  cairo_rectangle(context_.get(), area.x, area.y, area.width, area.height);
  cairo_fill(context_.get());
}

void Canvas::line(double x1, double y1, double x2, double y2, Colour colour_of_line, double width, double dash) {
  begin_path(colour_of_line, width, dash);
  move_to(x1 == x2 ? on_pixel(x1) : x1, y1 == y2 ? on_pixel(y1) : y1);
  line_to(x1 == x2 ? on_pixel(x2) : x2, y1 == y2 ? on_pixel(y2) : y2);
  end_path();
}

void Canvas::begin_path(Colour colour_of_line, double width, double dash) {
  colour(colour_of_line);
  cairo_set_line_width(context_.get(), width);
  cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(context_.get(), &dash, dash > 0.0 ? 1 : 0, 0.0);
  cairo_new_path(context_.get());
}

void Canvas::image(const Rectangle& area, int width, int height, std::span<const std::uint8_t> grey) {
  const std::unique_ptr<cairo_surface_t, Release> picture(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height));
  if (cairo_surface_status(picture.get()) != CAIRO_STATUS_SUCCESS) return;
  cairo_surface_flush(picture.get());
  unsigned char* rows = cairo_image_surface_get_data(picture.get());
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(picture.get()));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
      const std::uint32_t pixel = 0x010101U * grey[y * static_cast<std::size_t>(width) + x];
      std::memcpy(rows + y * stride + x * sizeof(pixel), &pixel, sizeof(pixel));
    }
  }
  cairo_surface_mark_dirty(picture.get());
  cairo_save(context_.get());
  cairo_translate(context_.get(), area.x, area.y);
  cairo_scale(context_.get(), area.width / width, area.height / height);
  cairo_set_source_surface(context_.get(), picture.get(), 0, 0);
  cairo_pattern_set_extend(cairo_get_source(context_.get()), CAIRO_EXTEND_PAD);
  cairo_rectangle(context_.get(), 0, 0, width, height);
  cairo_fill(context_.get());
  cairo_restore(context_.get());
}

void Canvas::clip(const Rectangle& area) {
  cairo_rectangle(context_.get(), area.x, area.y, area.width, area.height);
  cairo_clip(context_.get());
}

void Canvas::text(double x, double y, const std::string& words, double size, Colour colour_of_text, Anchor anchor,
                  bool bold) {
  const double width = text_width(words, size, bold);
  if (anchor == Anchor::middle) x -= 0.5 * width;
  if (anchor == Anchor::right) x -= width;
  colour(colour_of_text);
  cairo_move_to(context_.get(), x, y);
  // cairo refuses a text with a single byte that is no UTF-8, and draws nothing more.
  cairo_show_text(context_.get(), drawable_utf8(words).c_str());
}

void Canvas::upright_text(double x, double y, const std::string& words, double size, Colour colour_of_text) {
  cairo_save(context_.get());
  cairo_translate(context_.get(), x, y);
  cairo_rotate(context_.get(), -0.5 * std::numbers::pi);
  text(0.0, 0.0, words, size, colour_of_text, Anchor::middle);
  cairo_restore(context_.get());
}

double Canvas::text_width(const std::string& words, double size, bool bold) {
  font(size, bold);
  cairo_text_extents_t extents{};
  cairo_text_extents(context_.get(), drawable_utf8(words).c_str(), &extents);
  return extents.x_advance;
}

Result<std::string> Canvas::png() const {
  std::string bytes;
  const auto append = [](void* closure, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  // A failed call makes the context refuse everything after it, so that asking once at the end is enough.
  cairo_status_t status = cairo_status(context_.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_write_to_png_stream(surface_.get(), append, &bytes);
  if (status != CAIRO_STATUS_SUCCESS)
    return fail(std::string("the plot cannot be drawn: ") + cairo_status_to_string(status));
  return bytes;
}

}  // namespace cellmirror::plot
