#include "rt_core/motion/trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace cellmirror::motion {

namespace {

bool is_positive(double value) CELL_RT { return std::isfinite(value) && value > 0; }
bool is_not_negative(double value) CELL_RT { return std::isfinite(value) && value >= 0; }

bool sound_times(const Trajectory& trajectory) CELL_RT {
  double before = -1;
  for (std::size_t i = 0; i < trajectory.points(); ++i) {
    const double time = trajectory.times[i];
    if (!is_not_negative(time) || time <= before) return false;
    before = time;
  }
  return true;
}

}  // namespace

// Hermite interpolation: the polynomials that have the given values at both ends.
std::array<double, 6> polynomial(const KnotPair& pair, const KnotState& from, const KnotState& to) CELL_RT {
  const double T = pair.duration;
  const double way = to.position - from.position;
  std::array<double, 6> c{from.position, 0, 0, 0, 0, 0};
  switch (pair.order) {
    case KnotOrder::positions:
      c[1] = way / T;
      break;
    case KnotOrder::velocities:
      c[1] = from.velocity;
      c[2] = (3 * way / T - 2 * from.velocity - to.velocity) / T;
      c[3] = (-2 * way / T + from.velocity + to.velocity) / (T * T);
      break;
    case KnotOrder::accelerations: {
      const double a0 = from.acceleration;
      const double a1 = to.acceleration;
      c[1] = from.velocity;
      c[2] = 0.5 * a0;
      c[3] = (20 * way / T - 8 * to.velocity - 12 * from.velocity - (3 * a0 - a1) * T) / (2 * T * T);
      c[4] = (-30 * way / T + 14 * to.velocity + 16 * from.velocity + (3 * a0 - 2 * a1) * T) / (2 * T * T * T);
      c[5] = (12 * way / T - 6 * to.velocity - 6 * from.velocity + (a1 - a0) * T) / (2 * T * T * T * T);
      break;
    }
  }
  return c;
}

KnotState interpolate(const KnotPair& pair, const KnotState& from, const KnotState& to, double t) CELL_RT {
  const std::array<double, 6> c = polynomial(pair, from, to);
  KnotState state;
  state.position = c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
  state.velocity = c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + t * 5 * c[5])));
  state.acceleration = 2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + t * 20 * c[5]));
  return state;
}

bool is_sound(const Trajectory& trajectory, std::size_t joints) CELL_RT {
  if (trajectory.id == 0 || trajectory.joints != joints || trajectory.points() == 0) return false;
  if (trajectory.orders.size() != trajectory.points() || trajectory.knots.size() != trajectory.points() * joints)
    return false;
  for (std::size_t i = 0; i < joints; ++i) {
    if (!is_positive(trajectory.max_velocity[i]) || !is_positive(trajectory.deceleration[i])) return false;
    if (!is_not_negative(trajectory.path_tolerance[i]) || !is_not_negative(trajectory.goal_tolerance[i]) ||
        !is_not_negative(trajectory.stopped_velocity[i]))
      return false;
  }
  if (!is_not_negative(trajectory.goal_time) || !sound_times(trajectory)) return false;
  return std::ranges::all_of(trajectory.knots, [](const KnotState& knot) CELL_RT {
    return std::isfinite(knot.position) && std::isfinite(knot.velocity) && std::isfinite(knot.acceleration);
  });
}

}  // namespace cellmirror::motion
