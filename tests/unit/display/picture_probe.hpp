// Looks at pictures: regions, masks by object, differences. No golden bytes: another driver may round otherwise.
#pragma once

#include <array>
#include <cstdlib>
#include <functional>
#include <set>
#include <vector>

#include "rt_core/ports/image.hpp"

namespace cellmirror::display {

struct Region {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

inline int brightness(const std::uint8_t* pixel) { return (pixel[0] + pixel[1] + pixel[2]) / 3; }

inline double mean_brightness(const Image& picture, const Region& region) {
  double sum = 0;
  for (int y = region.y; y < region.y + region.height; ++y) {
    for (int x = region.x; x < region.x + region.width; ++x) sum += brightness(picture.pixel(x, y));
  }
  return sum / (region.width * region.height);
}

inline bool differ(const std::uint8_t* a, const std::uint8_t* b, int tolerance = 2) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(a[i] - b[i]) > tolerance) return true;
  }
  return false;
}

inline int count_different(const Image& a, const Image& b, const Region& region) {
  int count = 0;
  for (int y = region.y; y < region.y + region.height; ++y) {
    for (int x = region.x; x < region.x + region.width; ++x) count += differ(a.pixel(x, y), b.pixel(x, y)) ? 1 : 0;
  }
  return count;
}

inline int count_different(const Image& a, const Image& b) { return count_different(a, b, {0, 0, a.width, a.height}); }

inline std::size_t distinct_colours(const Image& picture, const Region& region) {
  std::set<std::array<std::uint8_t, 3>> colours;
  for (int y = region.y; y < region.y + region.height; ++y) {
    for (int x = region.x; x < region.x + region.width; ++x) {
      const std::uint8_t* const p = picture.pixel(x, y);
      colours.insert({p[0], p[1], p[2]});
    }
  }
  return colours.size();
}

}  // namespace cellmirror::display
