#include "rt_core/geometry/convex/convex_simplex.hpp"

#include <cmath>
#include <limits>

#include "rt_core/geometry/convex/convex_support.hpp"

namespace cellmirror::geometry {

namespace {

using Eigen::Vector3d;

// Square of the sine below which a face of the simplex has no usable normal: its edges answer for it.
constexpr double kFlat = 1e-24;

}  // namespace

void Simplex::consider_corner(std::uint8_t i, Feature& best) const noexcept {
  const double squared = dot(w_[i], w_[i]);
  if (!(squared < best.squared)) return;
  best.slots[0] = i;
  best.weights[0] = 1.0;
  best.count = 1;
  best.nearest = w_[i];
  best.squared = squared;
}

void Simplex::consider_edge(std::uint8_t i, std::uint8_t k, Feature& best) const noexcept {
  const Vector3d edge = w_[k] - w_[i];
  const double length_squared = dot(edge, edge);
  const double along = -dot(w_[i], edge);
  if (!(along > 0.0)) return consider_corner(i, best);
  if (!(along < length_squared)) return consider_corner(k, best);
  const double part = along / length_squared;
  Vector3d nearest = w_[i] + part * edge;
  // Once more, for the digits of the direction: the nearest point may be very near in comparison to the edge's length.
  nearest -= (dot(nearest, edge) / length_squared) * edge;
  const double squared = dot(nearest, nearest);
  if (!(squared < best.squared)) return;
  best.slots = {i, k, 0, 0};
  best.weights = {1.0 - part, part, 0.0, 0.0};
  best.count = 2;
  best.nearest = nearest;
  best.squared = squared;
}

void Simplex::consider_face(std::uint8_t i, std::uint8_t k, std::uint8_t l, Feature& best) const noexcept {
  const Vector3d& p = w_[i];
  const Vector3d& q = w_[k];
  const Vector3d& r = w_[l];
  const Vector3d u = q - p;
  const Vector3d v = r - p;
  const Vector3d n = cross(u, v);
  const double nn = dot(n, n);
  if (!(nn > kFlat * dot(u, u) * dot(v, v))) {
    consider_edge(i, k, best);
    consider_edge(i, l, best);
    return consider_edge(k, l, best);
  }
  // Areas of the triangles that the origin's projection makes with the edges, times the length of n. From edges, not
  // from pairs of corners, which may lie close together far away.
  const double at_i = dot(cross(q, r - q), n);
  const double at_k = dot(cross(v, p), n);
  const double at_l = dot(cross(p, u), n);
  if (at_i >= 0.0 && at_k >= 0.0 && at_l >= 0.0) {
    const Vector3d nearest = (dot(p, n) / nn) * n;
    const double squared = dot(nearest, nearest);
    if (!(squared < best.squared)) return;
    const double sum = at_i + at_k + at_l;
    best.slots = {i, k, l, 0};
    best.weights = {at_i / sum, at_k / sum, at_l / sum, 0.0};
    best.count = 3;
    best.nearest = nearest;
    best.squared = squared;
    return;
  }
  if (at_l < 0.0) consider_edge(i, k, best);
  if (at_k < 0.0) consider_edge(i, l, best);
  if (at_i < 0.0) consider_edge(k, l, best);
}

bool Simplex::consider_tetrahedron(const std::array<std::uint8_t, 3>& old, std::uint8_t added,
                                   Feature& best) const noexcept {
  // The face without the added point need not be looked at: the origin is on its inner side, or it would have been
  // enough.
  bool inside = true;
  const Vector3d& p = w_[added];
  std::array<double, 3> volumes{};  // of the origin and each face, as parts of the whole
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint8_t k = old[i];
    const std::uint8_t l = old[i == 2 ? 0 : i + 1];
    const std::uint8_t opposite = old[i == 0 ? 2 : i - 1];
    const Vector3d n = cross(w_[k] - p, w_[l] - p);
    const double height = dot(p, n);
    const double whole = dot(p - w_[opposite], n);
    if (height * whole > 0.0) {
      volumes[i == 0 ? 2 : i - 1] = height / whole;
      continue;
    }
    inside = false;
    consider_face(added, k, l, best);
  }
  if (!inside) return true;
  best.slots = {old[0], old[1], old[2], added};
  best.weights = {volumes[0], volumes[1], volumes[2], 1.0 - volumes[0] - volumes[1] - volumes[2]};
  return false;
}

std::uint8_t Simplex::free_slot() const noexcept {
  for (std::uint8_t slot = 0; slot < 4; ++slot) {
    bool used = false;
    for (std::uint8_t i = 0; i < count_; ++i) used = used || slots_[i] == slot;
    if (!used) return slot;
  }
  return 0;
}

bool Simplex::add(const Vector3d& w, const Vector3d& a) noexcept {
  const std::uint8_t slot = free_slot();
  w_[slot] = w;
  a_[slot] = a;
  Feature best;
  best.squared = count_ > 0 ? squared_ : std::numeric_limits<double>::infinity();
  switch (count_) {
    case 0:
      consider_corner(slot, best);
      break;
    case 1:
      consider_edge(slot, slots_[0], best);
      break;
    case 2:
      consider_face(slot, slots_[0], slots_[1], best);
      break;
    default:
      if (!consider_tetrahedron({slots_[0], slots_[1], slots_[2]}, slot, best)) {
        inside_slots_ = best.slots;
        inside_weights_ = best.weights;
        encloses_ = true;
        return true;
      }
  }
  if (best.count == 0) return false;
  slots_ = best.slots;
  weights_ = best.weights;
  count_ = best.count;
  nearest_ = best.nearest;
  squared_ = best.squared;
  return true;
}

bool Simplex::has(const Vector3d& w) const noexcept {
  for (std::uint8_t i = 0; i < count_; ++i) {
    const Vector3d& known = w_[slots_[i]];
    if (known[0] == w[0] && known[1] == w[1] && known[2] == w[2]) return true;
  }
  return false;
}

Vector3d Simplex::point_of_a() const noexcept {
  Vector3d p = Vector3d::Zero();
  for (std::uint8_t i = 0; i < count_; ++i) p += weights_[i] * a_[slots_[i]];
  return p;
}

Vector3d Simplex::point_of_b() const noexcept {
  Vector3d p = Vector3d::Zero();
  for (std::uint8_t i = 0; i < count_; ++i) p += weights_[i] * (a_[slots_[i]] - w_[slots_[i]]);
  return p;
}

Vector3d Simplex::common_point() const noexcept {
  if (!encloses_) return point_of_a();
  Vector3d p = Vector3d::Zero();
  for (std::size_t i = 0; i < 4; ++i) p += inside_weights_[i] * a_[inside_slots_[i]];
  return p;
}

}  // namespace cellmirror::geometry
