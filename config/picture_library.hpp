// The pictures on the meshes of a cell: each file is decoded once, however many meshes use it, and freed with the last
// of them. Private to this folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror {

using Picture = std::shared_ptr<const Image>;

class PictureLibrary {
 public:
  // Of all pictures of a cell together, decoded (4 bytes a pixel).
  static constexpr std::size_t kMostBytes = 128UL << 20U;

  Result<Picture> of_file(const std::filesystem::path& file);
  // One that stands in the mesh file itself.
  Result<Picture> of_bytes(std::string_view bytes);
  // Of those that are in use.
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::map<std::string, std::weak_ptr<const Image>> files_;  // by path
  std::vector<std::weak_ptr<const Image>> all_;
};

}  // namespace cellmirror
