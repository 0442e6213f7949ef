// The simplex of Gilbert, Johnson and Keerthi's algorithm: up to four points of the difference of two bodies, and the
// point of their hull that is nearest to the origin. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace cellmirror::geometry {

class Simplex {
 public:
  // Adds w = a - b (a of body A, b of body B) and finds the nearest point of the new hull, in which only the points
  // that carry it stay. False, and nothing changed, where that brings it no nearer: rounding has the last word.
  bool add(const Eigen::Vector3d& w, const Eigen::Vector3d& a) noexcept;

  [[nodiscard]] bool has(const Eigen::Vector3d& w) const noexcept;
  [[nodiscard]] bool encloses_origin() const noexcept { return encloses_; }
  [[nodiscard]] const Eigen::Vector3d& nearest() const noexcept { return nearest_; }
  [[nodiscard]] double squared() const noexcept { return squared_; }  // of the length of nearest()
  [[nodiscard]] Eigen::Vector3d point_of_a() const noexcept;
  [[nodiscard]] Eigen::Vector3d point_of_b() const noexcept;
  // Where the origin is enclosed or reached: a point of both bodies.
  [[nodiscard]] Eigen::Vector3d common_point() const noexcept;

 private:
  // A part of the hull that may be the nearest: a corner, edge or face.
  struct Feature {
    std::array<std::uint8_t, 4> slots{};
    std::array<double, 4> weights{};
    std::uint8_t count = 0;
    Eigen::Vector3d nearest;
    double squared;
  };

  void consider_corner(std::uint8_t i, Feature& best) const noexcept;
  void consider_edge(std::uint8_t i, std::uint8_t k, Feature& best) const noexcept;
  void consider_face(std::uint8_t i, std::uint8_t k, std::uint8_t l, Feature& best) const noexcept;
  // False where the origin is inside.
  bool consider_tetrahedron(const std::array<std::uint8_t, 3>& old, std::uint8_t added, Feature& best) const noexcept;
  [[nodiscard]] std::uint8_t free_slot() const noexcept;

  std::array<Eigen::Vector3d, 4> w_;
  std::array<Eigen::Vector3d, 4> a_;
  std::array<std::uint8_t, 4> slots_{};  // those in use
  std::array<double, 4> weights_{};
  std::uint8_t count_ = 0;
  bool encloses_ = false;
  std::array<std::uint8_t, 4> inside_slots_{};  // where it does: the tetrahedron and the weights of the origin in it
  std::array<double, 4> inside_weights_{};
  Eigen::Vector3d nearest_;
  double squared_;
};

}  // namespace cellmirror::geometry
