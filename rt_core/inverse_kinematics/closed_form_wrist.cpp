#include "rt_core/inverse_kinematics/closed_form_wrist.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "rt_core/inverse_kinematics/closed_form_geometry.hpp"
#include "rt_core/inverse_kinematics/closed_form_pair.hpp"

namespace cellmirror::inverse_kinematics::closed_form {

void SphericalWrist::recognise(const Axes& axes, double reach, double tolerance, std::vector<Candidate>& candidates) {
  const auto wrist = meeting(std::span(axes).last<3>());
  if (!wrist || wrist->distance > tolerance) return;
  SphericalWrist arm;
  arm.axes_ = axes;
  arm.wrist_ = wrist->point;
  for (std::size_t i = 3; i < kArmJoints; ++i) arm.axes_[i].o = wrist->point;

  const auto propose = [&](const SphericalWrist& of, Shoulder shoulder, std::string_view name, double off) {
    const double deviation = std::max(wrist->distance, off);
    if (deviation > tolerance) return;
    candidates.push_back({of, name, deviation, shoulder == Shoulder::general});
    candidates.back().arm.prepare(shoulder, reach, deviation);
  };
  const auto propose_parallel = [&](std::size_t first, Shoulder shoulder, std::string_view name) {
    SphericalWrist changed = arm;
    const double sine = make_parallel(std::span(changed.axes_).subspan(first, 2));
    propose(changed, shoulder, name, sine * reach);
  };
  const auto propose_intersecting = [&](std::size_t first, Shoulder shoulder, std::string_view name) {
    SphericalWrist changed = arm;
    const auto lines = std::span(changed.axes_).subspan(first, 2);
    const auto point = meeting(lines);
    if (!point) return;
    changed.point_ = lines[0].o = lines[1].o = point->point;
    propose(changed, shoulder, name, point->distance);
  };
  propose_parallel(1, Shoulder::parallel_23, "spherical wrist, axes 2 and 3 parallel");
  propose_intersecting(0, Shoulder::intersecting_12, "spherical wrist, axes 1 and 2 intersecting");
  propose_parallel(0, Shoulder::parallel_12, "spherical wrist, axes 1 and 2 parallel");
  propose_intersecting(1, Shoulder::intersecting_23, "spherical wrist, axes 2 and 3 intersecting");
  propose(arm, Shoulder::general, "spherical wrist", 0);
}

void SphericalWrist::prepare(Shoulder shoulder, double reach, double deviation) {
  shoulder_ = shoulder;
  reach_ = reach;
  slack_ = kReachSlack + 4 * deviation;
  wrist_about_3_ = Circle::of(axes_[2], wrist_);
  side_ = side_of(axes_[5].h);
  if (shoulder != Shoulder::general) return;
  point_ = axes_[1].o;
  const Circle& c3 = wrist_about_3_;
  const Vector& h2 = axes_[1].h;
  const Vector arm = (c3.center - point_) / reach_;
  B_ << -h2.dot(c3.cosine), -h2.dot(c3.sine), -arm.dot(c3.cosine), -arm.dot(c3.sine);
  B_inverse_ = B_.inverse();
}

void SphericalWrist::solve(const Pose& X, const Near& near, Postures& out) const noexcept {
  Positions positions;
  place(X * wrist_, near, positions);
  const Vector u = X.linear() * axes_[5].h;
  const Vector v = X.linear() * side_;
  for (std::size_t i = 0; i < positions.count; ++i) orient(positions.turns[i], u, v, near, out);
}

void SphericalWrist::place(const Vector& w, const Near& near, Positions& out) const noexcept {
  switch (shoulder_) {
    case Shoulder::parallel_23:
      return place_parallel_23(w, near, out);
    case Shoulder::intersecting_12:
      return place_intersecting_12(w, near, out);
    case Shoulder::parallel_12:
      return place_parallel_12(w, near, out);
    case Shoulder::intersecting_23:
      return place_intersecting_23(w, near, out);
    case Shoulder::general:
      return place_general(w, near, out);
  }
}

// Joints 2 and 3 keep the height of the wrist along their direction, which gives joint 1; then its distance from axis 2
// gives joint 3.
void SphericalWrist::place_parallel_23(const Vector& w, const Near& near, Positions& out) const noexcept {
  const Vector& h2 = axes_[1].h;
  const Circle about_1 = Circle::of(axes_[0], w);
  Turns first = solve_cosine(h2.dot(about_1.cosine), -h2.dot(about_1.sine), h2.dot(wrist_ - about_1.center), slack_,
                             kSingular * reach_);
  if (first.free) first.turn[first.count++] = Turn::of(near[0]);
  for (std::size_t i = 0; i < first.count; ++i) {
    const Vector v = about_1.at(first.turn[i].inverse()) - axes_[1].o;
    const Turns third = turn_to_distance(h2, wrist_about_3_, axes_[1].o, across(h2, v).squaredNorm(), slack_);
    for (std::size_t k = 0; k < third.count; ++k) {
      Turn second;
      const Vector from = wrist_about_3_.at(third.turn[k]) - axes_[1].o;
      if (!turn_between(h2, from, v, reach_, second)) second = Turn::of(near[1]);
      out.add(first.turn[i], second, third.turn[k]);
    }
  }
}

// The distance of the wrist from the point where axes 1 and 2 meet gives joint 3.
void SphericalWrist::place_intersecting_12(const Vector& w, const Near& near, Positions& out) const noexcept {
  const Vector t = w - point_;
  const double along = axes_[2].h.dot(wrist_about_3_.center - point_);
  const Turns third = turn_to_distance(axes_[2].h, wrist_about_3_, point_, t.squaredNorm() - along * along, slack_);
  for (std::size_t k = 0; k < third.count; ++k) {
    const Vector p = wrist_about_3_.at(third.turn[k]) - point_;
    Turns second = second_turn(axes_[0].h, axes_[1].h, p, t, slack_);
    if (second.free) second.turn[second.count++] = Turn::of(near[1]);
    for (std::size_t i = 0; i < second.count; ++i) {
      Turn first;
      if (!turn_between(axes_[0].h, turned(axes_[1].h, p, second.turn[i]), t, reach_, first)) {
        first = Turn::of(near[0]);
      }
      out.add(first, second.turn[i], third.turn[k]);
    }
  }
}

// Joints 1 and 2 keep the height along their direction, which gives joint 3; then the distance from axis 1 joint 2.
void SphericalWrist::place_parallel_12(const Vector& w, const Near& near, Positions& out) const noexcept {
  const Vector& h1 = axes_[0].h;
  const Circle& c3 = wrist_about_3_;
  const Turns third =
      solve_cosine(h1.dot(c3.cosine), h1.dot(c3.sine), h1.dot(w - c3.center), slack_, kSingular * reach_);
  const Vector t = w - axes_[0].o;
  for (std::size_t k = 0; k < third.count; ++k) {
    const Circle about_2 = Circle::of(axes_[1], c3.at(third.turn[k]));
    Turns second = turn_to_distance(h1, about_2, axes_[0].o, across(h1, t).squaredNorm(), slack_);
    if (second.free) second.turn[second.count++] = Turn::of(near[1]);
    for (std::size_t i = 0; i < second.count; ++i) {
      Turn first;
      const Vector from = about_2.at(second.turn[i]) - axes_[0].o;
      if (!turn_between(h1, from, t, reach_, first)) first = Turn::of(near[0]);
      out.add(first, second.turn[i], third.turn[k]);
    }
  }
}

// Joints 2 and 3 keep the distance from the point where their axes meet, which gives joint 1.
void SphericalWrist::place_intersecting_23(const Vector& w, const Near& near, Positions& out) const noexcept {
  const Vector& h1 = axes_[0].h;
  const Vector p = wrist_ - point_;
  const Circle about_1 = Circle::of(axes_[0], w);
  const double along = h1.dot(about_1.center - point_);
  Turns back = turn_to_distance(h1, about_1, point_, p.squaredNorm() - along * along, slack_);
  if (back.free) back.turn[back.count++] = Turn::of(-near[0]);
  for (std::size_t i = 0; i < back.count; ++i) {
    const Vector t = about_1.at(back.turn[i]) - point_;
    const Turns third = second_turn(axes_[1].h, axes_[2].h, p, t, slack_);
    for (std::size_t k = 0; k < third.count; ++k) {
      Turn second;
      if (!turn_between(axes_[1].h, turned(axes_[2].h, p, third.turn[k]), t, reach_, second)) {
        second = Turn::of(near[1]);
      }
      out.add(back.turn[i].inverse(), second, third.turn[k]);
    }
  }
}

// Joint 2 keeps the height along its axis and the distance from a point of it: two equations in joints 1 and 3.
void SphericalWrist::place_general(const Vector& w, const Near& near, Positions& out) const noexcept {
  const Vector& h2 = axes_[1].h;
  const Circle c1 = Circle::of(axes_[0], w);
  const Circle& c3 = wrist_about_3_;
  const Vector r1 = c1.center - point_;
  const Vector r3 = c3.center - point_;
  Eigen::Matrix2d A;
  A << h2.dot(c1.cosine), -h2.dot(c1.sine), r1.dot(c1.cosine) / reach_, -r1.dot(c1.sine) / reach_;
  const double squares = r3.squaredNorm() + c3.cosine.squaredNorm() - r1.squaredNorm() - c1.cosine.squaredNorm();
  const TurnPairs pairs = solve_pair(A, B_inverse_, {h2.dot(r3 - r1), 0.5 * squares / reach_}, slack_ / reach_);
  for (std::size_t i = 0; i < pairs.count; ++i) {
    Turn second;
    const Vector from = c3.at(pairs.second[i]) - point_;
    const Vector to = c1.at(pairs.first[i].inverse()) - point_;
    if (!turn_between(h2, from, to, reach_, second)) second = Turn::of(near[1]);
    out.add(pairs.first[i], second, pairs.second[i]);
  }
}

void SphericalWrist::orient(const std::array<Turn, 3>& arm, const Vector& u, const Vector& v, const Near& near,
                            Postures& out) const noexcept {
  Vector a = u;
  Vector b = v;
  for (std::size_t i = 0; i < 3; ++i) {
    a = turned(axes_[i].h, a, arm[i].inverse());
    b = turned(axes_[i].h, b, arm[i].inverse());
  }
  const Vector& h4 = axes_[3].h;
  const Vector& h5 = axes_[4].h;
  const Vector& h6 = axes_[5].h;
  const Turns fifth = second_turn(h4, h5, h6, a, slack_ / reach_);
  for (std::size_t i = 0; i < fifth.count; ++i) {
    Turn fourth;
    if (!turn_between(h4, turned(h5, h6, fifth.turn[i]), a, 1.0, fourth)) fourth = Turn::of(near[3]);
    // From what joints 4 and 5 leave over, so that the three together are exact whatever the fourth came from.
    const Vector rest = turned(h5, turned(h4, b, fourth.inverse()), fifth.turn[i].inverse());
    Turn sixth;
    if (!turn_between(h6, side_, rest, 1.0, sixth)) continue;
    out.add({arm[0], arm[1], arm[2], fourth, fifth.turn[i], sixth});
  }
}

}  // namespace cellmirror::inverse_kinematics::closed_form
