// How the gateway takes pictures of the cell ([display] of a cell file). Plain data.
#pragma once

#include <cstdint>

namespace cellmirror {

enum class PictureRenderer : std::uint8_t { automatic, osmesa, egl };

struct PictureSettings {
  bool on = true;
  double rate_hz = 20;  // of updates, at most
  int width = 640;      // default
  int height = 480;
  PictureRenderer renderer = PictureRenderer::automatic;
  int threads = 1;  // of a software renderer, beside the one that draws
};

}  // namespace cellmirror
