#include "config/picture_library.hpp"

#include <fmt/format.h>

#include <utility>

#include "config/picture_file.hpp"
#include "rt_core/base/home.hpp"

namespace cellmirror {

std::size_t PictureLibrary::bytes() const {
  std::size_t total = 0;
  for (const auto& one : all_) {
    if (const Picture picture = one.lock()) total += picture->rgba.size();
  }
  return total;
}

Result<Picture> PictureLibrary::of_bytes(std::string_view bytes) {
  auto decoded = decode_picture(bytes);
  if (!decoded) return std::unexpected(decoded.error());
  std::erase_if(all_, [](const auto& one) { return one.expired(); });
  if (decoded->rgba.size() > kMostBytes - this->bytes()) {
    return fail(fmt::format("the cell's pictures would take more than {} MiB", kMostBytes >> 20U),
                "make them smaller, or have meshes share them");
  }
  Picture picture = std::make_shared<const Image>(std::move(*decoded));
  all_.push_back(picture);
  return picture;
}

Result<Picture> PictureLibrary::of_file(const std::filesystem::path& file) {
  std::weak_ptr<const Image>& known = files_[file.string()];
  if (Picture picture = known.lock()) return picture;
  const auto bytes = read_text_file(file, kLargestPictureFile);
  if (!bytes) return std::unexpected(bytes.error());
  auto picture = of_bytes(*bytes);
  if (picture) known = *picture;
  return picture;
}

}  // namespace cellmirror
