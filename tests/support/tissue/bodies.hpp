// Bodies for tests of tissue: spheres, boxes of tetrahedra, and what is asked of every body. SI.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "rt_core/tissue/body/body.hpp"
#include "rt_core/tissue/description/description.hpp"
#include "rt_core/tissue/world.hpp"

namespace cellmirror::tissue_bodies {

using tissue::Body;
using tissue::ObjectDescription;
using tissue::SurfaceMesh;
using tissue::TetraMesh;

// An octahedron whose triangles are divided `levels` times, on the sphere.
inline SurfaceMesh sphere(double radius, int levels) {
  SurfaceMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) mesh.vertices.push_back(radius * sign * Eigen::Vector3d::Unit(axis));
  }
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back(radius * (mesh.vertices[a] + mesh.vertices[b]).normalized());
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b);
      const std::uint32_t bc = middle(b, c);
      const std::uint32_t ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

// Cubes of six tetrahedra each, which all have the diagonal from the cube's lowest to its highest corner.
inline TetraMesh box(const Eigen::Vector3d& size, const std::array<int, 3>& cubes) {
  TetraMesh mesh;
  const auto number = [&](int x, int y, int z) {
    return static_cast<std::uint32_t>((z * (cubes[1] + 1) + y) * (cubes[0] + 1) + x);
  };
  for (int z = 0; z <= cubes[2]; ++z) {
    for (int y = 0; y <= cubes[1]; ++y) {
      for (int x = 0; x <= cubes[0]; ++x) {
        mesh.nodes.emplace_back(size.x() * x / cubes[0], size.y() * y / cubes[1], size.z() * z / cubes[2]);
      }
    }
  }
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (int z = 0; z < cubes[2]; ++z) {
    for (int y = 0; y < cubes[1]; ++y) {
      for (int x = 0; x < cubes[0]; ++x) {
        for (const auto& order : kOrders) {
          std::array<int, 3> at{x, y, z};
          std::array<std::uint32_t, 4> t{};
          t[0] = number(at[0], at[1], at[2]);
          for (std::size_t k = 0; k < 3; ++k) {
            ++at[static_cast<std::size_t>(order[k])];
            t[k + 1] = number(at[0], at[1], at[2]);
          }
          const Eigen::Vector3d& o = mesh.nodes[t[0]];
          if ((mesh.nodes[t[1]] - o).cross(mesh.nodes[t[2]] - o).dot(mesh.nodes[t[3]] - o) < 0) std::swap(t[2], t[3]);
          mesh.tetrahedra.push_back(t);
        }
      }
    }
  }
  return mesh;
}

inline ObjectDescription ball(double radius, double element_size) {
  ObjectDescription d;
  d.name = "ball";
  d.surface = sphere(radius, 4);
  d.element_size_m = element_size;
  return d;
}

inline ObjectDescription block(const Eigen::Vector3d& size, const std::array<int, 3>& cubes) {
  ObjectDescription d;
  d.name = "block";
  d.volume = box(size, cubes);
  return d;
}

inline Body made(const ObjectDescription& description) {
  Result<Body> body = Body::make(description);
  if (!body) throw std::runtime_error(body.error().text());
  return *std::move(body);
}

// s, of one of the steps into which a millisecond is divided.
inline double step_of(const Body& body) {
  TissueObjectState state;
  body.describe(state);
  return tissue::kStep_s / state.substeps;
}

inline TissueObjectState state_of(const Body& body) {
  TissueObjectState state;
  body.describe(state);
  return state;
}

// Brings every node that is not fixed to where(number, position) within one step, at rest afterwards: for viscous
// stress too, which remembers the strain of the last step.
template <class Where>
void place(Body& body, double dt, Where&& where) {
  std::vector<Eigen::Vector3d> velocity;
  body.begin_step(dt, Eigen::Vector3d::Zero());
  for (std::uint32_t n = 0; n < body.positions().size(); ++n) {
    const Eigen::Vector3d wanted = (where(n, body.positions()[n]) - body.positions()[n]) / dt;
    body.add_velocity(n, wanted - body.velocities()[n]);
  }
  body.end_step(dt);
  body.begin_step(dt, Eigen::Vector3d::Zero());
  for (std::uint32_t n = 0; n < body.positions().size(); ++n) body.add_velocity(n, -body.velocities()[n]);
  body.end_step(dt);
}

// J: the elastic energy, and the product of the velocities before and after it. For a linear law this is what an
// explicit step keeps exactly, however fast the modes that swing (Hairer, Lubich, Wanner 2006, I.1.4). Makes the step.
inline double step_energy(Body& body, double dt, const Eigen::Vector3d& gravity = Eigen::Vector3d::Zero()) {
  const double elastic = body.elastic_energy();
  const std::vector<Eigen::Vector3d> before(body.velocities().begin(), body.velocities().end());
  body.begin_step(dt, gravity);
  double kinetic = 0;
  for (std::size_t n = 0; n < before.size(); ++n) {
    if (body.inverse_masses()[n] > 0) kinetic += 0.5 * before[n].dot(body.velocities()[n]) / body.inverse_masses()[n];
  }
  body.end_step(dt);
  return elastic + kinetic;
}

// Anywhere in a body of this radius about the origin, of any size up to the body's.
inline tissue::BladeSweep random_sweep(std::mt19937& random, double radius) {
  std::normal_distribution<double> normal;
  const auto vector = [&](double scale) -> Eigen::Vector3d {
    const double x = normal(random);
    const double y = normal(random);
    return scale * Eigen::Vector3d(x, y, normal(random));
  };
  tissue::BladeSweep sweep;
  sweep.corner = vector(0.5 * radius);
  sweep.along = vector(0.5 * radius);
  sweep.across = vector(0.5 * radius);
  return sweep;
}

struct SurfaceSums {
  Eigen::Vector3d area = Eigen::Vector3d::Zero();  // m2, of all vectors: zero where it is closed
  double size = 0;                                 // m2
  double volume = 0;                               // m3, by the theorem of divergence
};

inline SurfaceSums surface_sums(const Body& body) {
  SurfaceSums sums;
  const auto x = body.surface_positions();
  if (body.surface_triangles().empty()) return sums;
  const Eigen::Vector3d origin = x[body.surface_triangles()[0][0]];
  for (const auto& [a, b, c] : body.surface_triangles()) {
    const Eigen::Vector3d area = 0.5 * (x[b] - x[a]).cross(x[c] - x[a]);
    sums.area += area;
    sums.size += area.norm();
    sums.volume += area.dot(x[a] - origin) / 3.0;
  }
  return sums;
}

}  // namespace cellmirror::tissue_bodies
