// Where the files are that a cell's files name, and what is in their meshes. An interface, so that text can be checked
// without touching a disk.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>

#include "config/found_files.hpp"
#include "config/mesh_library.hpp"
#include "config/volume_library.hpp"
#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror {

// The kind of a file name; it determines the folders of the cell folder that are searched.
enum class FileUse {
  component,    // .mpc in envlib/, .urdf in robots/
  mesh,         // of a component or a deformable object: envlib/
  object,       // .mpo: envlib/
  hyper,        // .hyper, connections of deformable objects: envlib/
  description,  // EDS, DCF, DBC: robots/
  script,       // scripts/
  log,          // candump logs: the cell folder itself
  layout,       // .lay: the cell folder itself
  security,     // certificates, keys, permissions: the cell folder itself
};

class FileFinder {
 public:
  virtual ~FileFinder() = default;
  // The absolute path of a regular, readable file.
  [[nodiscard]] virtual Result<std::filesystem::path> find(FileUse use, std::string_view name) const = 0;
  // Refused: a file that others than its owner may read. Nothing is refused here, where no files are read.
  [[nodiscard]] virtual Result<void> check_private(const std::filesystem::path& file) const;
  // A mesh named by the URDF at `urdf`: "package://NAME/PATH", "file://PATH" or a path relative to the URDF. It must be
  // in the cell folder, or in the URDF's own folder if that is outside.
  [[nodiscard]] virtual Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                        std::string_view name) const = 0;
  // What is in a mesh file that was found: nothing here, where no files are read. `collide_as`: what the shape itself
  // says. See MeshLibrary::mesh().
  [[nodiscard]] virtual Result<CollisionMesh> mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale,
                                                   std::optional<CollideAs> collide_as, const Place& place,
                                                   Diagnostics& diagnostics) const;
  // The tetrahedra in a .msh file that was found: none here. Nothing, and errors with places in that file, where it is
  // refused.
  [[nodiscard]] virtual std::optional<tissue::TetraMesh> tetrahedra(const std::filesystem::path& file, double scale,
                                                                    Diagnostics& diagnostics) const;
  // A voxel volume in envlib/: a file or a folder of files. `place`: where it is named, for what is wrong with it as a
  // whole. Null: refused, with errors. Nothing is read here: an empty volume.
  [[nodiscard]] virtual std::shared_ptr<const VolumeData> volume(const VolumeRequest& request, const Place& place,
                                                                 Diagnostics& diagnostics) const;
};

class HomeFiles final : public FileFinder {
 public:
  // Copies share their meshes, and the list of what they found.
  explicit HomeFiles(KismetHome home)
      : home_(std::move(home)),
        meshes_(std::make_shared<MeshLibrary>()),
        volumes_(std::make_shared<VolumeLibrary>(*meshes_)),
        found_(std::make_shared<FoundFiles>()) {}
  [[nodiscard]] Result<std::filesystem::path> find(FileUse use, std::string_view name) const override;
  [[nodiscard]] Result<void> check_private(const std::filesystem::path& file) const override;
  [[nodiscard]] Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                std::string_view name) const override;
  [[nodiscard]] Result<CollisionMesh> mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale,
                                           std::optional<CollideAs> collide_as, const Place& place,
                                           Diagnostics& diagnostics) const override;
  [[nodiscard]] std::optional<tissue::TetraMesh> tetrahedra(const std::filesystem::path& file, double scale,
                                                            Diagnostics& diagnostics) const override;
  [[nodiscard]] std::shared_ptr<const VolumeData> volume(const VolumeRequest& request, const Place& place,
                                                         Diagnostics& diagnostics) const override;
  [[nodiscard]] const KismetHome& home() const { return home_; }
  [[nodiscard]] MeshLibrary& meshes() const { return *meshes_; }
  // All that was found, with what meshes and volumes name; without files of FileUse::security.
  [[nodiscard]] const std::vector<std::filesystem::path>& found() const { return found_->files(); }

 private:
  // A file, a `what`, that `file`, a `kind`, names; the rules are those of find_mesh_of_urdf().
  [[nodiscard]] Result<std::filesystem::path> find_named_in(const std::filesystem::path& file, std::string_view kind,
                                                            std::string_view name, std::string_view what) const;
  [[nodiscard]] Result<std::filesystem::path> noted(Result<std::filesystem::path> found) const;
  void note_buffers(const std::filesystem::path& gltf) const;

  KismetHome home_;
  std::shared_ptr<MeshLibrary> meshes_;
  std::shared_ptr<VolumeLibrary> volumes_;
  std::shared_ptr<FoundFiles> found_;
};

// The same files; meshes without their own collide_as use this one.
class FilesWithMeshesAs final : public FileFinder {
 public:
  FilesWithMeshesAs(const FileFinder& files, CollideAs collide_as) : files_(files), collide_as_(collide_as) {}
  [[nodiscard]] Result<std::filesystem::path> find(FileUse use, std::string_view name) const override {
    return files_.find(use, name);
  }
  [[nodiscard]] Result<void> check_private(const std::filesystem::path& file) const override {
    return files_.check_private(file);
  }
  [[nodiscard]] Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                std::string_view name) const override {
    return files_.find_mesh_of_urdf(urdf, name);
  }
  [[nodiscard]] Result<CollisionMesh> mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale,
                                           std::optional<CollideAs> collide_as, const Place& place,
                                           Diagnostics& diagnostics) const override {
    return files_.mesh(file, scale, collide_as.value_or(collide_as_), place, diagnostics);
  }
  [[nodiscard]] std::shared_ptr<const VolumeData> volume(const VolumeRequest& request, const Place& place,
                                                         Diagnostics& diagnostics) const override {
    return files_.volume(request, place, diagnostics);
  }

 private:
  const FileFinder& files_;
  CollideAs collide_as_;
};

// Believes every name. For text that is checked alone.
class AnyFile final : public FileFinder {
 public:
  [[nodiscard]] Result<std::filesystem::path> find(FileUse use, std::string_view name) const override;
  [[nodiscard]] Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                std::string_view name) const override;
};

// A mesh file by its name: STL, OBJ, DAE, PLY, glTF or GLB, and neither empty nor larger than kLargestMesh (2,000,000
// triangles of binary STL). Its content is not read.
inline constexpr std::size_t kLargestMesh = 128UL << 20U;
[[nodiscard]] Result<void> check_mesh(const std::filesystem::path& file);

}  // namespace cellmirror
