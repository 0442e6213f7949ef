#include "config/picture_library.hpp"

#include <utility>

#include "rt_core/base/home.hpp"

namespace cellmirror {

std::size_t PictureLibrary::bytes() const {
  std::size_t total = 0;
  for (const auto& one : all_) {
    if (const Picture picture = one.lock()) total += picture->rgba.size();
  }
  return total;
}

void PictureLibrary::begin_mesh() {
  std::erase_if(all_, [](const auto& one) { return one.expired(); });
  std::erase_if(files_, [](const auto& one) { return one.second.expired(); });
  failed_.clear();
  room_ = kMostPictureBytes - bytes();
}

Result<Picture> PictureLibrary::of_bytes(std::string_view bytes) {
  auto decoded = decode_picture(bytes, room_);
  if (!decoded) return std::unexpected(decoded.error());
  Picture picture = std::make_shared<const Image>(std::move(*decoded));
  all_.push_back(picture);
  return picture;
}

Result<Picture> PictureLibrary::of_file(const std::filesystem::path& file) {
  const std::string path = file.string();
  if (const auto known = files_.find(path); known != files_.end()) {
    if (Picture picture = known->second.lock()) return picture;
  }
  if (const auto known = failed_.find(path); known != failed_.end()) return std::unexpected(known->second);
  const auto bytes = read_text_file(file, kLargestPictureFile);
  auto picture = bytes ? of_bytes(*bytes) : Result<Picture>(std::unexpected(bytes.error()));
  if (picture)
    files_[path] = *picture;
  else
    failed_.emplace(path, picture.error());
  return picture;
}

}  // namespace cellmirror
