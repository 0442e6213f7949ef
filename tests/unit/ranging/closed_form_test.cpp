// Readings that can be told with paper and pencil.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "rt_core/ranging/cone.hpp"
#include "tests/unit/ranging/surfaces.hpp"

namespace cellmirror {
namespace {

using ranging::Cone;
using ranging::ConeHit;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFar = 1e3;
constexpr std::array kHalfAngles{1.0 * kDegree, 7.5 * kDegree, 15.0 * kDegree, 30.0 * kDegree, 60.0 * kDegree};

std::optional<ConeHit> sut(const geometry::Solid& solid, const Pose& X_SG, double half_angle, double up_to = kFar,
                           double incidence = 0.5 * std::numbers::pi) {
  return nearest_in_cone(solid, X_SG, Cone{half_angle, incidence}, up_to);
}

Pose at(double x, double y, double z, const Vector3d& rpy = Vector3d::Zero()) {
  return pose_from_xyz_rpy({x, y, z}, rpy);
}

// A square in the plane z = 0.
geometry::Solid plate(double half) {
  const Vector3d a(-half, -half, 0);
  const Vector3d b(half, -half, 0);
  const Vector3d c(half, half, 0);
  const Vector3d d(-half, half, 0);
  return mesh_of({{a, b, c}, {a, c, d}});
}

// A plane or line through the axis at h, tilted by `tilt`, seen in the plane in which it is tilted.
double through_axis(double h, double tilt, double half_angle) {
  return tilt <= half_angle ? h * std::cos(tilt) : h * std::cos(tilt) / std::cos(tilt - half_angle);
}

TEST(Plane, is_read_at_every_tilt_and_from_both_sides) {
  const geometry::Solid solid = plate(500.0);
  for (const double half_angle : kHalfAngles) {
    for (double tilt = 0.0; tilt <= 89.0 * kDegree; tilt += 0.5 * kDegree) {
      for (const double turned : {0.0, std::numbers::pi}) {
        const auto hit = sut(solid, at(0, 0, 2.0, {0, tilt + turned, 0}), half_angle);
        ASSERT_TRUE(hit) << half_angle << " " << tilt;
        EXPECT_NEAR(hit->distance, through_axis(2.0, tilt, half_angle), 1e-12);
        EXPECT_NEAR(hit->p_S.norm(), hit->distance, 1e-12);
      }
    }
  }
}

TEST(Plane, that_leans_away_beyond_the_cone_or_is_behind_is_not_read) {
  const geometry::Solid solid = plate(500.0);
  EXPECT_FALSE(sut(solid, at(0, 0, -0.1), 0.5));
  EXPECT_FALSE(sut(solid, at(1.0, 0, 0, {0, 90.0 * kDegree, 0}), 1e-3, 500.0));  // along the cone, 1 m beside it
}

TEST(Plane, through_the_apex_reads_zero) {
  for (const double tilt : {0.0, 0.3, 1.2}) {
    const auto hit = sut(plate(1.0), at(0.1, 0.2, 0.0, {0, 0, 0}) * at(0, 0, 0, {tilt, 0, 0}), 0.2);
    if (tilt == 0.0) {
      ASSERT_TRUE(hit);
      EXPECT_EQ(hit->distance, 0.0);
    }
  }
  const auto along = sut(plate(1.0), at(0, 0, 0, {0, 90.0 * kDegree, 0}), 0.2);
  ASSERT_TRUE(along);
  EXPECT_NEAR(along->distance, 0.0, 1e-15);
}

TEST(Plane, on_which_the_sensor_lies_ahead_of_it_reads_its_near_edge) {
  const auto hit = sut(plate(1.0), at(0, 0, 3.0, {0, 90.0 * kDegree, 0}), 0.2);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 2.0, 1e-12);
}

TEST(Face, that_the_cone_only_pierces_is_read) {
  // No vertex and no edge is anywhere near the cone.
  const auto hit = sut(mesh_of({{Vector3d(-50, -40, 0), Vector3d(60, -45, 0), Vector3d(3, 70, 0)}}),
                       at(0, 0, 1.5, {0.4, 0.1, 0}), 5.0 * kDegree);
  const Vector3d normal = at(0, 0, 0, {0.4, 0.1, 0}).linear().col(2);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, through_axis(1.5, std::acos(normal.z()), 5.0 * kDegree), 1e-12);
}

TEST(Sphere, is_read_on_and_off_the_axis) {
  const geometry::Solid solid = geometry::make_primitive(Shape::sphere, {0.3, 0, 0});
  for (const double half_angle : kHalfAngles) {
    for (double angle = 0.0; angle < 1.5; angle += 0.01) {
      const double c = 2.0;
      const auto hit = sut(solid, at(c * std::sin(angle), 0, c * std::cos(angle)), half_angle);
      const double off = std::max(0.0, angle - half_angle);
      const double nearest = std::asin(0.3 / c);
      if (std::abs(off - nearest) < 1e-9) continue;
      ASSERT_EQ(hit.has_value(), off < nearest) << half_angle << " " << angle;
      if (!hit) continue;
      const double expected = c * std::cos(off) - std::sqrt(0.09 - c * c * std::sin(off) * std::sin(off));
      EXPECT_NEAR(hit->distance, expected, 1e-12);
    }
  }
}

TEST(Sphere, around_the_apex_is_read_from_inside) {
  const geometry::Solid solid = geometry::make_primitive(Shape::sphere, {1.0, 0, 0});
  EXPECT_NEAR(sut(solid, at(0, 0, 0), 0.1)->distance, 1.0, 1e-15);
  EXPECT_NEAR(sut(solid, at(0, 0, -0.4), 0.1)->distance, 0.6, 1e-15);
  // The centre ahead: the nearest wall is behind, and what is seen first lies on the cone's surface.
  const double angle = 0.1;
  EXPECT_NEAR(sut(solid, at(0, 0, 0.4), angle)->distance,
              0.4 * std::cos(angle) + std::sqrt(1.0 - 0.16 * std::sin(angle) * std::sin(angle)), 1e-14);
}

TEST(Box, is_read_at_a_face_an_edge_and_a_corner) {
  const geometry::Solid solid = geometry::make_primitive(Shape::box, {2.0, 2.0, 2.0});
  EXPECT_NEAR(sut(solid, at(0, 0, 3.0), 0.2)->distance, 2.0, 1e-14);
  EXPECT_NEAR(sut(solid, at(0, 0, 3.0, {0, 45.0 * kDegree, 0}), 0.2)->distance, 3.0 - std::sqrt(2.0), 1e-14);
  // The corner (1, 1, 1) towards the sensor: the diagonal turned to -z.
  const Vector3d axis = Vector3d(1, 1, 1).cross(-Vector3d::UnitZ()).normalized();
  Pose X_SG = Pose::Identity();
  X_SG.linear() = Eigen::AngleAxisd(std::acos(-1.0 / std::sqrt(3.0)), axis).toRotationMatrix();
  X_SG.translation() = Vector3d(0, 0, 3.0);
  EXPECT_NEAR(sut(solid, X_SG, 0.2)->distance, 3.0 - std::sqrt(3.0), 1e-14);
}

TEST(Box, around_the_apex_is_read_from_inside) {
  const geometry::Solid solid = geometry::make_primitive(Shape::box, {2.0, 2.0, 2.0});
  EXPECT_NEAR(sut(solid, at(0, 0, 0), 0.2)->distance, 1.0, 1e-15);
  EXPECT_NEAR(sut(solid, at(0.999, 0, 0), 30.0 * kDegree)->distance, 0.001 / std::sin(30.0 * kDegree), 1e-14);
}

TEST(Box, of_triangles_reads_like_the_primitive) {
  std::mt19937_64 random(1);
  const Vector3d half(0.4, 0.7, 0.2);
  const geometry::Solid primitive = geometry::make_primitive(Shape::box, 2.0 * half);
  std::vector<geometry::Triangle> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vector3d out = side * half[axis] * Vector3d::Unit(axis);
      const Vector3d u = half[(axis + 1) % 3] * Vector3d::Unit((axis + 1) % 3);
      const Vector3d v = half[(axis + 2) % 3] * Vector3d::Unit((axis + 2) % 3);
      faces.push_back({out - u - v, out + u - v, out + u + v});
      faces.push_back({out - u - v, out + u + v, out - u + v});
    }
  }
  const geometry::Solid mesh = mesh_of(faces);
  for (int i = 0; i < 3000; ++i) {
    const Pose X_SG = random_pose(random, 1.5);
    const double half_angle = uniform(random, 0.02, 1.2);
    const double incidence = i % 2 == 0 ? 0.5 * std::numbers::pi : uniform(random, 0.05, 1.2);
    const auto a = sut(primitive, X_SG, half_angle, kFar, incidence);
    const auto b = sut(mesh, X_SG, half_angle, kFar, incidence);
    ASSERT_EQ(a.has_value(), b.has_value()) << i;
    if (a) {
      EXPECT_NEAR(a->distance, b->distance, 1e-11) << i;
    }
  }
}

// As a triangle without width, as one of a nanometre, as a cylinder and as a capsule of a micrometre.
TEST(Wire, is_read_at_all_angles) {
  const Vector3d end(10.0, 0, 0);
  const std::array<geometry::Solid, 4> wires{mesh_of({{-end, end, end}}), mesh_of({{-end, end, Vector3d(0, 1e-9, 0)}}),
                                             geometry::make_primitive(Shape::cylinder, {1e-6, 20.0, 0}),
                                             geometry::make_primitive(Shape::capsule, {1e-6, 20.0, 0})};
  for (std::size_t kind = 0; kind < wires.size(); ++kind) {
    const bool round = kind >= 2;
    const Pose X_WG = round ? at(0, 0, 0, {0, 90.0 * kDegree, 0}) : Pose::Identity();
    for (const double half_angle : kHalfAngles) {
      for (double tilt = 0.0; tilt < 80.0 * kDegree; tilt += 1.0 * kDegree) {
        for (const double turn : {0.0, 0.7, 2.5}) {
          const auto hit = sut(wires[kind], at(0, 0, 2.0, {0, -tilt, turn}) * X_WG, half_angle);
          ASSERT_TRUE(hit) << kind << " " << half_angle << " " << tilt;
          EXPECT_NEAR(hit->distance, through_axis(2.0, tilt, half_angle), round ? 1e-5 : 2e-9) << kind << " " << tilt;
        }
      }
    }
  }
}

TEST(Wire, that_grazes_the_cone_is_read_where_it_touches) {
  const double half_angle = 15.0 * kDegree;
  const geometry::Solid wire = mesh_of({{Vector3d(0, -5, 0), Vector3d(0, 5, 0), Vector3d(0, 5, 0)}});
  const double x = 2.0 * std::tan(half_angle);
  const auto within = sut(wire, at(x - 1e-9, 0, 2.0), half_angle);
  ASSERT_TRUE(within);
  EXPECT_NEAR(within->distance, 2.0 / std::cos(half_angle), 1e-8);
  EXPECT_FALSE(sut(wire, at(x + 1e-9, 0, 2.0), half_angle));
}

TEST(Wire, along_the_cones_surface_is_read_at_its_near_end) {
  const double half_angle = 20.0 * kDegree;
  const Vector3d u(std::sin(half_angle - 1e-12), 0, std::cos(half_angle - 1e-12));
  const auto hit = sut(mesh_of({{0.5 * u, 2.0 * u, 2.0 * u}}), at(0, 0, 0), half_angle);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 0.5, 1e-12);
}

TEST(Wire, behind_the_apex_is_not_read) {
  const double half_angle = 60.0 * kDegree;
  EXPECT_FALSE(sut(mesh_of({{Vector3d(-1, 0, -1), Vector3d(1, 0, -1), Vector3d(1, 0, -1)}}), at(0, 0, 0), half_angle));
}

TEST(Cylinder, upright_and_lying_is_read_like_a_line_less_its_radius) {
  const geometry::Solid solid = geometry::make_primitive(Shape::cylinder, {0.1, 4.0, 0});
  EXPECT_NEAR(sut(solid, at(0, 0, 2.0, {90.0 * kDegree, 0, 0}), 0.1)->distance, 1.9, 1e-13);
  EXPECT_NEAR(sut(solid, at(0, 0, 3.0), 0.3)->distance, 1.0, 1e-13);
  EXPECT_NEAR(sut(solid, at(0.05, 0, 3.0), 0.01)->distance, 1.0, 1e-13);
  // From inside, along the axis and across it.
  EXPECT_NEAR(sut(solid, at(0, 0, 0), 0.3)->distance, 0.1 / std::sin(0.3), 1e-10);
  EXPECT_NEAR(sut(solid, at(0, 0, 0.02, {90.0 * kDegree, 0, 0}), 0.1)->distance,
              0.02 * std::cos(0.1) + std::sqrt(0.01 - 0.0004 * std::sin(0.1) * std::sin(0.1)), 1e-10);
}

TEST(Reading, is_nearer_than_the_limit) {
  const geometry::Solid solid = geometry::make_primitive(Shape::box, {2.0, 2.0, 2.0});
  EXPECT_FALSE(sut(solid, at(0, 0, 3.0), 0.2, 2.0));
  EXPECT_TRUE(sut(solid, at(0, 0, 3.0), 0.2, std::nextafter(2.0, 3.0)));
}

TEST(Incidence, limits_the_tilt_of_a_plane) {
  const geometry::Solid solid = plate(500.0);
  const double half_angle = 10.0 * kDegree;
  for (double tilt = 0.25 * kDegree; tilt < 80.0 * kDegree; tilt += 0.5 * kDegree) {
    const auto hit = sut(solid, at(0, 0, 2.0, {0, tilt, 0}), half_angle, kFar, 20.0 * kDegree);
    // The beam on the cone's surface that leans towards the normal meets it under tilt - half_angle.
    ASSERT_EQ(hit.has_value(), tilt - half_angle <= 20.0 * kDegree) << tilt / kDegree;
    if (hit) {
      EXPECT_NEAR(hit->distance, through_axis(2.0, tilt, half_angle), 1e-12);
    }
  }
}

TEST(Incidence, lets_a_sphere_echo_only_near_its_middle) {
  const geometry::Solid solid = geometry::make_primitive(Shape::sphere, {0.3, 0, 0});
  const double limit = 20.0 * kDegree;
  const double half_angle = 5.0 * kDegree;
  // Under the limit the beam passes the centre at r sin(limit).
  const double farthest = half_angle + std::asin(0.3 * std::sin(limit) / 2.0);
  for (const double angle : {farthest - 1e-6, farthest + 1e-6}) {
    const auto hit = sut(solid, at(2.0 * std::sin(angle), 0, 2.0 * std::cos(angle)), half_angle, kFar, limit);
    EXPECT_EQ(hit.has_value(), angle < farthest);
  }
}

}  // namespace
}  // namespace cellmirror
