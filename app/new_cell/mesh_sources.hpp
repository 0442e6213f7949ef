// Finds the meshes that a URDF names, wherever ROS would find them, and where they go in the cell folder.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "app/new_cell/plan.hpp"
#include "config/file_finder.hpp"

namespace cellmirror::app {

class MeshSources final : public FileFinder {
 public:
  // `urdf`: canonical path; `folder`: of the URDF in the cell folder, "robots/NAME".
  // `named_folder`: canonical, where the user named the URDF; other than its parent where the URDF is a link.
  MeshSources(const std::filesystem::path& urdf, std::string folder, const std::filesystem::path& named_folder = {});

  [[nodiscard]] Result<std::filesystem::path> find(FileUse use, std::string_view name) const override;
  // Remembers the file for the copy.
  [[nodiscard]] Result<std::filesystem::path> find_mesh_of_urdf(const std::filesystem::path& urdf,
                                                                std::string_view name) const override;

  // Every mesh that was found, once, with the materials, textures and buffers that lie beside it and that it names.
  [[nodiscard]] Result<std::vector<PlannedFile>> files() const;
  // The text of the URDF with the names of meshes that lie elsewhere in the cell folder.
  [[nodiscard]] std::string rewritten(std::string text) const;

 private:
  struct Found {
    std::filesystem::path file;  // canonical
    std::string to;              // in the cell folder
    std::string name;            // in the URDF of the cell folder
  };
  [[nodiscard]] Result<Found> resolve(const std::string& name) const;
  [[nodiscard]] Result<Found> in_package(const std::string& name) const;
  [[nodiscard]] Result<Found> as_path(const std::string& name) const;
  [[nodiscard]] Result<std::filesystem::path> from_folders(const std::string& text) const;
  [[nodiscard]] bool allowed(const std::filesystem::path& file) const;
  void add_companions(const Found& mesh, std::vector<PlannedFile>& files) const;

  std::vector<std::filesystem::path> urdf_folders_;  // searched in this order
  std::string folder_;
  std::vector<std::filesystem::path> roots_;                 // folders that files may be taken from, canonical
  std::vector<std::filesystem::path> packages_;              // folders that hold packages, canonical
  mutable std::map<std::string, Found, std::less<>> found_;  // by their names in the URDF
};

}  // namespace cellmirror::app
