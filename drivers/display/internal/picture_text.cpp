#include "drivers/display/internal/picture_text.hpp"

#include <cairo/cairo.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rt_core/base/utf8.hpp"

namespace cellmirror::display {

namespace {

constexpr std::size_t kMostKept = 512;
constexpr std::size_t kLongestLabel = 80;  // characters
constexpr std::size_t kLongestMessage = 600;
constexpr double kWidestMessage = 1200;  // pixels: longer lines are hard to read
constexpr std::size_t kMostEntries = 24;
constexpr double kLabelSize = 13;  // pixels
constexpr double kTitleSize = 12.5;
constexpr double kHalo = 3.2;  // width of its line, pixels

// A surface of cairo with its context. Cairo's functions do nothing on one that could not be made.
class Sheet {
 public:
  Sheet(int width, int height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height)), context_(cairo_create(surface_)) {}
  ~Sheet() {
    cairo_destroy(context_);
    cairo_surface_destroy(surface_);
  }
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  [[nodiscard]] cairo_t* context() const { return context_; }

  [[nodiscard]] Sticker sticker() const {
    cairo_surface_flush(surface_);
    Sticker sticker;
    const unsigned char* const data = cairo_image_surface_get_data(surface_);
    if (cairo_status(context_) != CAIRO_STATUS_SUCCESS || data == nullptr) return sticker;
    sticker.width = cairo_image_surface_get_width(surface_);
    sticker.height = cairo_image_surface_get_height(surface_);
    const int stride = cairo_image_surface_get_stride(surface_);
    for (int y = 0; y < sticker.height; ++y) {
      const unsigned char* const row = data + static_cast<std::ptrdiff_t>(y) * stride;
      sticker.bgra.insert(sticker.bgra.end(), row, row + static_cast<std::ptrdiff_t>(4) * sticker.width);
    }
    return sticker;
  }

 private:
  cairo_surface_t* surface_;
  cairo_t* context_;
};

void choose_font(cairo_t* context, double size, bool bold) {
  // Debian's fontconfig brings DejaVu along; where it is missing, fontconfig takes the system's own sans-serif.
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size);
}

struct TextSize {
  double width = 0;
  double ascent = 0;
  double descent = 0;
};

TextSize size_of(const std::string& text, double size, bool bold) {
  const Sheet sheet(1, 1);
  choose_font(sheet.context(), size, bold);
  cairo_text_extents_t text_extents{};
  cairo_font_extents_t font_extents{};
  cairo_text_extents(sheet.context(), text.c_str(), &text_extents);
  cairo_font_extents(sheet.context(), &font_extents);
  return {std::clamp(text_extents.x_advance, 1.0, 2000.0), std::clamp(font_extents.ascent, 1.0, 64.0),
          std::clamp(font_extents.descent, 0.0, 32.0)};
}

void rounded_rectangle(cairo_t* context, double x, double y, double width, double height, double radius) {
  constexpr double kQuarter = std::numbers::pi / 2;
  cairo_new_sub_path(context);
  cairo_arc(context, x + width - radius, y + radius, radius, -kQuarter, 0);
  cairo_arc(context, x + width - radius, y + height - radius, radius, 0, kQuarter);
  cairo_arc(context, x + radius, y + height - radius, radius, kQuarter, 2 * kQuarter);
  cairo_arc(context, x + radius, y + radius, radius, 2 * kQuarter, 3 * kQuarter);
  cairo_close_path(context);
}

struct TextColours {
  double red = 0, green = 0, blue = 0;
};

// Dark enough to be read on a pale halo; what they mean is also said by the words.
TextColours colours_of(TextStyle look) {
  switch (look) {
    case TextStyle::near:
      return {0.42, 0.28, 0.0};
    case TextStyle::touching:
      return {0.62, 0.13, 0.0};
    case TextStyle::ghost:
      return {0.30, 0.32, 0.42};
    case TextStyle::title:
      return {0.25, 0.28, 0.34};
    case TextStyle::plain:
      break;
  }
  return {0.07, 0.09, 0.13};
}

Sticker draw_label(const std::string& text, TextStyle look) {
  const double size = look == TextStyle::title ? kTitleSize : kLabelSize;
  const bool bold = look == TextStyle::touching;
  const TextSize text_size = size_of(text, size, bold);
  const Sheet sheet(static_cast<int>(std::ceil(text_size.width + 2 * kHalo)),
                    static_cast<int>(std::ceil(text_size.ascent + text_size.descent + kHalo)));
  cairo_t* const context = sheet.context();
  choose_font(context, size, bold);
  cairo_move_to(context, kHalo, std::round(text_size.ascent + kHalo / 2));
  cairo_text_path(context, text.c_str());
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_width(context, kHalo);
  cairo_set_source_rgba(context, 1, 1, 1, 0.86);
  cairo_stroke_preserve(context);
  const TextColours ink = colours_of(look);
  cairo_set_source_rgba(context, ink.red, ink.green, ink.blue, 1);
  cairo_fill(context);
  return sheet.sticker();
}

constexpr double kRow = 19;     // pixels
constexpr double kMargin = 10;  // within a panel
constexpr double kSwatch = 12;

Sticker draw_legend(const std::vector<std::string>& texts, std::span<const LegendEntry> entries) {
  double widest = 0;
  for (const std::string& text : texts) widest = std::max(widest, size_of(text, kLabelSize - 0.5, false).width);
  const double width = std::ceil(2 * kMargin + kSwatch + 8 + widest);
  const double height = 2 * kMargin - 4 + kRow * static_cast<double>(texts.size());
  const Sheet sheet(static_cast<int>(width), static_cast<int>(height));
  cairo_t* const context = sheet.context();
  rounded_rectangle(context, 0.5, 0.5, width - 1, height - 1, 7);
  cairo_set_source_rgba(context, 1, 1, 1, 0.80);
  cairo_fill_preserve(context);
  cairo_set_source_rgba(context, 0.35, 0.40, 0.48, 0.35);
  cairo_set_line_width(context, 1);
  cairo_stroke(context);
  choose_font(context, kLabelSize - 0.5, false);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const double top = kMargin - 2 + kRow * static_cast<double>(i);
    const Colour& colour = entries[i].rgba;
    const auto part = [&](std::size_t at) { return static_cast<double>(colour[at]); };
    rounded_rectangle(context, kMargin, top + 3.5, kSwatch, kSwatch, 3);
    cairo_set_source_rgba(context, part(0), part(1), part(2), std::clamp(part(3), 0.35, 1.0));
    cairo_fill_preserve(context);
    cairo_set_source_rgba(context, 0.1, 0.1, 0.15, 0.45);
    cairo_stroke(context);
    cairo_set_source_rgba(context, 0.10, 0.12, 0.17, 1);
    cairo_move_to(context, kMargin + kSwatch + 8, top + 14);
    cairo_show_text(context, texts[i].c_str());
  }
  return sheet.sticker();
}

constexpr double kMessageSize = 15;
constexpr double kMessageMargin = 14;  // beside its lines
constexpr std::size_t kMostLines = 4;

bool fits(std::string_view text, double width) {
  return size_of(std::string(text), kMessageSize, false).width <= width;
}

// How many bytes of the text have room in a line: whole characters, one at least.
std::size_t fitting(std::string_view text, double width) {
  std::vector<std::size_t> ends;
  for (std::size_t at = 0; at < text.size();) {
    const auto character = utf8_character(text.substr(at));
    ends.push_back(at += character ? character->bytes : 1);
  }
  const auto beyond = std::partition_point(ends.begin() + 1, ends.end(),
                                           [&](std::size_t end) { return fits(text.substr(0, end), width); });
  return *(beyond - 1);
}

// The text as far as it fits, with an ellipsis behind it.
std::string shortened(std::string_view text, double width) {
  const double dots = size_of(std::string(kUtf8Ellipsis), kMessageSize, false).width;
  return std::string(text.substr(0, fitting(text, std::max(width - dots, 1.0)))) + std::string(kUtf8Ellipsis);
}

std::vector<std::string> lines_of(std::string_view text, double width) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    std::size_t end = fitting(text, width);
    if (end < text.size() && lines.size() + 1 == kMostLines) {
      lines.push_back(shortened(text, width));
      break;
    }
    if (end < text.size()) {
      const std::size_t blank = text.rfind(' ', end);
      if (blank != std::string_view::npos && blank > 0) end = blank;
    }
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(text.find_first_not_of(' ', end), text.size()));
  }
  return lines;
}

Sticker draw_message(const std::string& text, double most) {
  const std::vector<std::string> lines = lines_of(text, std::max(most - 2 * kMessageMargin, 1.0));
  const TextSize size = size_of(text, kMessageSize, false);
  const double line_height = std::ceil(size.ascent + size.descent);
  double widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, size_of(line, kMessageSize, false).width);
  const double width = std::ceil(widest + 2 * kMessageMargin);
  const double height = line_height * static_cast<double>(lines.size()) + 14;
  const Sheet sheet(static_cast<int>(width), static_cast<int>(height));
  cairo_t* const context = sheet.context();
  rounded_rectangle(context, 0, 0, width, height, 8);
  cairo_set_source_rgba(context, 0.11, 0.14, 0.20, 0.86);
  cairo_fill(context);
  choose_font(context, kMessageSize, false);
  cairo_set_source_rgba(context, 0.97, 0.98, 1, 1);
  double baseline = std::round(7 + size.ascent);
  for (const std::string& line : lines) {
    cairo_move_to(context, kMessageMargin, baseline);
    cairo_show_text(context, line.c_str());
    baseline += line_height;
  }
  return sheet.sticker();
}

}  // namespace

void stick(Image& picture, const PixelRect& within, const Sticker& sticker, int left, int top) {
  const int first_x = std::max({0, within.x, left});
  const int first_y = std::max({0, within.y, top});
  const int end_x = std::min({picture.width, within.x + within.width, left + sticker.width});
  const int end_y = std::min({picture.height, within.y + within.height, top + sticker.height});
  for (int y = first_y; y < end_y; ++y) {
    const std::uint8_t* from =
        sticker.bgra.data() + 4 * (std::size_t(y - top) * std::size_t(sticker.width) + std::size_t(first_x - left));
    std::uint8_t* to = picture.rgba.data() + 4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(first_x));
    for (int x = first_x; x < end_x; ++x, from += 4, to += 4) {
      const unsigned left_over = 255U - from[3];
      if (left_over == 255U) continue;
      to[0] = static_cast<std::uint8_t>(std::min(255U, from[2] + (to[0] * left_over + 127U) / 255U));
      to[1] = static_cast<std::uint8_t>(std::min(255U, from[1] + (to[1] * left_over + 127U) / 255U));
      to[2] = static_cast<std::uint8_t>(std::min(255U, from[0] + (to[2] * left_over + 127U) / 255U));
    }
  }
}

TextPress::TextPress() = default;
TextPress::~TextPress() = default;

const Sticker* TextPress::kept(const std::string& key) {
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) return nullptr;
  order_.splice(order_.begin(), order_, found->second);
  return &found->second->sticker;
}

const Sticker& TextPress::keep(std::string key, Sticker sticker) {
  order_.push_front({key, std::move(sticker)});
  by_key_[std::move(key)] = order_.begin();
  if (order_.size() > kMostKept) {
    by_key_.erase(order_.back().key);
    order_.pop_back();
  }
  return order_.front().sticker;
}

const Sticker& TextPress::label(std::string_view text, TextStyle look) {
  const std::string words = drawable_utf8(text, kLongestLabel);
  std::string key = std::string(1, static_cast<char>('0' + static_cast<int>(look))) + words;
  if (const Sticker* const before = kept(key)) return *before;
  return keep(std::move(key), draw_label(words, look));
}

const Sticker& TextPress::legend(std::span<const LegendEntry> entries) {
  const auto shown = entries.first(std::min(entries.size(), kMostEntries));
  std::string key = "legend";
  std::vector<std::string> texts;
  for (const LegendEntry& entry : shown) {
    texts.push_back(drawable_utf8(entry.text, kLongestLabel));
    key += '\n' + texts.back();
    for (const float part : entry.rgba) key += ' ' + std::to_string(part);
  }
  if (const Sticker* const before = kept(key)) return *before;
  return keep(std::move(key), draw_legend(texts, shown));
}

const Sticker& TextPress::message(std::string_view text, int width) {
  const std::string words = drawable_utf8(text, kLongestMessage);
  std::string key = "message " + std::to_string(width) + ' ' + words;
  if (const Sticker* const before = kept(key)) return *before;
  return keep(std::move(key), draw_message(words, std::min<double>(width, kWidestMessage)));
}

}  // namespace cellmirror::display
