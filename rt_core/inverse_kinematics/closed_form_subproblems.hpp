// Geometry that the closed forms are put together from: turning points about lines, and the few equations in one or two
// angles to which an arm falls apart (subproblems of Paden, "Kinematics and Control of Robot Manipulators", 1985, and
// Kahan; Elias and Wen, "IK-Geo", 2022, for the extended set). Angles are kept as cosine and sine; radians only in the
// answer.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace cellmirror::inverse_kinematics::closed_form {

using Vector = Eigen::Vector3d;

inline constexpr std::size_t kMaxPostures = 8;
inline constexpr std::size_t kArmJoints = 6;
// Below this, relative to the lengths at hand, a direction is noise and the angle that it would give is free.
inline constexpr double kSingular = 1e-10;

// An angle as the point of the unit circle.
struct Turn {
  double c = 1;
  double s = 0;
  static Turn of(double angle) { return {std::cos(angle), std::sin(angle)}; }
  [[nodiscard]] Turn inverse() const { return {c, -s}; }
  [[nodiscard]] Turn operator*(const Turn& b) const { return {c * b.c - s * b.s, s * b.c + c * b.s}; }
  bool operator==(const Turn&) const = default;
  // (-pi, pi]
  [[nodiscard]] double angle() const {
    const double a = std::atan2(s, c);
    return a <= -std::numbers::pi ? std::numbers::pi : a;
  }
};

struct Line {
  Vector h = Vector::UnitZ();  // unit direction
  Vector o = Vector::Zero();   // a point of it
};

// The vector v turned about the direction h (Rodrigues).
inline Vector turned(const Vector& h, const Vector& v, const Turn& t) {
  return t.c * v + t.s * h.cross(v) + ((1 - t.c) * h.dot(v)) * h;
}
// The point p turned about the line.
inline Vector turned(const Line& line, const Vector& p, const Turn& t) {
  return line.o + turned(line.h, Vector(p - line.o), t);
}
inline Vector across(const Vector& h, const Vector& v) { return v - h.dot(v) * h; }

// What a point describes while it turns about a line: center + c * cosine + s * sine.
struct Circle {
  Vector center = Vector::Zero();
  Vector cosine = Vector::Zero();
  Vector sine = Vector::Zero();
  static Circle of(const Line& line, const Vector& p) {
    Circle circle;
    const Vector r = p - line.o;
    const double along = line.h.dot(r);
    circle.center = line.o + along * line.h;
    circle.cosine = r - along * line.h;
    circle.sine = line.h.cross(r);
    return circle;
  }
  [[nodiscard]] Vector at(const Turn& t) const { return center + t.c * cosine + t.s * sine; }
};

// The six joints of an arm from base to tip with all joints at zero, as lines in the base.
using Axes = std::array<Line, kArmJoints>;
using Posture = std::array<Turn, kArmJoints>;
struct Postures {
  std::array<Posture, kMaxPostures> posture;
  std::size_t count = 0;
  void add(const Posture& p) {
    if (count < kMaxPostures) posture[count++] = p;
  }
};
// rad: where a target leaves a joint free.
using Near = std::array<double, kArmJoints>;

// Up to two answers; `free`: every angle is one (count is then 0).
struct Turns {
  std::array<Turn, 2> turn;
  std::size_t count = 0;
  bool free = false;
};

// The angle about `h` that brings the direction of `from` across h to that of `to`. Not determined (false) where one of
// them, of length `scale`, points along h; `turn` is then left alone.
bool turn_between(const Vector& h, const Vector& from, const Vector& to, double scale, Turn& turn);

// a c + b s = k. Where |k| exceeds the amplitude by no more than `slack`, the one nearest angle. Free where the
// amplitude is below `tiny` and k within slack.
Turns solve_cosine(double a, double b, double k, double slack, double tiny);

// The angle of the second of two turns about lines that meet in the origin, E1 E2 p = t, |p| = |t| (the first then
// follows by turn_between). By half angles, which keeps full precision where t lies along k1 or opposite to it.
Turns second_turn(const Vector& k1, const Vector& k2, const Vector& p, const Vector& t, double slack);

// The angle about a line of direction `h` at which a point that describes `circle` stands at a given distance from
// `point`, measured across h and given squared. By half angles as well.
Turns turn_to_distance(const Vector& h, const Circle& circle, const Vector& point, double distance_squared,
                       double slack);

}  // namespace cellmirror::inverse_kinematics::closed_form
