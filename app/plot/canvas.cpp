#include "app/plot/canvas.hpp"

#include <cmath>
#include <numbers>

namespace cellmirror::plot {

namespace {

double on_pixel(double at) { return std::floor(at) + 0.5; }

// How many bytes a character of UTF-8 that begins so has (RFC 3629, 3); 0: none begins so.
std::size_t length_of_character(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  return first >= 0xF0 && first < 0xF5 ? 4 : 0;
}

// Names from files may hold any bytes; cairo refuses a text with a single one that is no UTF-8, and draws nothing more.
std::string drawable(const std::string& words) {
  std::string out;
  for (std::size_t at = 0; at < words.size();) {
    const auto byte = [&words](std::size_t i) { return static_cast<unsigned char>(words[i]); };
    const std::size_t length = length_of_character(byte(at));
    bool good = length > 0 && at + length <= words.size();
    for (std::size_t i = 1; good && i < length; ++i) good = (byte(at + i) & 0xC0U) == 0x80U;
    if (good && length == 3)
      good = !(byte(at) == 0xE0 && byte(at + 1) < 0xA0) && !(byte(at) == 0xED && byte(at + 1) > 0x9F);
    if (good && length == 4)
      good = !(byte(at) == 0xF0 && byte(at + 1) < 0x90) && !(byte(at) == 0xF4 && byte(at + 1) > 0x8F);
    const bool control = good && length == 1 && (byte(at) < 0x20 || byte(at) == 0x7F);
    out += good && !control ? words.substr(at, length) : "?";
    at += good ? length : 1;
  }
  return out;
}

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
  cairo_show_text(context_.get(), drawable(words).c_str());
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
  cairo_text_extents(context_.get(), drawable(words).c_str(), &extents);
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
