#include "drivers/display/image_codec.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <csetjmp>

namespace cellmirror::display {

struct ImageEncoder::Impl {
  ~Impl() {
    if (jpeg != nullptr) tjDestroy(jpeg);
  }
  Result<void> encode_jpeg(const Image& picture, int quality, std::vector<std::uint8_t>& bytes);

  tjhandle jpeg = nullptr;
  std::vector<const std::uint8_t*> rows;
};

namespace {

bool complete(const Image& picture) {
  return picture.width > 0 && picture.height > 0 && picture.width <= kLargestImageEdge &&
         picture.height <= kLargestImageEdge &&
         picture.rgba.size() ==
             std::size_t{4} * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
}

// libpng leaves its functions by longjmp where something is wrong, so nothing with a destructor lives in here.
bool write_png(png_structp png, png_infop info, const Image& picture, int level, const std::uint8_t** rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_compression_level(png, level);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, level <= 1 ? PNG_FILTER_SUB : PNG_ALL_FILTERS);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  png_set_filler(png, 0, PNG_FILLER_AFTER);  // pictures are opaque: alpha is left out
  png_write_image(png, const_cast<png_bytepp>(rows));
  png_write_end(png, nullptr);
  return true;
}

void append(png_structp png, png_bytep data, std::size_t size) {
  auto& bytes = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bytes.insert(bytes.end(), data, data + size);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*text*/) {}
void leave(png_structp png, png_const_charp /*text*/) { png_longjmp(png, 1); }

Result<void> encode_png(const Image& picture, int level, std::vector<const std::uint8_t*>& rows,
                        std::vector<std::uint8_t>& bytes) {
  rows.resize(static_cast<std::size_t>(picture.height));
  for (int y = 0; y < picture.height; ++y) rows[static_cast<std::size_t>(y)] = picture.pixel(0, y);
  bytes.clear();
  bytes.reserve(picture.rgba.size() / 8 + 1024);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, ignore_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  bool written = false;
  if (info != nullptr) {
    png_set_write_fn(png, &bytes, append, nullptr);
    written = write_png(png, info, picture, level, rows.data());
  }
  png_destroy_write_struct(&png, &info);
  if (!written) return fail("libpng could not write the picture", "free some memory");
  return {};
}

}  // namespace

Result<void> ImageEncoder::Impl::encode_jpeg(const Image& picture, int quality, std::vector<std::uint8_t>& bytes) {
  if (jpeg == nullptr) jpeg = tjInitCompress();
  if (jpeg == nullptr) return fail("libjpeg-turbo could not be started", "free some memory");
  // Half the colour in each direction, as all the world's JPEG: text has its contrast in the lightness.
  constexpr int kSampling = TJSAMP_420;
  bytes.resize(tjBufSize(picture.width, picture.height, kSampling));
  unsigned char* data = bytes.data();
  unsigned long size = bytes.size();
  if (tjCompress2(jpeg, picture.rgba.data(), picture.width, 0, picture.height, TJPF_RGBX, &data, &size, kSampling,
                  quality, TJFLAG_NOREALLOC) != 0)
    return fail(std::string("libjpeg-turbo could not write the picture: ") + tjGetErrorStr2(jpeg));
  bytes.resize(size);
  return {};
}

ImageEncoder::ImageEncoder() : impl_(std::make_unique<Impl>()) {}
ImageEncoder::~ImageEncoder() = default;

Result<void> ImageEncoder::encode(const Image& picture, const EncodeOptions& options,
                                  std::vector<std::uint8_t>& bytes) {
  if (!complete(picture)) return fail("the picture has no pixels, or fewer than its size says", "render it first");
  if (options.format == ImageFormat::png)
    return encode_png(picture, std::clamp(options.png_level, 0, 9), impl_->rows, bytes);
  return impl_->encode_jpeg(picture, std::clamp(options.jpeg_quality, 1, 100), bytes);
}

}  // namespace cellmirror::display
