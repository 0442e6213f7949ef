// Any bytes as a .msh file: findings, or tetrahedra with positive volume whose surface is closed.
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "config/msh/msh_file.hpp"
#include "config/msh/tetra_surface.hpp"
#include "rt_core/base/contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cellmirror;
  constexpr std::size_t kLargest = 64UL << 10U;
  if (size > kLargest) return 0;
  Diagnostics diagnostics;
  const auto mesh = msh::parse_msh({reinterpret_cast<const char*>(data), size}, "fuzz.msh", 0.01, diagnostics);
  CELLMIRROR_EXPECTS(mesh.has_value() == diagnostics.ok());
  if (!mesh) return 0;
  CELLMIRROR_EXPECTS(!mesh->tetrahedra.empty());
  for (const Eigen::Vector3d& p : mesh->nodes) CELLMIRROR_EXPECTS(p.allFinite());
  for (const auto& corners : mesh->tetrahedra) {
    for (const std::uint32_t corner : corners) CELLMIRROR_EXPECTS(corner < mesh->nodes.size());
    const Eigen::Vector3d& o = mesh->nodes[corners[0]];
    const Eigen::Vector3d a = mesh->nodes[corners[1]] - o;
    const Eigen::Vector3d b = mesh->nodes[corners[2]] - o;
    const Eigen::Vector3d c = mesh->nodes[corners[3]] - o;
    CELLMIRROR_EXPECTS(a.dot(b.cross(c)) > 0);
  }
  const auto surface = msh::surface_of(*mesh);
  CELLMIRROR_EXPECTS(surface.has_value() && surface->triangles.size() >= 4);
  Eigen::Vector3d areas = Eigen::Vector3d::Zero();
  double sum = 0;
  for (const auto& [i, j, k] : surface->triangles) {
    const Eigen::Vector3d& o = surface->vertices[i];
    const Eigen::Vector3d area = (surface->vertices[j] - o).cross(surface->vertices[k] - o);
    areas += area;
    sum += area.norm();
  }
  constexpr double kRounding = 1e-6;
  CELLMIRROR_EXPECTS(areas.norm() <= kRounding * sum);
  return 0;
}
