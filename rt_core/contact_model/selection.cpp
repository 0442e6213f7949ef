#include "rt_core/contact_model/selection.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::contact_model {

namespace {

// The first ball: as far as a fast hand comes while a model is in use.
constexpr double kFirstBall = 0.002;  // m
// How often the tolerance is doubled where there are more planes in the first ball than constraints.
constexpr int kMostDoublings = 4;

// False: there is no room for another one that is needed.
bool cover(std::span<TipPlane> planes, double ball, double allowed, Selection& out) {
  for (std::uint32_t j = 0; j < planes.size() && planes[j].gap < ball; ++j) {
    if (planes[j].chosen) continue;
    bool implied = false;
    for (std::size_t i = 0; i < out.count && !implied; ++i) {
      implied = planes[j].lever * excess(planes[out.chosen[i]], planes[j], ball) <= allowed;
    }
    if (implied) continue;
    if (out.count == out.chosen.size()) return false;
    out.chosen[out.count++] = j;
    planes[j].chosen = true;
  }
  return true;
}

}  // namespace

double tolerance(double ball) { return 0.01 * ball; }

double excess(const TipPlane& kept, const TipPlane& plane, double ball) {
  const double c = kept.unit.dot(plane.unit);
  if (ball * c <= kept.gap) return ball - plane.gap;
  const double along = std::sqrt(std::max(0.0, ball * ball - kept.gap * kept.gap));
  return kept.gap * c + std::sqrt(std::max(0.0, 1 - c * c)) * along - plane.gap;
}

Selection select(std::span<TipPlane> planes, double reach) {
  std::ranges::sort(planes, [](const TipPlane& a, const TipPlane& b) {
    return a.gap != b.gap ? a.gap < b.gap : a.candidate < b.candidate;
  });
  Selection out;
  double ball = std::min(kFirstBall, reach);
  double allowed = tolerance(ball);
  for (int doublings = 0; !cover(planes, ball, allowed, out); ++doublings) {
    if (doublings == kMostDoublings) {
      out.reach = 0.5 * ball;
      return out;
    }
    for (TipPlane& plane : planes) plane.chosen = false;
    out.count = 0;
    allowed *= 2;
  }
  for (out.reach = ball; ball < reach; out.reach = ball) {
    ball = std::min(2 * ball, reach);
    if (!cover(planes, ball, std::max(allowed, tolerance(ball)), out)) break;
  }
  return out;
}

}  // namespace cellmirror::contact_model
