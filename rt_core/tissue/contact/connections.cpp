#include "rt_core/tissue/contact/connections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace cellmirror::tissue {

namespace {

using Eigen::Vector3d;

constexpr double kSpringDamping_s = 0.002;  // damping = this * stiffness

std::uint32_t nearest_start_point(const DeformableObject& object, const Vector3d& p) {
  std::uint32_t best = 0;
  double squared = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < object.start_positions.size(); ++i) {
    const double one = (object.start_positions[i] - p).squaredNorm();
    if (one < squared) {
      squared = one;
      best = i;
    }
  }
  return best;
}

}  // namespace

std::uint32_t object_named(std::span<const DeformableObject> objects, const std::string& name) {
  const auto at =
      std::ranges::find_if(objects, [&](const DeformableObject& one) { return one.description.name == name; });
  return static_cast<std::uint32_t>(at - objects.begin());
}

void Connections::set(std::vector<Connection> connections, std::span<const DeformableObject> objects) {
  connections_ = std::move(connections);
  if (connections_.size() > kMostConnections) connections_.resize(kMostConnections);
  springs_.clear();
  for (std::uint32_t i = 0; i < connections_.size(); ++i) make_springs(i, objects);
}

void Connections::reset() {
  pull_ = 0;
  for (Spring& spring : springs_) {
    spring.impulse = 0;
    spring.torn = false;
  }
}

void Connections::forget_impulses() {
  for (Spring& spring : springs_) spring.impulse = 0;
}

void Connections::make_springs(std::uint32_t number, std::span<const DeformableObject> objects) {
  const Connection& connection = connections_[number];
  const std::uint32_t a = object_named(objects, connection.object_a);
  const std::uint32_t b = connection.object_b.empty() ? kWorld : object_named(objects, connection.object_b);
  if (a >= objects.size() || !objects[a].body || objects[a].start_positions.empty()) return;
  if (b != kWorld && (b >= objects.size() || !objects[b].body || objects[b].start_positions.empty())) return;
  const Vector3d p_a = objects[a].description.X_WO * connection.point_a;
  const Vector3d p_b = b == kWorld ? connection.point_b : Vector3d(objects[b].description.X_WO * connection.point_b);
  std::vector<std::uint32_t> of_a;
  for (std::uint32_t i = 0; connection.radius_m > 0 && i < objects[a].start_positions.size(); ++i) {
    if ((objects[a].start_positions[i] - p_a).norm() <= connection.radius_m) of_a.push_back(i);
  }
  if (of_a.empty()) of_a.push_back(nearest_start_point(objects[a], p_a));
  const std::size_t count = std::min(of_a.size(), kMostPairs);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t from = of_a[i * of_a.size() / count];
    Spring spring;
    spring.connection = number;
    spring.a = {a, objects[a].start_points[from], objects[a].start_positions[from]};
    if (b == kWorld) {
      spring.b = {kWorld, {}, p_b};
    } else {
      const std::uint32_t to = nearest_start_point(objects[b], connection.radius_m > 0 ? spring.a.at : p_b);
      spring.b = {b, objects[b].start_points[to], objects[b].start_positions[to]};
    }
    spring.rest_length = (spring.b.at - spring.a.at).norm();
    spring.stiffness = std::clamp(connection.stiffness_n_m, 0.0, 1e6) / static_cast<double>(count);
    spring.tear_force = std::max(connection.tear_force_n, 0.0) / static_cast<double>(count);
    springs_.push_back(spring);
  }
}

Vector3d Connections::position(const End& end, std::span<const DeformableObject> objects) {
  return end.object == kWorld ? end.at : objects[end.object].body->position(end.point);
}

// A spring as a soft constraint: its force is that at the end of the substep, which is stable for any stiffness.
void Connections::follow_cuts(std::span<const DeformableObject> objects) {
  for (Spring& spring : springs_) {
    for (End* end : {&spring.a, &spring.b}) {
      if (end->object != kWorld) objects[end->object].body->follow_cuts(end->point);
    }
  }
}

void Connections::add(ConstraintSystem& system, std::span<DeformableObject> objects, double dt) {
  for (Spring& spring : springs_) {
    spring.has_row = false;
    if (spring.torn || !(spring.stiffness > 0)) continue;
    const auto steps = [&](const End& end) {
      return end.object != kWorld && objects[end.object].calculates() && objects[end.object].steps_now;
    };
    if (!steps(spring.a) && !steps(spring.b)) continue;
    const Vector3d way = position(spring.b, objects) - position(spring.a, objects);
    const double length = way.norm();
    const double stretch = length - spring.rest_length;
    if (stretch < -0.001 || length < 1e-6) {
      spring.impulse = 0;
      continue;
    }
    const double damping = kSpringDamping_s * spring.stiffness;
    const double sum = dt * spring.stiffness + damping;
    ConstraintSystem::Push push;
    push.normal = way / length;
    push.softness = 1.0 / (dt * sum);
    push.bias = stretch * spring.stiffness / sum;
    push.impulse = spring.impulse;
    for (const auto& [end, sign] : {std::pair(&spring.a, 1.0), std::pair(&spring.b, -1.0)}) {
      if (end->object != kWorld) add_terms(system, objects[end->object], end->object, end->point, sign);
    }
    spring.row = system.add(push);
    spring.has_row = true;
  }
}

void Connections::take(const ConstraintSystem& system, std::span<DeformableObject> objects, double dt, EventLog& log) {
  pull_ = 0;
  for (Spring& spring : springs_) {
    if (!spring.has_row) continue;
    spring.impulse = system.push(spring.row).impulse;
    const double force = spring.impulse / dt;
    pull_ += force;
    if (!(spring.tear_force > 0) || force <= spring.tear_force) continue;
    spring.torn = true;
    const bool all = std::ranges::none_of(
        springs_, [&](const Spring& one) { return one.connection == spring.connection && !one.torn; });
    if (!all) continue;
    const Connection& connection = connections_[spring.connection];
    log.add(TissueEventKind::tear, {.object = static_cast<int>(spring.a.object), .part = connection.name},
            position(spring.a, objects), connection.tear_force_n);
  }
}

std::uint32_t Connections::torn() const {
  std::uint32_t torn = 0;
  for (std::uint32_t i = 0; i < connections_.size(); ++i) {
    bool any = false;
    bool whole = false;
    for (const Spring& spring : springs_) {
      if (spring.connection != i) continue;
      any = true;
      whole = whole || !spring.torn;
    }
    if (any && !whole) ++torn;
  }
  return torn;
}

}  // namespace cellmirror::tissue
