#include "shapes.hpp"

#include <array>
#include <map>
#include <numbers>
#include <utility>

namespace cellmirror::geometry::test {

TriangleMesh box_mesh(const Eigen::Vector3d& size, const Eigen::Vector3d& centre) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(i % 2 == 0 ? -0.5 : 0.5, i / 2 % 2 == 0 ? -0.5 : 0.5, i / 4 == 0 ? -0.5 : 0.5);
    mesh.vertices.emplace_back(centre + corner.cwiseProduct(size));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  mesh.closed = true;
  return mesh;
}

TriangleMesh icosphere(double radius, int subdivisions) {
  TriangleMesh mesh;
  const double g = std::numbers::phi;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-g, g}) {
      mesh.vertices.emplace_back(s, t, 0);
      mesh.vertices.emplace_back(0, s, t);
      mesh.vertices.emplace_back(t, 0, s);
    }
  }
  // Faces: every three corners that are one edge (of length 2) apart.
  for (std::uint32_t a = 0; a < 12; ++a) {
    for (std::uint32_t b = a + 1; b < 12; ++b) {
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        const Eigen::Vector3d& p = mesh.vertices[a];
        const Eigen::Vector3d& q = mesh.vertices[b];
        const Eigen::Vector3d& r = mesh.vertices[c];
        if ((p - q).norm() > 2.1 || (q - r).norm() > 2.1 || (r - p).norm() > 2.1) continue;
        if ((q - p).cross(r - p).dot(p) > 0) {
          mesh.triangles.push_back({a, b, c});
        } else {
          mesh.triangles.push_back({a, c, b});
        }
      }
    }
  }
  for (int n = 0; n < subdivisions; ++n) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), mesh.vertices.size());
      if (is_new) mesh.vertices.emplace_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return at->second;
    };
    std::vector<TriangleIndices> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
    for (Eigen::Vector3d& p : mesh.vertices) p.normalize();
  }
  for (Eigen::Vector3d& p : mesh.vertices) p = radius * p.normalized();
  mesh.closed = true;
  return mesh;
}

TriangleMesh torus(double ring_radius, double tube_radius, int around, int across) {
  TriangleMesh mesh;
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(i % around * across + j % across); };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around;
      const double v = 2 * std::numbers::pi * j / across;
      const double r = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v));
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i, j + 1)});
      mesh.triangles.push_back({index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  mesh.closed = true;
  return mesh;
}

TriangleMesh sheet(double edge, int cells) {
  TriangleMesh mesh;
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(i * (cells + 1) + j); };
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j)
      mesh.vertices.emplace_back(edge * i / cells - edge / 2, edge * j / cells - edge / 2, 0);
  }
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      mesh.triangles.push_back({index(i, j), index(i + 1, j), index(i, j + 1)});
      mesh.triangles.push_back({index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)});
    }
  }
  return mesh;
}

TriangleMesh soup(std::size_t triangles, double triangle_size, std::uint64_t seed) {
  TriangleMesh mesh;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  const auto point = [&] { return Eigen::Vector3d(unit(random), unit(random), unit(random)); };
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Eigen::Vector3d place = point();
    for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(place + triangle_size * point());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh mesh = a;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [p, q, r] : b.triangles) mesh.triangles.push_back({first + p, first + q, first + r});
  mesh.closed = a.closed && b.closed;
  return mesh;
}

TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (TriangleIndices& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

MeshPointer share(TriangleMesh mesh) { return std::make_shared<const TriangleMesh>(std::move(mesh)); }

Pose random_pose(std::mt19937_64& random, double reach) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> along(-reach, reach);
  Eigen::Quaterniond turn(normal(random), normal(random), normal(random), normal(random));
  Pose pose = Pose::Identity();
  pose.linear() = turn.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(along(random), along(random), along(random));
  return pose;
}

Pose at(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

}  // namespace cellmirror::geometry::test
