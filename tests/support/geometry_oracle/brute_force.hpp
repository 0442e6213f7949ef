// Distances of triangles, meshes and primitives the slow way, for tests: shares no code with rt_core/geometry. Every
// pair of triangles is looked at, in long double; a pair's distance is the least over all pairs of their features
// (corners, edges, faces) of the stationary point between the spaces that the features span, where it lies in both
// (the conditions of Karush, Kuhn and Tucker, written out).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::geometry_oracle {

using Real = long double;
using Point = std::array<Real, 3>;
using Corners = std::array<Point, 3>;

inline Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Real scalar(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// A corner, edge or face: origin + s * first + t * second with s, t >= 0 and s + t <= 1.
struct Feature {
  Point origin;
  std::array<Point, 2> along;
  std::size_t dimension;
};

inline std::array<Feature, 7> features_of(const Corners& c) {
  std::array<Feature, 7> out{};
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = {c[i], {}, 0};
    out[3 + i] = {c[i], {minus(c[(i + 1) % 3], c[i]), Point{}}, 1};
  }
  out[6] = {c[0], {minus(c[1], c[0]), minus(c[2], c[0])}, 2};
  return out;
}

// The solution of a small symmetric system by elimination with full pivoting; none where it is singular.
template <std::size_t N>
std::optional<std::array<Real, N>> solve(std::array<std::array<Real, N + 1>, N> m, std::size_t n) {
  std::array<std::size_t, N> column{};
  for (std::size_t i = 0; i < n; ++i) column[i] = i;
  Real greatest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t row = i;
    std::size_t best = i;
    for (std::size_t r = i; r < n; ++r) {
      for (std::size_t c = i; c < n; ++c) {
        if (std::abs(m[r][c]) > std::abs(m[row][best])) {
          row = r;
          best = c;
        }
      }
    }
    greatest = std::max(greatest, std::abs(m[row][best]));
    if (!(std::abs(m[row][best]) > 1e-17L * greatest) || greatest == 0) return std::nullopt;
    std::swap(m[i], m[row]);
    for (std::size_t r = 0; r < n; ++r) std::swap(m[r][i], m[r][best]);
    std::swap(column[i], column[best]);
    for (std::size_t r = i + 1; r < n; ++r) {
      const Real factor = m[r][i] / m[i][i];
      for (std::size_t c = i; c < n; ++c) m[r][c] -= factor * m[i][c];
      m[r][N] -= factor * m[i][N];
    }
  }
  std::array<Real, N> x{};
  for (std::size_t i = n; i-- > 0;) {
    Real value = m[i][N];
    for (std::size_t c = i + 1; c < n; ++c) value -= m[i][c] * x[column[c]];
    x[column[i]] = value / m[i][i];
  }
  return x;
}

// Square of the distance at the stationary point; none where it lies outside of a feature.
inline std::optional<Real> stationary(const Feature& a, const Feature& b) {
  const std::size_t n = a.dimension + b.dimension;
  std::array<Point, 4> along{};
  for (std::size_t i = 0; i < a.dimension; ++i) along[i] = a.along[i];
  for (std::size_t i = 0; i < b.dimension; ++i) {
    for (std::size_t k = 0; k < 3; ++k) along[a.dimension + i][k] = -b.along[i][k];
  }
  Point gap = minus(a.origin, b.origin);
  if (n > 0) {
    std::array<std::array<Real, 5>, 4> m{};
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c) m[r][c] = scalar(along[r], along[c]);
      m[r][4] = -scalar(along[r], gap);
    }
    const auto x = solve<4>(m, n);
    if (!x) return std::nullopt;
    Real sum_a = 0;
    Real sum_b = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!((*x)[i] >= 0)) return std::nullopt;
      (i < a.dimension ? sum_a : sum_b) += (*x)[i];
    }
    if (!(sum_a <= 1 && sum_b <= 1)) return std::nullopt;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < 3; ++k) gap[k] += (*x)[i] * along[i][k];
    }
  }
  return scalar(gap, gap);
}

// 0 where the triangles intersect. Degenerate triangles are segments and points.
inline Real distance(const Corners& a, const Corners& b) {
  Real squared = std::numeric_limits<Real>::infinity();
  const auto features_a = features_of(a);
  const auto features_b = features_of(b);
  for (const Feature& one : features_a) {
    for (const Feature& other : features_b) {
      if (one.dimension + other.dimension > 3) continue;  // faces that cross do so in the edge of one
      if (const auto found = stationary(one, other)) squared = std::min(squared, *found);
    }
  }
  return std::sqrt(squared);
}

inline Corners corners_of(const std::array<Eigen::Vector3d, 3>& triangle) {
  Corners out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i][k] = triangle[i][static_cast<Eigen::Index>(k)];
  }
  return out;
}

// The triangles of a mesh in frame W, counted from `origin` so that far from the origin of W no digits are lost.
inline std::vector<Corners> placed(const geometry::TriangleMesh& mesh, const Pose& X_WM,
                                   const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) {
  std::vector<Point> vertices;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    Point p{};
    for (Eigen::Index i = 0; i < 3; ++i) {
      p[static_cast<std::size_t>(i)] = static_cast<Real>(X_WM.translation()[i]) - static_cast<Real>(origin[i]);
      for (Eigen::Index k = 0; k < 3; ++k) {
        p[static_cast<std::size_t>(i)] += static_cast<Real>(X_WM.linear()(i, k)) * static_cast<Real>(vertex[k]);
      }
    }
    vertices.push_back(p);
  }
  std::vector<Corners> out;
  for (const auto& t : mesh.triangles) out.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  return out;
}

struct Box {
  Point low;
  Point high;
};

inline Box box_of(const Corners& c) {
  Box out{};
  for (std::size_t k = 0; k < 3; ++k) {
    out.low[k] = std::min({c[0][k], c[1][k], c[2][k]});
    out.high[k] = std::max({c[0][k], c[1][k], c[2][k]});
  }
  return out;
}

// Lower bound of the square of the distance of what is in the boxes.
inline Real gap_squared(const Box& a, const Box& b) {
  Real squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Real gap = std::max({b.low[k] - a.high[k], a.low[k] - b.high[k], Real{0}});
    squared += gap * gap;
  }
  return squared;
}

struct SurfaceDistance {
  Real distance = std::numeric_limits<Real>::infinity();
  std::size_t triangle_a = 0;
  std::size_t triangle_b = 0;
};

// Every pair, but for those whose boxes are farther apart than some corners are.
inline SurfaceDistance surface_distance(const std::vector<Corners>& a, const std::vector<Corners>& b) {
  std::vector<Box> boxes;
  for (const Corners& c : b) boxes.push_back(box_of(c));
  Real corners = std::numeric_limits<Real>::infinity();
  for (const Corners& one : a) {
    for (const Corners& other : b) {
      const Point gap = minus(one[0], other[0]);
      corners = std::min(corners, scalar(gap, gap));
    }
  }
  SurfaceDistance best;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Box box = box_of(a[i]);
    for (std::size_t k = 0; k < b.size(); ++k) {
      const Real gap = gap_squared(box, boxes[k]);
      if (gap > corners || gap >= best.distance * best.distance) continue;
      const Real found = distance(a[i], b[k]);
      if (found < best.distance) best = {found, i, k};
    }
  }
  return best;
}

// How often a closed surface goes around p: the sum of the solid angles of its triangles (van Oosterom, Strackee 1983).
inline Real winding_number(const std::vector<Corners>& surface, const Point& p) {
  Real sum = 0;
  for (const Corners& c : surface) {
    const Point a = minus(c[0], p);
    const Point b = minus(c[1], p);
    const Point d = minus(c[2], p);
    const Real la = std::sqrt(scalar(a, a));
    const Real lb = std::sqrt(scalar(b, b));
    const Real ld = std::sqrt(scalar(d, d));
    const Real determinant =
        a[0] * (b[1] * d[2] - b[2] * d[1]) - a[1] * (b[0] * d[2] - b[2] * d[0]) + a[2] * (b[0] * d[1] - b[1] * d[0]);
    sum += 2 * std::atan2(determinant, la * lb * ld + scalar(a, b) * ld + scalar(b, d) * la + scalar(d, a) * lb);
  }
  return sum / (4 * std::numbers::pi_v<Real>);
}

// Of triangles that the surface does not cut: one corner tells for the whole triangle.
inline bool any_inside(const std::vector<Corners>& of, const std::vector<Corners>& surface) {
  Box all = box_of(surface[0]);
  for (const Corners& c : surface) {
    const Box box = box_of(c);
    for (std::size_t k = 0; k < 3; ++k) {
      all.low[k] = std::min(all.low[k], box.low[k]);
      all.high[k] = std::max(all.high[k], box.high[k]);
    }
  }
  return std::any_of(of.begin(), of.end(), [&](const Corners& c) {
    return gap_squared(all, {c[0], c[0]}) == 0 && winding_number(surface, c[0]) > 0.5L;
  });
}

// Of bodies: 0 also where one lies inside of the other and that one is closed.
inline double distance(const geometry::TriangleMesh& a, const Pose& X_WA, const geometry::TriangleMesh& b,
                       const Pose& X_WB) {
  const Eigen::Vector3d origin = X_WA.translation();
  const auto triangles_a = placed(a, X_WA, origin);
  const auto triangles_b = placed(b, X_WB, origin);
  const SurfaceDistance surfaces = surface_distance(triangles_a, triangles_b);
  if (surfaces.distance == 0) return 0.0;
  if (a.closed && any_inside(triangles_b, triangles_a)) return 0.0;
  if (b.closed && any_inside(triangles_a, triangles_b)) return 0.0;
  return static_cast<double>(surfaces.distance);
}

}  // namespace cellmirror::geometry_oracle
