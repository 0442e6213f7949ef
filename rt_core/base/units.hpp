// SCRIPT's millimetres and degrees become SI where a command is parsed, and nowhere else.
#pragma once

#include <numbers>

namespace cellmirror {

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kMPerMm = 1e-3;

constexpr double rad_from_deg(double deg) { return deg * kRadPerDeg; }
constexpr double deg_from_rad(double rad) { return rad / kRadPerDeg; }
constexpr double m_from_mm(double mm) { return mm * kMPerMm; }
constexpr double mm_from_m(double m) { return m / kMPerMm; }

}  // namespace cellmirror
