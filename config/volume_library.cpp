#include "config/volume_library.hpp"

#include <fmt/format.h>

#include "config/mesh_library.hpp"
#include "config/volume/voxel_memory.hpp"
#include "rt_core/base/text.hpp"

namespace cellmirror {

std::shared_ptr<const VolumeData> VolumeLibrary::volume(const std::filesystem::path& path, const VolumeRequest& request,
                                                        const Place& place, Diagnostics& diagnostics) {
  if (progress_.is_counting()) return std::make_shared<const VolumeData>();
  auto& used = used_[{path.string(), request}];
  if (auto known = used.lock()) return known;
  progress_.about_to_read(path);
  Diagnostics found;
  auto volume = read_volume(path, request, found);
  for (Diagnostic diagnostic : found.all()) {
    if (diagnostic.place.line == 0) {
      diagnostic.place = place;
      diagnostic.message = fmt::format("the volume {}: {}", printable(request.source), diagnostic.message);
    }
    diagnostics.add(std::move(diagnostic));
  }
  if (!volume) return nullptr;
  auto out = share_volume(std::move(*volume));
  used = out;
  return out;
}

}  // namespace cellmirror
