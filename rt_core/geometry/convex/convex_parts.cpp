#include "rt_core/geometry/convex/convex_parts.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "rt_core/geometry/convex/convex_hull.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair_steps.hpp"
#include "rt_core/geometry/triangle.hpp"

namespace cellmirror::geometry {

namespace {

using Plane = Eigen::Hyperplane<double, 3>;

constexpr std::size_t kSamples = 1500;  // triangles examined to rate a piece or a cut

struct Piece {
  std::vector<Triangle> surface;  // the part of the mesh's surface in it
  std::vector<Plane> cuts;        // inside: none of them has a positive distance
  TriangleMesh hull;
  double volume = 0;     // of the hull, m3
  double concavity = 0;  // m; 0 where it is not to be cut any more
  Triangle worst{};      // where the hull stands off most
};

struct Halves {
  std::vector<Triangle> above;
  std::vector<Triangle> below;
};

std::vector<Eigen::Vector3d> corners(const std::vector<Triangle>& triangles) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) out.insert(out.end(), t.begin(), t.end());
  return out;
}

// A triangle that the plane cuts: one corner on its own side, two on the other.
void cut(const Triangle& t, const std::array<double, 3>& d, Halves& out) {
  const auto above = [&](std::size_t i) { return d[i % 3] > 0.0; };
  std::size_t lone = 0;
  while (lone < 2 && (above(lone) == above(lone + 1) || above(lone) == above(lone + 2))) ++lone;
  const std::size_t j = (lone + 1) % 3;
  const std::size_t k = (lone + 2) % 3;
  const auto on_plane = [&](std::size_t i) -> Eigen::Vector3d {
    return t[lone] + (d[lone] / (d[lone] - d[i])) * (t[i] - t[lone]);
  };
  const Eigen::Vector3d p = on_plane(j);
  const Eigen::Vector3d q = on_plane(k);
  auto& own = d[lone] > 0.0 ? out.above : out.below;
  auto& other = d[lone] > 0.0 ? out.below : out.above;
  own.push_back({t[lone], p, q});
  other.push_back({p, t[j], t[k]});
  other.push_back({p, t[k], q});
}

Halves split(const std::vector<Triangle>& surface, const Plane& plane, double tolerance, std::size_t stride) {
  Halves out;
  for (std::size_t i = 0; i < surface.size(); i += stride) {
    const Triangle& t = surface[i];
    const std::array<double, 3> d{plane.signedDistance(t[0]), plane.signedDistance(t[1]), plane.signedDistance(t[2])};
    const auto [low, high] = std::minmax({d[0], d[1], d[2]});
    const bool above = low >= -tolerance;
    const bool below = high <= tolerance;
    if (above && below) {
      // In the plane: the body is behind it.
      const double facing = (t[1] - t[0]).cross(t[2] - t[0]).dot(plane.normal());
      (facing > 0.0 ? out.below : out.above).push_back(t);
    } else if (above || below) {
      (above ? out.above : out.below).push_back(t);
    } else {
      cut(t, d, out);
    }
  }
  return out;
}

Plane reversed(const Plane& plane) {
  Plane out = plane;
  out.coeffs() = -out.coeffs();
  return out;
}

// The points in which three of the planes meet and none of the others cuts them off.
std::vector<Eigen::Vector3d> corners_of_region(const std::vector<Plane>& planes, double tolerance) {
  std::vector<Eigen::Vector3d> out;
  constexpr double kParallel = 1e-9;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      for (std::size_t k = j + 1; k < planes.size(); ++k) {
        Eigen::Matrix3d normals;
        normals << planes[i].normal().transpose(), planes[j].normal().transpose(), planes[k].normal().transpose();
        if (std::abs(normals.determinant()) < kParallel) continue;
        const Eigen::Vector3d offsets(planes[i].offset(), planes[j].offset(), planes[k].offset());
        const Eigen::Vector3d p = normals.inverse() * -offsets;
        if (std::ranges::all_of(planes, [&](const Plane& plane) { return plane.signedDistance(p) <= tolerance; }))
          out.push_back(p);
      }
    }
  }
  return out;
}

class Decomposition {
 public:
  Decomposition(const TriangleMesh& mesh, const PartsSettings& settings) : mesh_(mesh), settings_(settings) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : mesh.vertices) box.extend(p);
    size_ = box.diagonal().norm();
    constexpr double kOnPlane = 1e-12;
    tolerance_ = kOnPlane * size_;
  }

  Result<std::vector<TriangleMesh>> run() {
    std::vector<Triangle> surface;
    surface.reserve(mesh_.triangles.size());
    for (const auto& [a, b, c] : mesh_.triangles)
      surface.push_back({mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]});
    auto whole = convex_hull(mesh_.name, mesh_.vertices);
    if (!whole) return std::unexpected(whole.error());
    all_.resize(mesh_.triangles.size());
    std::iota(all_.begin(), all_.end(), 0U);
    pieces_.push_back(piece_of(std::move(surface), {}, std::move(*whole)));
    while (pieces_.size() < std::max<std::size_t>(settings_.most, 1)) {
      const auto worst = std::ranges::max_element(pieces_, {}, &Piece::concavity);
      if (worst->concavity <= settings_.concavity * size_) break;
      cut_piece(static_cast<std::size_t>(worst - pieces_.begin()));
    }
    merge();
    std::vector<TriangleMesh> out;
    for (Piece& piece : pieces_) {
      piece.hull.name = fmt::format("{} part {}", mesh_.name, out.size() + 1);
      out.push_back(std::move(piece.hull));
    }
    return out;
  }

 private:
  static Piece piece_of(std::vector<Triangle> surface, std::vector<Plane> cuts, TriangleMesh hull) {
    Piece piece;
    piece.surface = std::move(surface);
    piece.cuts = std::move(cuts);
    piece.hull = std::move(hull);
    piece.volume = signed_volume(piece.hull);
    rate(piece);
    return piece;
  }

  // How far the hull stands off the surface, seen from the surface along its normals.
  static void rate(Piece& piece) {
    std::vector<Plane> planes;
    for (const auto& [a, b, c] : piece.hull.triangles) {
      const auto& v = piece.hull.vertices;
      const Eigen::Vector3d normal = (v[b] - v[a]).cross(v[c] - v[a]).normalized();
      planes.emplace_back(normal, v[a]);
    }
    constexpr double kGrazing = 1e-6;
    const std::size_t stride = 1 + piece.surface.size() / kSamples;
    for (std::size_t i = 0; i < piece.surface.size(); i += stride) {
      const Triangle& t = piece.surface[i];
      const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
      const Eigen::Vector3d centre = (t[0] + t[1] + t[2]) / 3.0;
      double way = std::numeric_limits<double>::infinity();
      for (const Plane& plane : planes) {
        const double slope = plane.normal().dot(normal);
        if (slope > kGrazing) way = std::min(way, std::max(0.0, -plane.signedDistance(centre)) / slope);
      }
      if (!std::isfinite(way) || way <= piece.concavity) continue;
      piece.concavity = way;
      piece.worst = t;
    }
  }

  [[nodiscard]] static std::vector<Plane> candidates(const Piece& piece) {
    std::vector<Plane> out;
    const Triangle& w = piece.worst;
    const Eigen::Vector3d normal = (w[1] - w[0]).cross(w[2] - w[0]);
    if (normal.norm() > 0.0) out.emplace_back(normal.normalized(), w[0]);
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : piece.hull.vertices) box.extend(p);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d direction = Eigen::Vector3d::Unit(axis);
      for (const Eigen::Vector3d& corner : w) out.emplace_back(direction, corner);
      for (const double share : {0.25, 0.5, 0.75}) {
        const Eigen::Vector3d p = box.min() + share * box.sizes();
        out.emplace_back(direction, p);
      }
    }
    return out;
  }

  // The volume of the hulls of both halves; nothing where there are not two bodies.
  [[nodiscard]] std::optional<double> volume_after(const Piece& piece, const Plane& plane) const {
    const std::size_t stride = 1 + piece.surface.size() / kSamples;
    const Halves halves = split(piece.surface, plane, tolerance_, stride);
    const auto above = convex_hull({}, corners(halves.above));
    if (!above) return std::nullopt;
    const auto below = convex_hull({}, corners(halves.below));
    if (!below) return std::nullopt;
    return signed_volume(*above) + signed_volume(*below);
  }

  // The plane that leaves the least volume; where none leaves less, as with rings, the middle of the longest side.
  [[nodiscard]] Plane best_cut(const Piece& piece) const {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : piece.hull.vertices) box.extend(p);
    Eigen::Index longest = 0;
    box.sizes().maxCoeff(&longest);
    const Eigen::Vector3d across = Eigen::Vector3d::Unit(longest);
    const Eigen::Vector3d centre = box.center();
    Plane best(across, centre);
    constexpr double kWorthIt = 0.99;
    double least = kWorthIt * piece.volume;
    for (const Plane& plane : candidates(piece)) {
      const auto volume = volume_after(piece, plane);
      if (!volume || *volume >= least) continue;
      least = *volume;
      best = plane;
    }
    return best;
  }

  // The hull of what a piece holds of the surface and of the inside. Corners of the inside lie on the surface, but for
  // those in which three cuts meet.
  [[nodiscard]] Result<TriangleMesh> hull_of(const std::vector<Triangle>& surface,
                                             const std::vector<Plane>& cuts) const {
    std::vector<Eigen::Vector3d> points = corners(surface);
    if (mesh_.closed) {
      constexpr double kPerhapsInside = 0.1;  // a corner too many does no harm
      for (const Eigen::Vector3d& p : corners_of_region(cuts, tolerance_)) {
        if (std::abs(winding_number(mesh_.vertices, mesh_.triangles, all_, p)) > kPerhapsInside) points.push_back(p);
      }
    }
    return convex_hull(mesh_.name, points);
  }

  // Where there are not two bodies afterwards the piece stays as it is.
  void cut_piece(std::size_t index) {
    Piece& piece = pieces_[index];
    const Plane plane = best_cut(piece);
    piece.concavity = 0.0;  // unless it is replaced
    Halves halves = split(piece.surface, plane, tolerance_, 1);
    std::vector<Plane> cuts_above = piece.cuts;
    cuts_above.push_back(reversed(plane));
    std::vector<Plane> cuts_below = piece.cuts;
    cuts_below.push_back(plane);
    auto above = hull_of(halves.above, cuts_above);
    if (!above) return;
    auto below = hull_of(halves.below, cuts_below);
    if (!below) return;
    pieces_[index] = piece_of(std::move(halves.above), std::move(cuts_above), std::move(*above));
    pieces_.push_back(piece_of(std::move(halves.below), std::move(cuts_below), std::move(*below)));
  }

  // Makes one of two pieces that fill their common hull.
  void merge() {
    constexpr double kFilled = 1.002;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      for (std::size_t k = i + 1; k < pieces_.size();) {
        std::vector<Eigen::Vector3d> points = pieces_[i].hull.vertices;
        points.insert(points.end(), pieces_[k].hull.vertices.begin(), pieces_[k].hull.vertices.end());
        auto both = convex_hull(mesh_.name, points);
        const double volume = both ? signed_volume(*both) : 0.0;
        if (!both || volume > kFilled * (pieces_[i].volume + pieces_[k].volume)) {
          ++k;
          continue;
        }
        pieces_[i].hull = std::move(*both);
        pieces_[i].volume = volume;
        pieces_.erase(pieces_.begin() + static_cast<std::ptrdiff_t>(k));
        k = i + 1;
      }
    }
  }

  const TriangleMesh& mesh_;
  PartsSettings settings_;
  std::vector<std::uint32_t> all_;  // triangles of the mesh
  double size_ = 0;                 // m
  double tolerance_ = 0;            // m; nearer to the plane is on it
  std::vector<Piece> pieces_;
};

}  // namespace

Result<std::vector<TriangleMesh>> convex_parts(const TriangleMesh& mesh, const PartsSettings& settings) {
  return Decomposition(mesh, settings).run();
}

}  // namespace cellmirror::geometry
