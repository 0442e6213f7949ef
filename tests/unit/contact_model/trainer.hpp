// The phantom trainer cell with one instrument that is placed by its tip, and how deep it really is in anything.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/cell_file.hpp"
#include "rt_core/collision/pairs.hpp"
#include "rt_core/contact_model/contact_finder.hpp"
#include "rt_core/geometry/proximity.hpp"

namespace cellmirror::contact_model {

class Trainer {
 public:
  Trainer() {
    Diagnostics diagnostics;
    const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
    const auto folder = source != nullptr
                            ? std::filesystem::path(source)
                            : std::filesystem::path(__FILE__).parent_path().parent_path().parent_path().parent_path();
    loaded_ = load_cell(folder / "config/cells/phantom_trainer/cell.toml", diagnostics);
    if (!loaded_) std::abort();
    q = cell().start_positions();
    left = cell().robot("LAP_LEFT")->slot();
    right = cell().robot("LAP_RIGHT")->slot();
    refresh();
  }

  [[nodiscard]] Cell& cell() { return loaded_->cell; }
  // After a change of the cell.
  void refresh() {
    compiled = cell().compile();
    pairs = derivation_.derive(*compiled, loaded_->collision);
  }
  void pose() { compute_poses(*compiled, q, poses); }

  [[nodiscard]] Eigen::Vector3d tip(std::size_t slot) const {
    return tcp_poses(*compiled->robot(slot), poses).X_WT.translation();
  }
  // The joints that bring the tip to a point of the world; the roll and the jaw stay.
  void move_tip(std::size_t slot, const Eigen::Vector3d& x_W) {
    const Pose& X_WB = poses.X_WN[static_cast<std::size_t>(compiled->robot(slot)->base)];
    const Eigen::Vector3d p = X_WB.inverse(Eigen::Isometry) * x_W;
    q[slot][0] = std::atan2(-p.y(), p.z());
    q[slot][1] = std::asin(p.x() / p.norm());
    q[slot][2] = p.norm();
  }

  // m, of the deepest overlap of the instrument's capsules with what they are tested against; negative: the distance,
  // as far as 1 mm. Capsules are measured by their axes, so that it is exact to more than a millimetre of depth.
  [[nodiscard]] double depth(std::size_t slot) {
    double deepest = -1e-3;
    for (const collision::Pair& pair : pairs->pairs) {
      if (!is_tested(pair.state)) continue;
      const bool first = moved_by(slot, pairs->bodies[pair.a].node);
      if (first == moved_by(slot, pairs->bodies[pair.b].node)) continue;
      const collision::Body& mine = pairs->bodies[first ? pair.a : pair.b];
      const collision::Body& other = pairs->bodies[first ? pair.b : pair.a];
      for (const collision::BodyPart& part : mine.parts) {
        for (const collision::BodyPart& obstacle : other.parts) {
          const double found = depth(mine, part, other, obstacle);
          if (found <= deepest) continue;
          deepest = found;
          where = (*pairs->names)[first ? pair.a : pair.b] + " in " + (*pairs->names)[first ? pair.b : pair.a];
        }
      }
    }
    return deepest;
  }

  [[nodiscard]] bool moved_by(std::size_t slot, std::int32_t node) const {
    for (; node > 0; node = compiled->parent[static_cast<std::size_t>(node)]) {
      const std::int32_t joint = compiled->joint_of[static_cast<std::size_t>(node)];
      if (joint >= 0 && compiled->joints[static_cast<std::size_t>(joint)].slot == slot) return true;
    }
    return false;
  }

  std::vector<JointValues> q;
  std::size_t left = 0;
  std::size_t right = 0;
  std::shared_ptr<const CompiledCell> compiled;
  std::shared_ptr<const collision::PairTable> pairs;
  CellPoses poses;
  std::string where;  // what the last answer of depth() is about

 private:
  static constexpr double kThin = 1e-6;  // m, radius of what stands for an axis

  double depth(const collision::Body& mine, const collision::BodyPart& part, const collision::Body& other,
               const collision::BodyPart& obstacle) {
    const Pose X_WM = poses.X_WN[static_cast<std::size_t>(mine.node)] * part.X_NG;
    const Pose X_WO = poses.X_WN[static_cast<std::size_t>(other.node)] * obstacle.X_NG;
    geometry::ProximityHint hint;
    if (part.solid->shape != Shape::capsule) {
      const geometry::Separation apart = separation(*part.solid, X_WM, *obstacle.solid, X_WO, 1e-3, hint);
      if (apart.points.distance > geometry::kTouchDistance) return -apart.points.distance;
      geometry::Contact contact;
      return geometry::contact(*part.solid, X_WM, *obstacle.solid, X_WO, 1, contact) ? contact.deepest.depth : 0.0;
    }
    const double radius = part.solid->size.x();
    const geometry::Solid axis = geometry::make_primitive(Shape::capsule, {kThin, part.solid->size.y(), 0.0});
    const geometry::Separation apart = separation(axis, X_WM, *obstacle.solid, X_WO, radius + 1e-3, hint);
    return radius - kThin - apart.points.distance;
  }

  std::optional<LoadedCell> loaded_;
  collision::PairDerivation derivation_{std::make_shared<geometry::SolidLibrary>()};
};

}  // namespace cellmirror::contact_model
