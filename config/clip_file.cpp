#include "config/clip_file.hpp"

#include <utility>

#include <Eigen/Geometry>

#include "config/file_finder.hpp"
#include "config/first_error.hpp"
#include "config/tissue_object.hpp"

namespace cellmirror {

Result<tissue::ClipDefinition> load_clip(const KismetHome& home, std::string_view name) {
  const HomeFiles files(home);
  const auto path = files.find(FileUse::object, name);
  if (!path) return std::unexpected(path.error());
  Diagnostics diagnostics;
  auto object = read_object(*path, files, diagnostics);
  if (!object) return std::unexpected(first_error(diagnostics, *path));
  tissue::ClipDefinition clip;
  clip.name = object->name;
  clip.shape = std::move(object->surface);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : clip.shape.vertices) box.extend(p);
  clip.length_m = box.sizes().z();
  clip.width_m = box.sizes().x();
  return clip;
}

}  // namespace cellmirror
