// Relations of lines in space, which identify the known arrangements of axes.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "rt_core/inverse_kinematics/closed_form_subproblems.hpp"

namespace cellmirror::inverse_kinematics::closed_form {

// Lines that make a smaller angle than this (as its sine) count neither as crossing nor, mostly, as parallel.
inline constexpr double kLeastSine = 0.05;
// How far beyond reach a target still gets the posture of the nearest reach, of an exact arm; m.
inline constexpr double kReachSlack = 2e-5;

// Sine of the angle between the lines.
[[nodiscard]] double sine_between(const Line& a, const Line& b);

// The point nearest to all lines in the least-squares sense and its greatest distance from one. Nothing where two that
// follow each other are nearly parallel, so that the point is not determined well.
struct Meeting {
  Vector point = Vector::Zero();
  double distance = 0;  // m
};
[[nodiscard]] std::optional<Meeting> meeting(std::span<const Line> lines);

// Makes the lines parallel to their mean direction, each keeping its sense. Returns the greatest sine by which one was
// off.
double make_parallel(std::span<Line> lines);

// Some unit vector across h.
[[nodiscard]] Vector side_of(const Vector& h);

}  // namespace cellmirror::inverse_kinematics::closed_form
