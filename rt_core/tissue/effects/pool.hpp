// A pool of fluid: its level, how much blood is in it, and the waves on its surface (the wave equation on a square
// grid).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/ports/tissue_state.hpp"
#include "rt_core/tissue/description/description.hpp"

namespace cellmirror::tissue {

class Pool {
 public:
  static constexpr int kColumns = 32;

  Pool() = default;
  Pool(const PoolDescription& description, const Pose& X_WP);

  [[nodiscard]] bool present() const { return present_; }
  void reset();
  // Within the rectangle; `depth` is that of p below the level, negative above it.
  [[nodiscard]] bool over(const Eigen::Vector3d& p_W, double& depth) const;
  // What falls in: m3, and the share of blood in it.
  void add(double volume_m3, double blood);
  void remove(double volume_m3);
  // Pushes the surface at p by a velocity, m/s, within `radius`.
  void disturb(const Eigen::Vector3d& p_W, double speed_m_s, double radius_m);
  void flatten();
  // Waves; stable for any dt. Nothing where the surface is at rest.
  void step(double dt);

  [[nodiscard]] double level() const { return level_; }
  [[nodiscard]] double rise() const { return level_ - description_.level_m; }  // m, since the start
  [[nodiscard]] double blood() const { return blood_; }
  [[nodiscard]] double area() const { return description_.size_m.x() * description_.size_m.y(); }
  [[nodiscard]] bool at_rest() const { return !moving_; }
  void view(TissuePool& pool) const;

 private:
  [[nodiscard]] std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(kColumns) + static_cast<std::size_t>(column);
  }

  bool present_ = false;
  PoolDescription description_;
  Pose X_WP_ = Pose::Identity();
  double level_ = 0;
  double blood_ = 0;
  bool moving_ = false;
  std::vector<double> heights_;  // m, above the level
  std::vector<double> speeds_;   // m/s
};

}  // namespace cellmirror::tissue
