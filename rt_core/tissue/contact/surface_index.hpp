// Finds triangles of a body's surface near a place: clusters of neighbouring triangles with boxes. A sixteenth of
// the boxes is renewed a step; the others grow by the way that the body's fastest node may have gone since. Computes
// positions of surface points only where they are asked for.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "rt_core/geometry/triangle.hpp"
#include "rt_core/tissue/body/body.hpp"

namespace cellmirror::tissue {

class SurfaceIndex {
 public:
  struct Cluster {
    Eigen::Vector3d low = Eigen::Vector3d::Zero();
    Eigen::Vector3d high = Eigen::Vector3d::Zero();
    std::uint32_t first = 0;  // in the order of triangles()
    std::uint32_t count = 0;
    std::uint32_t first_point = 0;  // in the order of points()
    std::uint32_t points = 0;
    double drift = 0;  // m, of the body when the box was renewed
  };

  // Of the body as it is now. Not in bounded memory: after make(), cuts and reset() only. True: nothing remembered
  // about the old one is valid.
  void rebuild(const Body& body);
  // Once before each search: positions of the last step are forgotten. `way`: m, that a node can have gone since.
  void advance(const Body& body, double way);

  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  [[nodiscard]] std::span<const Cluster> clusters() const { return clusters_; }
  // m that any point can have gone at most since rebuild(), on all steps together.
  [[nodiscard]] double way() const { return drift_; }
  [[nodiscard]] double margin(const Cluster& cluster) const { return drift_ - cluster.drift; }  // m
  [[nodiscard]] std::span<const std::uint32_t> triangles(const Cluster& cluster) const {
    return std::span(triangles_).subspan(cluster.first, cluster.count);
  }
  [[nodiscard]] std::span<const std::uint32_t> points(const Cluster& cluster) const {
    return std::span(points_).subspan(cluster.first_point, cluster.points);
  }
  // Of all clusters, grown by their margins.
  [[nodiscard]] const Eigen::Vector3d& low() const { return low_; }
  [[nodiscard]] const Eigen::Vector3d& high() const { return high_; }

  // Numbers of clusters that may reach the segment from a to b by `reach`; appended.
  void near_segment(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double reach,
                    std::vector<std::uint32_t>& found) const;
  void near_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double reach,
                std::vector<std::uint32_t>& found) const;

  [[nodiscard]] const Eigen::Vector3d& position(const Body& body, std::uint32_t point);
  [[nodiscard]] geometry::Triangle corners(const Body& body, std::uint32_t triangle);

 private:
  void renew(const Body& body, Cluster& cluster);
  void bound_all();

  std::uint64_t revision_ = 0;
  std::vector<Cluster> clusters_;
  std::vector<std::uint32_t> triangles_;  // of the body, by cluster
  std::vector<std::uint32_t> points_;     // surface points, by cluster; one of two clusters is in both
  std::vector<Eigen::Vector3d> positions_;
  std::vector<std::uint32_t> rounds_;  // in which a position was computed
  std::uint32_t round_ = 1;
  std::uint32_t next_ = 0;  // cluster to be renewed
  double drift_ = 0;        // m
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d high_ = Eigen::Vector3d::Zero();
};

}  // namespace cellmirror::tissue
