// Pictures as files' and messages' bytes: JPEG by libjpeg-turbo, PNG by libpng.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror::display {

struct EncodeOptions {
  ImageFormat format = ImageFormat::jpeg;
  int jpeg_quality = 85;  // 1 to 100
  int png_level = 1;      // 0 to 9
};

// Keeps its buffers from call to call. One thread.
class ImageEncoder {
 public:
  ImageEncoder();
  ~ImageEncoder();
  ImageEncoder(const ImageEncoder&) = delete;
  ImageEncoder& operator=(const ImageEncoder&) = delete;
  Result<void> encode(const Image& picture, const EncodeOptions& options, std::vector<std::uint8_t>& bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cellmirror::display
