// Text in pictures, by cairo: drawn once, cached, and blended over the pixels. Private to this folder; no OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/display/internal/view_transform.hpp"
#include "rt_core/ports/image.hpp"
#include "rt_core/ports/scene.hpp"

namespace cellmirror::display {

// Colours with alpha already multiplied in, as cairo has them: blue, green, red, alpha.
struct Sticker {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> bgra;
};

// Over the picture, with its upper left corner there; what is beyond `within` is cut off.
void stick(Image& picture, const PixelRect& within, const Sticker& sticker, int left, int top);

enum class TextStyle : std::uint8_t { plain, near, touching, ghost, title };

class TextPress {
 public:
  TextPress();
  ~TextPress();
  TextPress(const TextPress&) = delete;
  TextPress& operator=(const TextPress&) = delete;

  // Dark letters on a pale halo, readable on anything. The reference holds until the next call.
  const Sticker& label(std::string_view text, TextStyle look);
  const Sticker& legend(std::span<const LegendEntry> entries);
  // In lines of no more than `width` pixels, frame included, broken at blanks, else within words; what is beyond the
  // fourth line is an ellipsis.
  const Sticker& message(std::string_view text, int width);

 private:
  const Sticker& keep(std::string key, Sticker sticker);
  const Sticker* kept(const std::string& key);

  struct Kept {
    std::string key;
    Sticker sticker;
  };
  std::list<Kept> order_;  // used last first
  std::map<std::string, std::list<Kept>::iterator, std::less<>> by_key_;
};

}  // namespace cellmirror::display
