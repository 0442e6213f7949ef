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

#include "config/picture_file.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/ports/image.hpp"

namespace cellmirror {

using Picture = std::shared_ptr<const Image>;

class PictureLibrary {
 public:
  // Before each mesh. Until the next one no failed file is opened again, and failed ones count as if in use: a mesh
  // file cannot cause more work than kMostPictureBytes of pixels.
  void begin_mesh();
  Result<Picture> of_file(const std::filesystem::path& file);
  // A texture inside the mesh file.
  Result<Picture> of_bytes(std::string_view bytes);
  // Of those that are in use.
  [[nodiscard]] std::size_t bytes() const;

 private:
  std::map<std::string, std::weak_ptr<const Image>> files_;  // by path
  std::vector<std::weak_ptr<const Image>> all_;
  std::map<std::string, Error> failed_;  // by path
  std::size_t room_ = kMostPictureBytes;
};

}  // namespace cellmirror
