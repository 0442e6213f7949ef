// Where a picture is drawn before it is read back. Private to this folder.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/display/internal/gl_api.hpp"

namespace cellmirror::display {

enum class Pixels : std::uint8_t {
  colours,
  smooth_colours,  // with several samples a pixel, resolved when they are read
  objects,         // one unsigned number a pixel
  coverage,        // two bytes a pixel, without depth
};

// A framebuffer object. Its first row is the picture's upper one: what is drawn into it is mirrored (ViewTransform), so
// that nothing has to be turned over afterwards.
class RenderTarget {
 public:
  static constexpr int kSamples = 4;  // as many as Mesa's software renderer has

  explicit RenderTarget(const GlApi& gl) : gl_(gl) {}
  ~RenderTarget() { free(); }
  RenderTarget(const RenderTarget&) = delete;
  RenderTarget& operator=(const RenderTarget&) = delete;

  // Bound for drawing, of this size. Kept from call to call.
  Result<void> begin(Pixels pixels, int width, int height);
  void read_colours(std::uint8_t* rgba);
  void read_objects(std::uint32_t* objects);
  void read_coverage(std::uint8_t* two_a_pixel);
  // Window depth (0 to 1) of a rectangle from the upper left corner, rows from the top; of several samples a pixel,
  // one. Drawing goes on afterwards.
  Result<void> read_depth(int x, int y, int width, int height, float* depth);
  [[nodiscard]] bool fits(Pixels pixels, int width, int height) const {
    return frame_ != 0 && pixels == pixels_ && width == width_ && height == height_;
  }

 private:
  [[nodiscard]] bool make();
  [[nodiscard]] GLuint renderbuffer(GLenum format, int samples);
  void free();

  const GlApi& gl_;
  Pixels pixels_ = Pixels::colours;
  int width_ = 0;
  int height_ = 0;
  GLuint frame_ = 0;
  GLuint resolved_ = 0;
  GLuint resolved_depth_ = 0;  // a framebuffer with depth alone, made when it is read first
  std::vector<GLuint> renderbuffers_;
};

}  // namespace cellmirror::display
