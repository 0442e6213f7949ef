// The meshes of a cell: each file is read once for each scale, however many bodies use it. Private to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/base/diagnostics.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/cell/geometry.hpp"

namespace cellmirror {

class PictureLibrary;

// What Geometry holds of a mesh.
struct CollisionMesh {
  CollideAs collide_as = CollideAs::exact;
  std::shared_ptr<const geometry::TriangleMesh> mesh;
  std::shared_ptr<const MeshAppearance> look;
  std::vector<std::shared_ptr<const geometry::TriangleMesh>> pieces;  // for CollideAs::hull and parts
};

class MeshLibrary {
 public:
  MeshLibrary();
  ~MeshLibrary();
  MeshLibrary(const MeshLibrary&) = delete;
  MeshLibrary& operator=(const MeshLibrary&) = delete;

  // Where a picture or a material file is that the mesh names.
  using Beside = std::function<Result<std::filesystem::path>(const std::string& name)>;

  // Reads the file, and its appearance if it has one, with that scale, unless it is still in use. Notes and warnings go
  // to `diagnostics` at `place`, once each time it is read.
  Result<CollisionMesh> mesh(const std::filesystem::path& file, const Eigen::Vector3d& scale, CollideAs collide_as,
                             const Beside& beside, const Place& place, Diagnostics& diagnostics);

  // For progress. While counting, mesh() reads nothing and gives nothing, but counts the files that it would read.
  void count_only(bool counting) { counting_ = counting; }
  [[nodiscard]] bool is_counting() const { return counting_; }
  [[nodiscard]] std::size_t counted() const { return counted_; }
  // `reading` is called before each file that is read. May be empty.
  using Reading = std::function<void(const std::filesystem::path& file)>;
  void set_progress(Reading reading) { reading_ = std::move(reading); }
  void about_to_read(const std::filesystem::path& file) const {
    if (reading_ && !counting_) reading_(file);
  }

 private:
  using Pieces = std::vector<std::shared_ptr<const geometry::TriangleMesh>>;
  struct Entry {
    std::weak_ptr<const geometry::TriangleMesh> mesh;
    // May be released before the mesh: users of the shape alone keep no appearance.
    std::weak_ptr<const MeshAppearance> look;
    bool had_look = false;
    // By kind: only while the pieces are used.
    std::map<CollideAs, std::vector<std::weak_ptr<const geometry::TriangleMesh>>> pieces;
  };
  using Key = std::pair<std::string, std::array<double, 3>>;

  static Result<Pieces> pieces(Entry& entry, const geometry::TriangleMesh& mesh, CollideAs collide_as);

  Result<void> read(Entry& entry, const std::filesystem::path& file, const Eigen::Vector3d& scale, const Beside& beside,
                    const Place& place, Diagnostics& diagnostics, CollisionMesh& out);

  std::map<Key, Entry> entries_;
  std::unique_ptr<PictureLibrary> pictures_;
  bool counting_ = false;
  std::size_t counted_ = 0;
  Reading reading_;
};

}  // namespace cellmirror
