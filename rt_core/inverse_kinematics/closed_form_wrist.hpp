// Arms whose last three axes meet in a point: the first three joints carry the point, the last three turn about it.
// Pieper, "The Kinematics of Manipulators under Computer Control", 1968.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/inverse_kinematics/closed_form_subproblems.hpp"

namespace cellmirror::inverse_kinematics::closed_form {

class SphericalWrist {
 public:
  struct Candidate;
  // Each arrangement of the first three axes that `axes` are within `tolerance` (m) of. `reach`: length that turns
  // angles into metres.
  static void recognise(const Axes& axes, double reach, double tolerance, std::vector<Candidate>& candidates);

  // The postures that move every point p of the tip, given where it is with all joints at zero, to X * p.
  void solve(const Pose& X, const Near& near, Postures& out) const noexcept;

 private:
  enum class Shoulder : std::uint8_t { parallel_23, intersecting_12, parallel_12, intersecting_23, general };
  static constexpr std::size_t kMaxPositions = 4;
  struct Positions {
    std::array<std::array<Turn, 3>, kMaxPositions> turns;
    std::size_t count = 0;
    void add(const Turn& q1, const Turn& q2, const Turn& q3) {
      if (count < kMaxPositions) turns[count++] = {q1, q2, q3};
    }
  };

  void prepare(Shoulder shoulder, double reach, double deviation);
  // The first three joints so that the wrist stands at w.
  void place(const Vector& w, const Near& near, Positions& out) const noexcept;
  void place_parallel_23(const Vector& w, const Near& near, Positions& out) const noexcept;
  void place_intersecting_12(const Vector& w, const Near& near, Positions& out) const noexcept;
  void place_parallel_12(const Vector& w, const Near& near, Positions& out) const noexcept;
  void place_intersecting_23(const Vector& w, const Near& near, Positions& out) const noexcept;
  void place_general(const Vector& w, const Near& near, Positions& out) const noexcept;
  // The last three so that they turn h6 into u and side_ into v.
  void orient(const std::array<Turn, 3>& arm, const Vector& u, const Vector& v, const Near& near,
              Postures& out) const noexcept;

  Axes axes_;
  Shoulder shoulder_ = Shoulder::general;
  Vector wrist_ = Vector::Zero();  // at zero
  Vector point_ = Vector::Zero();  // where the axes of intersecting_* meet; for general a point of axis 2
  Circle wrist_about_3_;
  Vector side_ = Vector::UnitX();                // a unit vector across axis 6
  Eigen::Matrix2d B_ = Eigen::Matrix2d::Zero();  // of `general`: the equations' share of joint 3
  Eigen::Matrix2d B_inverse_ = Eigen::Matrix2d::Zero();
  double reach_ = 1;
  double slack_ = 0;  // m
};

struct SphericalWrist::Candidate {
  SphericalWrist arm;
  std::string_view name;
  double deviation = 0;  // m
  bool general = false;  // solved numerically: taken after the others
};

}  // namespace cellmirror::inverse_kinematics::closed_form
