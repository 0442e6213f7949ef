#include "rt_core/inverse_kinematics/closed_form_subproblems.hpp"

#include <algorithm>

namespace cellmirror::inverse_kinematics::closed_form {

namespace {

// The angles at which cos^2 and sin^2 of the half angle from `phase` are as cosine_part : sine_part. A part below zero
// by no more than its slack counts as zero: the one angle at the border.
Turns from_half_angles(double cosine_part, double sine_part, double cosine_slack, double sine_slack,
                       const Turn& phase) {
  Turns turns;
  if (!(cosine_part >= -cosine_slack && sine_part >= -sine_slack)) return turns;
  const double sum = std::max(cosine_part, 0.0) + std::max(sine_part, 0.0);
  if (sum <= 0) return turns;
  if (sine_part <= 0 || cosine_part <= 0) {
    turns.count = 1;
    turns.turn[0] = sine_part <= 0 ? phase : Turn{-phase.c, -phase.s};
    return turns;
  }
  const Turn away{(cosine_part - sine_part) / sum, 2 * std::sqrt(cosine_part * sine_part) / sum};
  turns.count = 2;
  turns.turn = {phase * away, phase * away.inverse()};
  return turns;
}

}  // namespace

bool turn_between(const Vector& h, const Vector& from, const Vector& to, double scale, Turn& turn) {
  const Vector a = across(h, from);
  const Vector b = across(h, to);
  const double least = kSingular * kSingular * scale * scale;
  const double aa = a.squaredNorm();
  const double bb = b.squaredNorm();
  if (!(aa > least && bb > least)) return false;
  const double length = std::sqrt(aa * bb);
  turn = {a.dot(b) / length, h.dot(a.cross(b)) / length};
  return true;
}

Turns solve_cosine(double a, double b, double k, double slack, double tiny) {
  Turns turns;
  const double amplitude = std::sqrt(a * a + b * b);
  if (amplitude < tiny) {
    turns.free = std::abs(k) <= slack;
    return turns;
  }
  const Turn phase{a / amplitude, b / amplitude};
  return from_half_angles(amplitude + k, amplitude - k, slack, slack, phase);
}

Turns second_turn(const Vector& k1, const Vector& k2, const Vector& p, const Vector& t, double slack) {
  const Circle circle = Circle::of({k2, Vector::Zero()}, p);
  const double a = k1.dot(circle.cosine);
  const double b = k1.dot(circle.sine);
  const double radius = p.norm();
  const double amplitude = std::sqrt(a * a + b * b);
  Turns turns;
  if (!(amplitude > kSingular * radius)) {
    turns.free = std::abs(k1.dot(t - circle.center)) <= slack + kSingular * radius;
    return turns;
  }
  // With the highest and the lowest point of the circle over k1: twice the radius times (height of the highest point -
  // height of t), each height taken from the pole so that nothing cancels near it.
  const Turn phase{a / amplitude, b / amplitude};
  const Vector pole = radius * k1;
  const Vector arm = phase.c * circle.cosine + phase.s * circle.sine;
  const double to_highest = (circle.center + arm - pole).squaredNorm();
  const double to_lowest = (circle.center - arm + pole).squaredNorm();
  const auto squared_slack = [slack](double squared) { return (2 * std::sqrt(squared) + slack) * slack; };
  return from_half_angles((t + pole).squaredNorm() - to_lowest, (t - pole).squaredNorm() - to_highest,
                          squared_slack(to_lowest), squared_slack(to_highest), phase);
}

Turns turn_to_distance(const Vector& h, const Circle& circle, const Vector& point, double distance_squared,
                       double slack) {
  const Vector m = across(h, circle.center - point);
  const double a = m.dot(circle.cosine);
  const double b = m.dot(circle.sine);
  const double far = m.norm() + circle.cosine.norm();
  const double near = std::abs(m.norm() - circle.cosine.norm());
  const double amplitude = std::sqrt(a * a + b * b);
  if (!(amplitude > kSingular * kSingular * far * far)) {
    Turns turns;
    turns.free = distance_squared <= (far + slack) * (far + slack) && std::sqrt(distance_squared) + slack >= near;
    return turns;
  }
  return from_half_angles(distance_squared - near * near, far * far - distance_squared, (2 * near + slack) * slack,
                          (2 * far + slack) * slack, {a / amplitude, b / amplitude});
}

}  // namespace cellmirror::inverse_kinematics::closed_form
