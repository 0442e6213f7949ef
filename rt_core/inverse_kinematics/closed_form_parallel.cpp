#include "rt_core/inverse_kinematics/closed_form_parallel.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "rt_core/inverse_kinematics/closed_form_geometry.hpp"
#include "rt_core/inverse_kinematics/closed_form_pair.hpp"

namespace cellmirror::inverse_kinematics::closed_form {

void ThreeParallel::recognise(const Axes& axes, double reach, double tolerance, std::vector<Candidate>& candidates) {
  ThreeParallel arm;
  arm.axes_ = axes;
  const double off = reach * make_parallel(std::span(arm.axes_).subspan<1, 3>());
  if (off > tolerance || sine_between(arm.axes_[3], arm.axes_[4]) < kLeastSine) return;
  arm.point_6_ = axes[5].o;
  if (sine_between(axes[4], axes[5]) < kLeastSine) return;
  arm.intersecting_56_ = false;
  candidates.push_back({arm, "axes 2, 3 and 4 parallel", off, true});
  candidates.back().arm.prepare(reach, off);
  const auto point = meeting(std::span(axes).last<2>());
  if (!point || point->distance > tolerance) return;
  arm.intersecting_56_ = true;
  arm.point_6_ = arm.axes_[4].o = arm.axes_[5].o = point->point;
  const double deviation = std::max(off, point->distance);
  candidates.push_back({arm, "axes 2, 3 and 4 parallel, 5 and 6 intersecting", deviation, false});
  candidates.back().arm.prepare(reach, deviation);
}

void ThreeParallel::prepare(double reach, double deviation) {
  reach_ = reach;
  slack_ = kReachSlack + 4 * deviation;
  const Vector& h2 = axes_[1].h;
  sign_3_ = h2.dot(axes_[2].h) < 0 ? -1 : 1;
  sign_4_ = h2.dot(axes_[3].h) < 0 ? -1 : 1;
  fourth_about_3_ = Circle::of(axes_[2], axes_[3].o);
  side_ = side_of(h2);
  if (intersecting_56_) return;
  const Circle direction = Circle::of({axes_[4].h, Vector::Zero()}, axes_[5].h);
  const Circle place = Circle::of(axes_[4], point_6_);
  B_ << -h2.dot(direction.cosine), -h2.dot(direction.sine), -h2.dot(place.cosine) / reach_,
      -h2.dot(place.sine) / reach_;
  B_inverse_ = B_.inverse();
}

void ThreeParallel::solve(const Pose& X, const Near& near, Postures& out) const noexcept {
  Ends ends;
  if (intersecting_56_) {
    solve_ends(X, near, ends);
  } else {
    solve_ends_general(X, ends);
  }
  const Vector& h2 = axes_[1].h;
  for (std::size_t i = 0; i < ends.count; ++i) {
    Posture posture;
    posture[0] = ends.first[i];
    posture[4] = ends.fifth[i];
    const Vector from = X.linear().transpose() * turned(axes_[0].h, h2, ends.first[i]);
    if (turn_between(axes_[5].h, from, turned(axes_[4].h, h2, ends.fifth[i].inverse()), 1.0, posture[5])) {
      solve_middle(X, near, posture, out);
      continue;
    }
    // Axis 6 is parallel to axes 2 to 4: any sixth joint will do that leaves the planar arm within reach.
    constexpr double kStep = std::numbers::pi / 12;
    for (int step = 0; step <= 24; ++step) {
      posture[5] = Turn::of(near[5] + kStep * (step % 2 == 0 ? -step / 2 : (step + 1) / 2));
      if (solve_middle(X, near, posture, out)) break;
    }
  }
}

// The height of the crossing of axes 5 and 6 gives joint 1, the slope of axis 6 then joint 5.
void ThreeParallel::solve_ends(const Pose& X, const Near& near, Ends& out) const noexcept {
  const Vector& h2 = axes_[1].h;
  const Circle about_1 = Circle::of(axes_[0], X * point_6_);
  Turns first = solve_cosine(h2.dot(about_1.cosine), -h2.dot(about_1.sine), h2.dot(point_6_ - about_1.center), slack_,
                             kSingular * reach_);
  if (first.free) first.turn[first.count++] = Turn::of(near[0]);
  const Vector slope = X.linear() * axes_[5].h;
  for (std::size_t i = 0; i < first.count; ++i) {
    const Turns fifth =
        second_turn(h2, axes_[4].h, axes_[5].h, turned(axes_[0].h, slope, first.turn[i].inverse()), slack_ / reach_);
    for (std::size_t k = 0; k < fifth.count; ++k) {
      out.first[out.count] = first.turn[i];
      out.fifth[out.count++] = fifth.turn[k];
    }
  }
}

// Height and slope of axis 6: two equations in joints 1 and 5.
void ThreeParallel::solve_ends_general(const Pose& X, Ends& out) const noexcept {
  const Vector& h2 = axes_[1].h;
  const Circle slope_1 = Circle::of({axes_[0].h, Vector::Zero()}, X.linear() * axes_[5].h);
  const Circle place_1 = Circle::of(axes_[0], X * point_6_);
  const Circle slope_5 = Circle::of({axes_[4].h, Vector::Zero()}, axes_[5].h);
  const Circle place_5 = Circle::of(axes_[4], point_6_);
  Eigen::Matrix2d A;
  A << h2.dot(slope_1.cosine), -h2.dot(slope_1.sine), h2.dot(place_1.cosine) / reach_, -h2.dot(place_1.sine) / reach_;
  const Eigen::Vector2d k(h2.dot(slope_5.center - slope_1.center), h2.dot(place_5.center - place_1.center) / reach_);
  const TurnPairs pairs = solve_pair(A, B_inverse_, k, slack_ / reach_);
  out.first = pairs.first;
  out.fifth = pairs.second;
  out.count = pairs.count;
}

bool ThreeParallel::solve_middle(const Pose& X, const Near& near, Posture& posture, Postures& out) const noexcept {
  const Vector& h2 = axes_[1].h;
  const Vector& o2 = axes_[1].o;
  const Turn first = posture[0].inverse();
  const Turn fifth = posture[4].inverse();
  const Turn sixth = posture[5].inverse();
  // What joints 2 to 4 have to do to a point of axis 4 and to side_.
  const Vector point = X * turned(axes_[5], turned(axes_[4], axes_[3].o, fifth), sixth);
  const Vector v = turned(axes_[0], point, first) - o2;
  const Vector side = X.linear() * turned(axes_[5].h, turned(axes_[4].h, side_, fifth), sixth);
  Turn sum;
  if (!turn_between(h2, side_, turned(axes_[0].h, side, first), 1.0, sum)) return false;
  Turns third = turn_to_distance(h2, fourth_about_3_, o2, across(h2, v).squaredNorm(), slack_);
  if (third.free) third.turn[third.count++] = Turn::of(near[2]);
  for (std::size_t i = 0; i < third.count; ++i) {
    posture[2] = third.turn[i];
    const Vector from = fourth_about_3_.at(third.turn[i]) - o2;
    if (!turn_between(h2, from, v, reach_, posture[1])) posture[1] = Turn::of(near[1]);
    const Turn third_about_2{third.turn[i].c, sign_3_ * third.turn[i].s};
    const Turn fourth_about_2 = sum * (posture[1] * third_about_2).inverse();
    posture[3] = {fourth_about_2.c, sign_4_ * fourth_about_2.s};
    out.add(posture);
  }
  return third.count > 0;
}

}  // namespace cellmirror::inverse_kinematics::closed_form
