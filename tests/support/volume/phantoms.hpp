// Volumes made from formulas, for tests and benchmarks.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "rt_core/ports/voxel_grid.hpp"

namespace cellmirror::phantoms {

// value(p) in stored units, p in V; rounded.
template <class T>
std::shared_ptr<VoxelGrid> grid_of(std::array<std::uint32_t, 3> size, const Eigen::Vector3d& spacing_m,
                                   const std::function<double(const Eigen::Vector3d&)>& value, unsigned threads = 1) {
  auto grid = std::make_shared<VoxelGrid>();
  grid->name = "phantom";
  grid->size = size;
  grid->spacing_m = spacing_m;
  std::vector<T> values(grid->count());
  const auto slices = [&](std::uint32_t first) {
    for (std::uint32_t k = first; k < size[2]; k += threads) {
      for (std::uint32_t j = 0; j < size[1]; ++j) {
        for (std::uint32_t i = 0; i < size[0]; ++i) {
          const Eigen::Vector3d index(i, j, k);
          const Eigen::Vector3d middle = 0.5 * (Eigen::Vector3d(size[0], size[1], size[2]).array() - 1.0);
          const double v = value((index - middle).cwiseProduct(spacing_m));
          values[i + std::size_t{size[0]} * (j + std::size_t{size[1]} * k)] = static_cast<T>(std::lround(v));
        }
      }
    }
  };
  std::vector<std::thread> others;
  for (unsigned t = 1; t < threads; ++t) others.emplace_back(slices, t);
  slices(0);
  for (std::thread& other : others) other.join();
  grid->values = std::move(values);
  return grid;
}

// 1 inside, 0 outside, with a ramp of `width` across the border; `inside` is the distance to the border, m.
inline double part_inside(double inside, double width) { return std::clamp(inside / width + 0.5, 0.0, 1.0); }

// A number from -1 to 1 that goes by the place alone: noise of a scanner.
inline double noise_at(const Eigen::Vector3d& p) {
  std::uint64_t h = 0x9e37'79b9'7f4a'7c15ULL;
  for (int axis = 0; axis < 3; ++axis) {
    h ^= static_cast<std::uint64_t>(std::llround(p[axis] * 1e6)) + 0x632b'e59b'd9b4'e019ULL;
    h *= 0xff51'afd7'ed55'8ccdULL;
    h ^= h >> 32U;
  }
  return static_cast<double>(h & 0xFFFFFU) / 524287.5 - 1.0;
}

// Hounsfield units of a trunk in a cube of `edge_m`: air around, skin and fat, muscle, lungs, a spine, ribs, a liver
// and vessels with contrast medium; noise of +-30.
inline double trunk(const Eigen::Vector3d& p, double edge_m) {
  const Eigen::Vector3d q = p / edge_m;  // -1/2 to 1/2
  const double noise = 30 * noise_at(p);
  const double body = 1 - std::hypot(q.x() / 0.44, q.y() / 0.33);
  if (body < 0 || std::abs(q.z()) > 0.47) return -1000 + 0.5 * noise;
  const double wall = body * 0.33;  // roughly the distance to the skin, in edges
  double value = wall < 0.035 ? -100 : 50;
  const auto ball = [&](double x, double y, double z, double rx, double ry, double rz) {
    return Eigen::Vector3d((q.x() - x) / rx, (q.y() - y) / ry, (q.z() - z) / rz).norm() < 1;
  };
  if (ball(-0.19, -0.02, 0.16, 0.14, 0.19, 0.26) || ball(0.19, -0.02, 0.16, 0.14, 0.19, 0.26)) value = -850;
  if (ball(0.12, -0.03, -0.22, 0.20, 0.17, 0.15)) value = 90;
  const double spine = std::hypot(q.x(), q.y() - 0.20);
  const double vertebra = std::abs(std::remainder(q.z(), 0.09));
  if (spine < 0.06 && vertebra < 0.035) value = spine > 0.05 ? 900 : 350;
  const double ring = std::abs(std::hypot(q.x() / 0.37, (q.y() + 0.01) / 0.27) - 1);
  const double rib = std::abs(std::remainder(q.z() + 0.10 * q.y(), 0.075));
  if (q.z() > -0.15 && ring < 0.035 && rib < 0.012) value = ring < 0.02 && rib < 0.007 ? 400 : 1000;
  const double vessel = std::hypot(q.x() - 0.02 * std::sin(20 * q.z()), q.y() - 0.10);
  if (vessel < 0.02) value = 300;
  return value + noise;
}

inline std::shared_ptr<VoxelGrid> trunk_grid(std::uint32_t size, double edge_m = 0.40, unsigned threads = 1) {
  const double spacing = edge_m / size;
  auto grid = grid_of<std::int16_t>(
      {size, size, size}, Eigen::Vector3d::Constant(spacing),
      [&](const Eigen::Vector3d& p) { return trunk(p, edge_m); }, threads);
  grid->hounsfield = true;
  return grid;
}

}  // namespace cellmirror::phantoms
