// Where the files are that a cell's files name. An interface, so that text can be checked without touching a disk.
#pragma once

#include <filesystem>
#include <string_view>

#include "rt_core/base/home.hpp"
#include "rt_core/base/result.hpp"

namespace cellmirror {

// What a name is the name of; it decides in which folders of the home it is looked for.
enum class FileUse {
  component,    // .mpc in envlib/, .urdf in robots/
  mesh,         // of a component: envlib/
  description,  // EDS, DCF, DBC: robots/
  script,       // scripts/
  log,          // candump logs: the home itself
};

class FileFinder {
 public:
  virtual ~FileFinder() = default;
  // The absolute path of a regular, readable file.
  [[nodiscard]] virtual Result<std::filesystem::path> find(FileUse use, std::string_view name) const = 0;
  // A mesh that the URDF at `urdf` names: "package://NAME/PATH", "file://PATH" or a path relative to the URDF. It must
  // lie in the home, or in the URDF's own folder where that is outside.
  [[nodiscard]] virtual Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                        std::string_view name) const = 0;
};

class HomeFiles final : public FileFinder {
 public:
  explicit HomeFiles(KismetHome home) : home_(std::move(home)) {}
  [[nodiscard]] Result<std::filesystem::path> find(FileUse use, std::string_view name) const override;
  [[nodiscard]] Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                std::string_view name) const override;
  [[nodiscard]] const KismetHome& home() const { return home_; }

 private:
  KismetHome home_;
};

// Believes every name. For text that is checked alone.
class AnyFile final : public FileFinder {
 public:
  [[nodiscard]] Result<std::filesystem::path> find(FileUse use, std::string_view name) const override;
  [[nodiscard]] Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                std::string_view name) const override;
};

// A mesh file by its name: STL, OBJ, DAE, PLY, glTF or GLB, and neither empty nor larger than kLargestMesh. Its content
// is read when collision and drawing need it, not here.
inline constexpr std::size_t kLargestMesh = 256UL << 20U;
[[nodiscard]] Result<void> check_mesh(const std::filesystem::path& file);

}  // namespace cellmirror
