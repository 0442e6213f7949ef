// Meshes of simple bodies for tests, made without the code under test.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <random>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::geometry::test {

using MeshPointer = std::shared_ptr<const TriangleMesh>;

[[nodiscard]] TriangleMesh box_mesh(const Eigen::Vector3d& size, const Eigen::Vector3d& centre = {0, 0, 0});
[[nodiscard]] TriangleMesh icosphere(double radius, int subdivisions);  // 20 * 4^n triangles, corners on the sphere
[[nodiscard]] TriangleMesh torus(double ring_radius, double tube_radius, int around, int across);  // about z
[[nodiscard]] TriangleMesh sheet(double edge, int cells);  // open, in the plane z = 0
[[nodiscard]] TriangleMesh soup(std::size_t triangles, double triangle_size,
                                std::uint64_t seed);  // open, in a unit cube
// Both in one mesh; closed where both are.
[[nodiscard]] TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);
[[nodiscard]] TriangleMesh turned_inside_out(TriangleMesh mesh);
[[nodiscard]] MeshPointer share(TriangleMesh mesh);

[[nodiscard]] Pose random_pose(std::mt19937_64& random, double reach);
[[nodiscard]] Pose at(double x, double y, double z);

}  // namespace cellmirror::geometry::test
