#include "rt_core/tissue/contact/surface_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kTrianglesInCluster = 32;
constexpr std::uint32_t kRenewedPart = 16;  // one of so many clusters a step

// Every third bit, from the lowest ten of x.
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x3FFU;
  x = (x | (x << 16U)) & 0x30000FFU;
  x = (x | (x << 8U)) & 0x300F00FU;
  x = (x | (x << 4U)) & 0x30C30C3U;
  return (x | (x << 2U)) & 0x9249249U;
}

// Order of a point on a curve through space (Morton 1966): neighbours in it are neighbours in space.
std::uint64_t place_on_curve(const Vector3d& p, const Vector3d& low, double scale) {
  std::uint64_t code = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::clamp((p[axis] - low[axis]) * scale, 0.0, 1023.0);
    code |= spread_bits(static_cast<std::uint64_t>(cell)) << static_cast<unsigned>(axis);
  }
  return code;
}

// Squared distance between a point and the segment from a along d, whose squared length is dd.
double squared_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& d, double dd) {
  const Vector3d r = p - a;
  const double t = dd > 0 ? std::clamp(r.dot(d) / dd, 0.0, 1.0) : 0.0;
  return (r - t * d).squaredNorm();
}

}  // namespace

void SurfaceIndex::rebuild(const Body& body) {
  const auto triangles = body.surface_triangles();
  const auto all = body.surface_positions();
  revision_ = body.revision();
  positions_.assign(all.begin(), all.end());
  rounds_.assign(all.size(), 1);
  round_ = 1;
  next_ = 0;
  drift_ = 0;

  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (const auto& triangle : triangles) {
    low = low.cwiseMin(positions_[triangle[0]]);
    high = high.cwiseMax(positions_[triangle[0]]);
  }
  const double extent = triangles.empty() ? 1.0 : std::max((high - low).maxCoeff(), 1e-9);
  std::vector<std::uint64_t> order(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    order[i] = (place_on_curve(positions_[triangles[i][0]], low, 1023.0 / extent) << 32U) | i;
  }
  std::ranges::sort(order);

  triangles_.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) triangles_[i] = static_cast<std::uint32_t>(order[i]);
  clusters_.clear();
  points_.clear();
  std::vector<std::uint32_t> used;
  for (std::uint32_t first = 0; first < triangles_.size(); first += kTrianglesInCluster) {
    Cluster cluster;
    cluster.first = first;
    cluster.count = std::min<std::uint32_t>(kTrianglesInCluster, static_cast<std::uint32_t>(triangles_.size()) - first);
    used.clear();
    for (const std::uint32_t triangle : this->triangles(cluster)) {
      used.insert(used.end(), triangles[triangle].begin(), triangles[triangle].end());
    }
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    cluster.first_point = static_cast<std::uint32_t>(points_.size());
    cluster.points = static_cast<std::uint32_t>(used.size());
    points_.insert(points_.end(), used.begin(), used.end());
    renew(body, cluster);
    clusters_.push_back(cluster);
  }
  bound_all();
}

void SurfaceIndex::advance(const Body& body, double way) {
  if (++round_ == 0) {
    std::ranges::fill(rounds_, 0U);
    round_ = 1;
  }
  drift_ += way;
  const auto count = static_cast<std::uint32_t>(clusters_.size());
  for (std::uint32_t i = 0; i < (count + kRenewedPart - 1) / kRenewedPart; ++i) {
    renew(body, clusters_[next_]);
    next_ = next_ + 1 < count ? next_ + 1 : 0;
  }
  bound_all();
}

void SurfaceIndex::renew(const Body& body, Cluster& cluster) {
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (const std::uint32_t point : points(cluster)) {
    const Vector3d& p = position(body, point);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  cluster.low = low;
  cluster.high = high;
  cluster.drift = drift_;
}

void SurfaceIndex::bound_all() {
  low_ = Vector3d::Constant(std::numeric_limits<double>::infinity());
  high_ = -low_;
  for (const Cluster& cluster : clusters_) {
    const Vector3d grown = Vector3d::Constant(margin(cluster));
    low_ = low_.cwiseMin(cluster.low - grown);
    high_ = high_.cwiseMax(cluster.high + grown);
  }
}

void SurfaceIndex::near_segment(const Vector3d& a, const Vector3d& b, double reach,
                                std::vector<std::uint32_t>& found) const {
  const Vector3d wide = Vector3d::Constant(reach);
  const Vector3d low = a.cwiseMin(b) - wide;
  const Vector3d high = a.cwiseMax(b) + wide;
  if ((low.array() > high_.array()).any() || (high.array() < low_.array()).any()) return;
  const Vector3d d = b - a;
  const double dd = d.squaredNorm();
  for (std::uint32_t i = 0; i < clusters_.size(); ++i) {
    const Cluster& cluster = clusters_[i];
    const double grown = margin(cluster);
    if ((low.array() > cluster.high.array() + grown).any() || (high.array() < cluster.low.array() - grown).any())
      continue;
    const double within = 0.5 * (cluster.high - cluster.low).norm() + grown + reach;
    if (squared_to_segment(0.5 * (cluster.low + cluster.high), a, d, dd) <= within * within) found.push_back(i);
  }
}

void SurfaceIndex::near_box(const Vector3d& low, const Vector3d& high, double reach,
                            std::vector<std::uint32_t>& found) const {
  for (std::uint32_t i = 0; i < clusters_.size(); ++i) {
    const Cluster& cluster = clusters_[i];
    const double grown = margin(cluster) + reach;
    if ((low.array() > cluster.high.array() + grown).any() || (high.array() < cluster.low.array() - grown).any())
      continue;
    found.push_back(i);
  }
}

const Vector3d& SurfaceIndex::position(const Body& body, std::uint32_t point) {
  if (rounds_[point] != round_) {
    rounds_[point] = round_;
    positions_[point] = body.position(body.surface_points()[point]);
  }
  return positions_[point];
}

geometry::Triangle SurfaceIndex::corners(const Body& body, std::uint32_t triangle) {
  const auto& points = body.surface_triangles()[triangle];
  return {position(body, points[0]), position(body, points[1]), position(body, points[2])};
}

}  // namespace cellmirror::tissue
