// The voxel volumes of a cell folder that are in use: each is read once. Private to this folder.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "config/volume_file.hpp"
#include "rt_core/base/diagnostics.hpp"

namespace cellmirror {

class MeshLibrary;

class VolumeLibrary {
 public:
  // `progress` is notified before each source that is read; while it counts, nothing is read.
  explicit VolumeLibrary(MeshLibrary& progress) : progress_(progress) {}

  // Reads the source unless it is still in use. What is wrong with it as a whole is reported at `place`, once each time
  // it is read. Null: refused.
  [[nodiscard]] std::shared_ptr<const VolumeData> volume(const std::filesystem::path& path,
                                                         const VolumeRequest& request, const Place& place,
                                                         Diagnostics& diagnostics);

 private:
  MeshLibrary& progress_;
  std::map<std::pair<std::string, VolumeRequest>, std::weak_ptr<const VolumeData>> used_;
};

}  // namespace cellmirror
