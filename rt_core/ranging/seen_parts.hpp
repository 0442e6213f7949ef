// What of a cell its range sensors can see, and where it is. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/geometry/solid.hpp"

namespace cellmirror::ranging {

struct SeenPart {
  std::shared_ptr<const geometry::Solid> solid;
  std::int32_t node = 0;
  Pose X_NG = Pose::Identity();
};

class SeenParts {
 public:
  // Off the tick; may build the trees of meshes.
  void adopt(const CompiledCell& cell, geometry::SolidLibrary& solids);
  // Where everything is now.
  void place(const CompiledCell& cell, const CellPoses& poses);

  [[nodiscard]] std::size_t size() const { return parts_.size(); }
  [[nodiscard]] const SeenPart& part(std::size_t i) const { return parts_[i]; }
  [[nodiscard]] const Pose& X_WG(std::size_t i) const { return X_WG_[i]; }
  // The sphere around a part: its centre in the world and its radius, m.
  [[nodiscard]] const Eigen::Vector3d& centre(std::size_t i) const { return centre_[i]; }
  [[nodiscard]] double radius(std::size_t i) const { return parts_[i].solid->radius; }
  // Something is there whose shape or place is not known.
  [[nodiscard]] bool incomplete() const { return unknown_shape_ || unknown_place_; }

 private:
  void add(const CompiledGeometry& from, geometry::SolidLibrary& solids);
  void place(std::size_t i, const Pose& X_WN);

  std::vector<SeenPart> parts_;
  std::vector<Pose> X_WG_;
  std::vector<Eigen::Vector3d> centre_;
  bool unknown_shape_ = false;
  bool unknown_place_ = false;
  bool unknown_fixed_place_ = false;
};

// For each part (1: yes) whether it is the sensor's own housing: rigidly joined with the sensor's node, and around its
// apex or within 1 mm of it. Needs no poses: what is rigid does not move.
[[nodiscard]] std::vector<std::uint8_t> housing_of(const CompiledCell& cell, std::int32_t sensor_node,
                                                   const SeenParts& parts);

}  // namespace cellmirror::ranging
