// Arms whose second, third and fourth axes are parallel (Universal Robots and their like): what happens along that
// direction depends on the first and fifth joint only, the rest is a planar arm. Elias and Wen, "IK-Geo", 2022.
#pragma once

#include <string_view>
#include <vector>

#include "rt_core/base/pose.hpp"
#include "rt_core/inverse_kinematics/closed_form_subproblems.hpp"

namespace cellmirror::inverse_kinematics::closed_form {

class ThreeParallel {
 public:
  struct Candidate;
  // As SphericalWrist::recognise.
  static void recognise(const Axes& axes, double reach, double tolerance, std::vector<Candidate>& candidates);

  // As SphericalWrist::solve.
  void solve(const Pose& X, const Near& near, Postures& out) const noexcept;

 private:
  struct Ends {  // first and fifth joint
    std::array<Turn, 4> first;
    std::array<Turn, 4> fifth;
    std::size_t count = 0;
  };

  void prepare(double reach, double deviation);
  void solve_ends(const Pose& X, const Near& near, Ends& out) const noexcept;
  void solve_ends_general(const Pose& X, Ends& out) const noexcept;
  // Joints 2 to 4, given the others; false where out of reach.
  bool solve_middle(const Pose& X, const Near& near, Posture& posture, Postures& out) const noexcept;

  Axes axes_;
  bool intersecting_56_ = true;
  double sign_3_ = 1;  // of the axes 3 and 4 against axis 2
  double sign_4_ = 1;
  Vector point_6_ = Vector::Zero();              // of axis 6, and of axis 5 where they intersect
  Circle fourth_about_3_;                        // a point of axis 4
  Vector side_ = Vector::UnitX();                // a unit vector across axis 2
  Eigen::Matrix2d B_ = Eigen::Matrix2d::Zero();  // general: the equations' share of joint 5
  Eigen::Matrix2d B_inverse_ = Eigen::Matrix2d::Zero();
  double reach_ = 1;
  double slack_ = 0;  // m
};

struct ThreeParallel::Candidate {
  ThreeParallel arm;
  std::string_view name;
  double deviation = 0;  // m
  bool general = false;
};

}  // namespace cellmirror::inverse_kinematics::closed_form
