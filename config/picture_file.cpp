#include "config/picture_file.hpp"

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include <memory>
#include <new>
#include <string>

#include "rt_core/base/text.hpp"

namespace cellmirror {

namespace {

Result<Image> sized(std::uint64_t width, std::uint64_t height, std::size_t& room) {
  constexpr auto kLargest = static_cast<std::uint64_t>(kLargestImageEdge);
  if (width < 1 || height < 1) return fail("it has no pixels");
  if (width > kLargest || height > kLargest) {
    return fail(fmt::format("it has {} x {} pixels, more than {} x {}", width, height, kLargest, kLargest),
                "make it smaller");
  }
  const std::size_t size = 4 * static_cast<std::size_t>(width * height);
  if (size > room) {
    return fail(fmt::format("with its {} x {} pixels the cell's textures would need more than {} MiB", width, height,
                            kMostPictureBytes >> 20U),
                "make them smaller, or share them between meshes");
  }
  room -= size;
  Image picture;
  picture.width = static_cast<int>(width);
  picture.height = static_cast<int>(height);
  picture.rgba.resize(size);
  return picture;
}

Error damaged(const char* reason) {
  return {fmt::format("it is damaged: {}", printable(std::string(reason))), "export it again"};
}

// By libpng's simplified interface: no longjmp gets out of it, chunks beside the pixels are bounded to 8 MB.
Result<Image> decode_png(std::string_view bytes, std::size_t& room) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, void (*)(png_image*)> freed(&png, png_image_free);
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
    return std::unexpected(damaged(png.message));
  png.format = PNG_FORMAT_RGBA;
  auto picture = sized(png.width, png.height, room);
  if (!picture) return picture;
  if (png_image_finish_read(&png, nullptr, picture->rgba.data(), 0, nullptr) == 0)
    return std::unexpected(damaged(png.message));
  return picture;
}

Result<Image> decode_jpeg(std::string_view bytes, std::size_t& room) {
  const std::unique_ptr<void, int (*)(tjhandle)> jpeg(tjInitDecompress(), tjDestroy);
  if (jpeg == nullptr) return fail("libjpeg-turbo could not be started", "free some memory");
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0;
  int height = 0;
  int sampling = 0;
  int colours = 0;
  if (tjDecompressHeader3(jpeg.get(), data, bytes.size(), &width, &height, &sampling, &colours) != 0)
    return std::unexpected(damaged(tjGetErrorStr2(jpeg.get())));
  if (colours == TJCS_CMYK || colours == TJCS_YCCK) return fail("its colours are CMYK", "save it as RGB");
  if (width < 1 || height < 1) return fail("it has no pixels");
  auto picture = sized(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), room);
  if (!picture) return picture;
  // Limited scans: a small file with thousands of them could cause hours of work.
  constexpr int kFlags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS;
  if (tjDecompress2(jpeg.get(), data, bytes.size(), picture->rgba.data(), width, 0, height, TJPF_RGBA, kFlags) != 0)
    return std::unexpected(damaged(tjGetErrorStr2(jpeg.get())));
  return picture;
}

}  // namespace

Result<Image> decode_picture(std::string_view bytes, std::size_t& room) {
  if (bytes.empty()) return fail("it is empty");
  if (bytes.size() > kLargestPictureFile)
    return fail(fmt::format("it has {} bytes, more than {}", bytes.size(), kLargestPictureFile), "make it smaller");
  try {
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(bytes, room);
    if (bytes.starts_with("\xff\xd8\xff")) return decode_jpeg(bytes, room);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory", "make it smaller");
  }
  return fail("it is neither PNG nor JPEG", "save it as one of them");
}

}  // namespace cellmirror
