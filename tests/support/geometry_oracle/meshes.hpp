// Meshes and poses for tests, made by hand so that tests of queries do not rest on the reader and repair of files.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::geometry_oracle {

using geometry::TriangleMesh;

inline TriangleMesh box_mesh(const Eigen::Vector3d& half) {
  TriangleMesh mesh;
  mesh.name = "box";
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1U) != 0 ? half.x() : -half.x(), (i & 2U) != 0 ? half.y() : -half.y(),
                               (i & 4U) != 0 ? half.z() : -half.z());
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  mesh.closed = true;
  mesh.convex = true;
  return mesh;
}

// About z; its flat sides lie inside of the cylinder.
inline TriangleMesh prism_mesh(double radius, double half_length, std::uint32_t sides) {
  TriangleMesh mesh;
  mesh.name = "prism";
  for (const double z : {-half_length, half_length}) {
    for (std::uint32_t i = 0; i < sides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t next = (i + 1) % sides;
    mesh.triangles.push_back({i, next, sides + next});
    mesh.triangles.push_back({i, sides + next, sides + i});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({sides, sides + i, sides + next});
  }
  mesh.closed = true;
  mesh.convex = true;
  return mesh;
}

// A globe of rings and sectors; `bumps`: how much of the radius comes and goes over its surface, so that it is not
// convex.
inline TriangleMesh globe_mesh(double radius, std::uint32_t rings, std::uint32_t sectors, double bumps = 0.0) {
  TriangleMesh mesh;
  mesh.name = "globe";
  const auto at = [&](double polar, double around) {
    const double r = radius * (1.0 + bumps * std::sin(5.0 * around) * std::sin(4.0 * polar));
    return Eigen::Vector3d(r * std::sin(polar) * std::cos(around), r * std::sin(polar) * std::sin(around),
                           r * std::cos(polar));
  };
  mesh.vertices.push_back(at(0.0, 0.0));
  for (std::uint32_t i = 1; i < rings; ++i) {
    for (std::uint32_t k = 0; k < sectors; ++k) {
      mesh.vertices.push_back(at(std::numbers::pi * i / rings, 2.0 * std::numbers::pi * k / sectors));
    }
  }
  const auto south = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(at(std::numbers::pi, 0.0));
  const auto index = [&](std::uint32_t i, std::uint32_t k) { return 1 + (i - 1) * sectors + k % sectors; };
  for (std::uint32_t k = 0; k < sectors; ++k) {
    mesh.triangles.push_back({0, index(1, k), index(1, k + 1)});
    mesh.triangles.push_back({south, index(rings - 1, k + 1), index(rings - 1, k)});
    for (std::uint32_t i = 1; i + 1 < rings; ++i) {
      mesh.triangles.push_back({index(i, k), index(i + 1, k), index(i + 1, k + 1)});
      mesh.triangles.push_back({index(i, k), index(i + 1, k + 1), index(i, k + 1)});
    }
  }
  mesh.closed = true;
  mesh.convex = bumps == 0.0;
  return mesh;
}

// A wavy sheet over [-half, half]^2: open.
inline TriangleMesh sheet_mesh(double half, std::uint32_t cells, double waves) {
  TriangleMesh mesh;
  mesh.name = "sheet";
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t k = 0; k <= cells; ++k) {
      const double x = half * (2.0 * i / cells - 1.0);
      const double y = half * (2.0 * k / cells - 1.0);
      mesh.vertices.emplace_back(x, y, waves * std::sin(7.0 * x) * std::cos(5.0 * y));
    }
  }
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t k = 0; k < cells; ++k) {
      const std::uint32_t corner = i * (cells + 1) + k;
      mesh.triangles.push_back({corner, corner + cells + 1, corner + cells + 2});
      mesh.triangles.push_back({corner, corner + cells + 2, corner + 1});
    }
  }
  return mesh;
}

// Triangles anywhere in a cube that have nothing to do with each other: needles, crossings and all.
inline TriangleMesh soup_mesh(std::mt19937_64& random, std::size_t triangles, double half, double edge) {
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  const auto any = [&] { return Eigen::Vector3d(part(random), part(random), part(random)); };
  TriangleMesh mesh;
  mesh.name = "soup";
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Eigen::Vector3d centre = half * any();
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(centre + edge * any());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

inline std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
  return std::make_shared<const TriangleMesh>(std::move(mesh));
}

// Any rotation, all alike probable; a position in the cube of that half edge.
inline Pose any_pose(std::mt19937_64& random, double half) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> part(-half, half);
  Pose X = Pose::Identity();
  X.linear() = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                   .normalized()
                   .toRotationMatrix();
  X.translation() = Eigen::Vector3d(part(random), part(random), part(random));
  return X;
}

}  // namespace cellmirror::geometry_oracle
