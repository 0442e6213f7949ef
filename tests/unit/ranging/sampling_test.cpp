// Readings against dense sampling: no point of the surface within the cone is nearer, and the point that was read is on
// the surface, in the cone, and where it is said to be. The samples are spread over the whole body and crowded around
// the point that was read.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "rt_core/ranging/cone.hpp"
#include "tests/unit/ranging/surfaces.hpp"

namespace cellmirror {
namespace {

using ranging::Cone;
using ranging::ConeHit;

constexpr double kFarAway = 1e3;

struct Case {
  Cone cone;
  Pose X_SG = Pose::Identity();
};

bool well_within(const Cone& cone, const SurfacePoint& seen) {
  constexpr double kSlack = 1e-9;
  const double distance = seen.p.norm();
  if (!(distance > 0.0)) return false;
  const double angle = std::atan2(std::hypot(seen.p.x(), seen.p.y()), seen.p.z());
  const double incidence = std::acos(std::min(1.0, std::abs(seen.normal.dot(seen.p)) / distance));
  return angle < cone.half_angle_rad - kSlack && incidence < cone.max_incidence_rad - kSlack;
}

SurfacePoint in_sensor(const Pose& X_SG, const SurfacePoint& on_body) {
  return {X_SG * on_body.p, X_SG.linear() * on_body.normal};
}

// `project`: from a point in G to a point of the surface in G.
template <typename Project>
double nearest_sample(const Case& c, const std::optional<ConeHit>& hit, double size, const Project& project,
                      int samples, std::mt19937_64& random) {
  double nearest = std::numeric_limits<double>::infinity();
  const Pose X_GS = c.X_SG.inverse();
  const auto look = [&](const Vector3d& p_G) {
    const SurfacePoint seen = in_sensor(c.X_SG, project(p_G));
    if (well_within(c.cone, seen)) nearest = std::min(nearest, seen.p.norm());
  };
  for (int i = 0; i < samples; ++i) look(in_cube(random, 1.2 * size));
  if (!hit) return nearest;
  const Vector3d read = X_GS * hit->p_S;
  for (int i = 0; i < samples; ++i) {
    look(read + in_cube(random, size * std::pow(10.0, uniform(random, -8.0, 0.0))));
  }
  return nearest;
}

void expect_read(const Case& c, const std::optional<ConeHit>& hit, double nearest, const char* what, int round) {
  constexpr double kAgreed = 1e-9;
  if (!hit) {
    EXPECT_FALSE(std::isfinite(nearest)) << what << " " << round << ": a sample at " << nearest << " was not read";
    return;
  }
  EXPECT_GE(nearest, hit->distance - kAgreed) << what << " " << round;
  EXPECT_NEAR(hit->p_S.norm(), hit->distance, kAgreed) << what << " " << round;
  if (hit->distance < kAgreed) return;
  const double angle = std::atan2(std::hypot(hit->p_S.x(), hit->p_S.y()), hit->p_S.z());
  EXPECT_LE(angle, c.cone.half_angle_rad + kAgreed) << what << " " << round;
}

Cone random_cone(std::mt19937_64& random, bool limited) {
  Cone cone;
  cone.half_angle_rad = std::exp(uniform(random, std::log(0.02), std::log(1.4)));
  if (limited) cone.max_incidence_rad = uniform(random, 0.05, 1.5);
  return cone;
}

// Looks at the body more often than not.
Pose aimed(std::mt19937_64& random, double distance) {
  Pose X = random_pose(random, 0.3);
  X.translation().z() += uniform(random, 0.0, distance);
  return X;
}

struct Primitive {
  const char* what;
  geometry::Solid solid;
};

std::vector<Primitive> primitives() {
  using geometry::make_primitive;
  return {{"box", make_primitive(Shape::box, {0.5, 0.9, 0.3})},
          {"thin plate", make_primitive(Shape::box, {1.0, 1.0, 1e-4})},
          {"sphere", make_primitive(Shape::sphere, {0.4, 0, 0})},
          {"cylinder", make_primitive(Shape::cylinder, {0.3, 0.8, 0})},
          {"disc", make_primitive(Shape::cylinder, {0.5, 0.01, 0})},
          {"rod", make_primitive(Shape::cylinder, {0.01, 2.0, 0})},
          {"capsule", make_primitive(Shape::capsule, {0.2, 0.7, 0})},
          {"slim capsule", make_primitive(Shape::capsule, {0.02, 1.5, 0})}};
}

void expect_primitives_read(bool limited, int rounds, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (const Primitive& primitive : primitives()) {
    int seen = 0;
    for (int i = 0; i < rounds; ++i) {
      const Case c{random_cone(random, limited), aimed(random, 1.5)};
      const auto hit = nearest_in_cone(primitive.solid, c.X_SG, c.cone, kFarAway);
      const auto project = [&](const Vector3d& p) { return onto_surface(primitive.solid, p); };
      const double nearest = nearest_sample(c, hit, primitive.solid.half.maxCoeff(), project, 400, random);
      expect_read(c, hit, nearest, primitive.what, i);
      if (!hit) continue;
      ++seen;
      const SurfacePoint there = onto_surface(primitive.solid, c.X_SG.inverse() * hit->p_S);
      EXPECT_NEAR((c.X_SG * there.p - hit->p_S).norm(), 0.0, 1e-9) << primitive.what << " " << i;
    }
    EXPECT_GT(seen, rounds / 10) << primitive.what;
  }
}

TEST(Primitives, are_read_at_their_nearest_point_in_the_cone) { expect_primitives_read(false, 400, 1); }

TEST(Primitives, are_read_at_the_nearest_point_under_an_allowed_incidence) { expect_primitives_read(true, 400, 2); }

// Triangles of all proportions, down to needles.
geometry::Triangle random_triangle(std::mt19937_64& random) {
  const Vector3d a = in_cube(random, 0.5);
  const double size = std::pow(10.0, uniform(random, -3.0, 0.5));
  const double width = std::pow(10.0, uniform(random, -6.0, 0.0));
  const Vector3d along = in_cube(random, size);
  return {a, a + along, a + uniform(random, 0.0, 1.0) * along + width * in_cube(random, size)};
}

TEST(Triangle, is_read_at_its_nearest_point_in_the_cone) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 3000; ++i) {
    const Case c{random_cone(random, i % 2 == 1), aimed(random, 1.5)};
    const geometry::Triangle triangle = random_triangle(random);
    const auto hit = nearest_in_cone(mesh_of({triangle}), c.X_SG, c.cone, kFarAway);
    const auto project = [&](const Vector3d& p) { return onto_triangle(p, triangle); };
    expect_read(c, hit, nearest_sample(c, hit, 1.0, project, 300, random), "triangle", i);
    if (!hit) continue;
    const double off =
        (geometry::closest_on_triangle(c.X_SG.inverse() * hit->p_S, triangle) - c.X_SG.inverse() * hit->p_S).norm();
    EXPECT_LT(off, 1e-11) << i;
  }
}

TEST(Mesh, is_read_at_the_nearest_of_its_triangles) {
  std::mt19937_64 random(4);
  for (int round = 0; round < 20; ++round) {
    std::vector<geometry::Triangle> triangles(200);
    for (auto& triangle : triangles) triangle = random_triangle(random);
    const geometry::Solid mesh = mesh_of(triangles);
    std::vector<geometry::Solid> alone;
    alone.reserve(triangles.size());
    for (const auto& triangle : triangles) alone.push_back(mesh_of({triangle}));
    for (int i = 0; i < 40; ++i) {
      const Case c{random_cone(random, i % 2 == 1), aimed(random, 1.5)};
      const auto hit = nearest_in_cone(mesh, c.X_SG, c.cone, 2.0);
      double nearest = 2.0;
      for (const auto& one : alone) {
        const auto of_one = nearest_in_cone(one, c.X_SG, c.cone, 2.0);
        if (of_one) nearest = std::min(nearest, of_one->distance);
      }
      EXPECT_NEAR(hit ? hit->distance : 2.0, nearest, 1e-12) << round << " " << i;
    }
  }
}

TEST(Mesh, far_from_its_origin_loses_no_more_than_its_numbers_do) {
  std::mt19937_64 random(5);
  const geometry::Triangle near_by = random_triangle(random);
  const Vector3d far(1e4, -2e4, 5e3);
  const geometry::Triangle moved{near_by[0] + far, near_by[1] + far, near_by[2] + far};
  for (int i = 0; i < 200; ++i) {
    const Cone cone = random_cone(random, false);
    const Pose X_SG = aimed(random, 1.5);
    Pose X_SF = X_SG;
    X_SF.translation() -= X_SG.linear() * far;
    const auto a = nearest_in_cone(mesh_of({near_by}), X_SG, cone, kFarAway);
    const auto b = nearest_in_cone(mesh_of({moved}), X_SF, cone, kFarAway);
    if (a && b) {
      EXPECT_NEAR(a->distance, b->distance, 1e-6);
    }
  }
}

TEST(Numbers, that_are_none_are_answered_with_nothing) {
  const geometry::Solid box = geometry::make_primitive(Shape::box, {1, 1, 1});
  Pose X = Pose::Identity();
  X.translation().z() = 2.0;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(nearest_in_cone(box, X, Cone{nan}, 3.0));
  EXPECT_FALSE(nearest_in_cone(box, X, Cone{0.0}, 3.0));
  EXPECT_FALSE(nearest_in_cone(box, X, Cone{2.0}, 3.0));
  EXPECT_FALSE(nearest_in_cone(box, X, Cone{0.2, nan}, 3.0));
  EXPECT_FALSE(nearest_in_cone(box, X, Cone{0.2}, nan));
  X.translation().x() = nan;
  EXPECT_FALSE(nearest_in_cone(box, X, Cone{0.2}, 3.0));
}

}  // namespace
}  // namespace cellmirror
