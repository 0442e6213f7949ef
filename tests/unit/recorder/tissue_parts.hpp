// Small deformable objects for tests.
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::app::test {

// Two triangles of a square with corners at +-0.1 m about `middle`.
inline TissueSurface square(std::string name, const Eigen::Vector3f& middle) {
  auto topology = std::make_shared<TissueTopology>();
  topology->revision = 7;
  topology->triangles = {{0, 1, 2}, {0, 2, 3}};
  topology->cut_face = {0, 1};
  topology->texture = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  topology->rgb = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  TissueSurface out;
  out.name = std::move(name);
  out.topology = topology;
  for (const auto& [x, y] : {std::pair(-0.1F, -0.1F), {0.1F, -0.1F}, {0.1F, 0.1F}, {-0.1F, 0.1F}}) {
    out.vertices.emplace_back(middle + Eigen::Vector3f(x, y, 0.01F * x));
    out.normals.push_back(Eigen::Vector3f(x, y, -0.05F).normalized());
  }
  out.burn = {0, 1, 2, 0.5F};
  return out;
}

// The same vertices with another triangle, as after a cut.
inline void cut(TissueSurface& surface) {
  auto topology = std::make_shared<TissueTopology>(*surface.topology);
  topology->triangles = {{0, 1, 2}};
  topology->cut_face = {1};
  surface.topology = topology;
}

inline TissueClip clip(double x) {
  TissueClip out;
  out.X_WC.translation() << x, 0, 0;
  out.vertices = std::make_shared<const std::vector<Eigen::Vector3f>>(3, Eigen::Vector3f(0.001F, 0.002F, 0.003F));
  out.triangles =
      std::make_shared<const std::vector<std::array<std::uint32_t, 3>>>(1, std::array<std::uint32_t, 3>{0, 1, 2});
  out.closes_vessel = true;
  return out;
}

}  // namespace cellmirror::app::test
