// What a ball finds around it: planes, edges, corners, round bodies, hollows; as primitives and as meshes.
#include <numbers>
#include <random>

#include "rt_core/rt/allocation_guard.hpp"
#include "tests/unit/contact_model/probe.hpp"

namespace cellmirror::contact_model {
namespace {

using Eigen::Vector3d;
using geometry::Soup;

constexpr const char* kBox = R"(
[[node]]
name = "Box"
geometry = [{ box_m = [0.1, 0.1, 0.1] }]
)";
Soup box_soup() { return geometry::cube().scaled(0.1); }

// A square plate of z = 0 with `cells` * `cells` squares, facing up; a surface.
Soup sheet(double edge, std::uint32_t cells) {
  Soup out;
  for (std::uint32_t i = 0; i <= cells; ++i) {
    for (std::uint32_t k = 0; k <= cells; ++k)
      out.vertices.emplace_back(edge * (1.0 * i / cells - 0.5), edge * (1.0 * k / cells - 0.5), 0.0);
  }
  const std::uint32_t row = cells + 1;
  for (std::uint32_t i = 0; i < cells; ++i) {
    for (std::uint32_t k = 0; k < cells; ++k) {
      const std::uint32_t a = i * row + k;
      out.triangles.push_back({a, a + row, a + row + 1});
      out.triangles.push_back({a, a + row + 1, a + 1});
    }
  }
  return out;
}

// A tube along z, only its inner and outer walls and end rings.
Soup tube(double inner, double outer, double length, std::uint32_t around) {
  Soup out;
  for (std::uint32_t k = 0; k < around; ++k) {
    const double angle = 2 * std::numbers::pi * k / around;
    for (const double r : {inner, outer}) {
      for (const double z : {-0.5, 0.5})
        out.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z * length);
    }
  }
  const auto quad = [&out](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    out.triangles.push_back({a, b, c});
    out.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k < around; ++k) {
    const std::uint32_t a = 4 * k;  // inner low, inner high, outer low, outer high
    const std::uint32_t b = 4 * ((k + 1) % around);
    quad(b, a, a + 1, b + 1);
    quad(a + 2, b + 2, b + 3, a + 3);
    quad(b + 2, a + 2, a, b);
    quad(a + 3, b + 3, b + 1, a + 1);
  }
  return out;
}

struct ContactFinderShapes : Probe {};

TEST_F(ContactFinderShapes, AFlatFaceGivesExactlyItsNormalAndGap) {
  for (const bool mesh : {false, true}) {
    build(kBox);
    if (mesh) replace("Box", box_soup());
    at({0.013, -0.02, 0.05 + kBall + 0.003});
    ASSERT_EQ(model.count, 1);
    const haptics::ContactConstraint& c = model.constraints[0];
    EXPECT_EQ(c.normal, Vector3d::UnitZ());
    EXPECT_LT((c.a - c.normal).norm(), 1e-12) << "a contact at the tip";
    EXPECT_NEAR(c.gap, 0.003 - kMargin, 1e-12);
    EXPECT_LT((c.point - Vector3d(0.013, -0.02, 0.053)).norm(), 1e-12);
    EXPECT_EQ(model.x_ref, Vector3d(0.013, -0.02, 0.05 + kBall + 0.003));
    EXPECT_TRUE(model.certain);
    EXPECT_EQ(model.reach, kReach);
    EXPECT_EQ(model.posture_time, Timestamp{now});
  }
}

TEST_F(ContactFinderShapes, WhatIsOutOfReachIsLeftOut) {
  build(kBox);
  EXPECT_EQ(at({0, 0, 0.05 + kBall + kMargin + kReach + 1e-5}).count, 0);
  EXPECT_EQ(model.reach, kReach);
  EXPECT_EQ(at({0, 0, 0.05 + kBall + kMargin + kReach - 1e-5}).count, 1);
}

TEST_F(ContactFinderShapes, EdgesAndCornersPushTowardsTheBall) {
  for (const bool mesh : {false, true}) {
    build(kBox);
    if (mesh) replace("Box", box_soup());
    const Vector3d off_edge = Vector3d(0.6, 0, 0.8) * (kBall + 0.001);
    at(Vector3d(0.05, 0.01, 0.05) + off_edge);
    ASSERT_EQ(model.count, 1) << mesh;
    EXPECT_LT((model.constraints[0].normal - Vector3d(0.6, 0, 0.8)).norm(), 1e-9);
    EXPECT_NEAR(model.constraints[0].gap, 0.001 - kMargin, 1e-12);
    const Vector3d d = Vector3d(1, 2, 2) / 3;
    at(Vector3d(0.05, 0.05, 0.05) + d * (kBall + 0.0005));
    ASSERT_EQ(model.count, 1) << mesh;
    EXPECT_LT((model.constraints[0].normal - d).norm(), 1e-9);
    EXPECT_NEAR(model.constraints[0].gap, 0.0005 - kMargin, 1e-12);
    // Over a face beside the edge nothing but the face counts: it must not be felt before it is passed.
    at({0.0499, 0.0, 0.05 + kBall + 0.001});
    ASSERT_EQ(model.count, 1) << mesh;
    EXPECT_EQ(model.constraints[0].normal, Vector3d::UnitZ());
  }
}

TEST_F(ContactFinderShapes, MeshesAndPrimitivesAgree) {
  struct Found {
    std::size_t count;
    double gap;
    Vector3d normal;
  };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.062, 0.062);
  std::vector<Vector3d> places;
  while (places.size() < 2000) {
    const Vector3d p(place(random), place(random), place(random));
    if (p.cwiseAbs().maxCoeff() > 0.05 + kBall) places.push_back(p);
  }
  std::vector<Found> primitive;
  build(kBox);
  for (const Vector3d& p : places) {
    at(p);
    primitive.push_back({model.count, model.constraints[0].gap, model.constraints[0].normal});
  }
  replace("Box", box_soup());
  for (std::size_t i = 0; i < places.size(); ++i) {
    at(places[i]);
    ASSERT_EQ(model.count, primitive[i].count) << places[i].transpose();
    if (model.count == 0) continue;
    EXPECT_NEAR(model.constraints[0].gap, primitive[i].gap, 1e-9);
    EXPECT_LT((model.constraints[0].normal - primitive[i].normal).norm(), 1e-6);
  }
}

TEST_F(ContactFinderShapes, ASphereIsPushedAwayFromRadially) {
  build("[[node]]\nname = \"Ball\"\ngeometry = [{ sphere_m = 0.03 }]\n");
  const Vector3d d = Vector3d(-2, 3, 6) / 7;
  at(d * (0.03 + kBall + 0.004));
  ASSERT_EQ(model.count, 1);
  EXPECT_LT((model.constraints[0].normal - d).norm(), 1e-12);
  EXPECT_NEAR(model.constraints[0].gap, 0.004 - kMargin, 1e-12);
}

TEST_F(ContactFinderShapes, InsideATubeAllWallsAreFelt) {
  build("[[node]]\nname = \"Tube\"\ngeometry = [{ cylinder_m = [0.008, 0.06] }]\n");
  constexpr double kInner = 0.006;
  replace("Tube", tube(kInner, 0.008, 0.06, 48));
  for (const Vector3d& x : {Vector3d(0, 0, 0), Vector3d(0.002, 0.001, 0.004)}) {
    at(x);
    EXPECT_GT(model.count, 3);
    EXPECT_TRUE(model.certain);
    for (int k = 0; k < 36; ++k) {
      const double angle = 2 * std::numbers::pi * k / 36;
      const Vector3d d(std::cos(angle), std::sin(angle), 0);
      const double along = x.head<2>().dot(d.head<2>());
      const double clear = kInner - kBall;
      const double exact = -along + std::sqrt(along * along + clear * clear - x.head<2>().squaredNorm());
      const double way = std::min(free_way(d), model.reach);
      if (exact < model.reach) {
        EXPECT_NEAR(way, exact, 0.1 * exact + 1e-4) << k;
      }
    }
    EXPECT_GT(free_way(Vector3d::UnitZ()), model.reach) << "along the tube it is free";
  }
}

TEST_F(ContactFinderShapes, ACornerOfARoomIsThreePlanes) {
  for (const bool mesh : {false, true}) {
    build(kBox);
    // A mesh that is a hollow: the cube with its faces inwards within a larger one.
    Soup room = geometry::cube().scaled(0.2);
    room.add(geometry::cube().scaled(0.1).inside_out());
    if (mesh) {
      replace("Box", room);
    } else {
      build(R"(
[[node]]
name = "Walls"
geometry = [{ box_m = [0.02, 0.2, 0.2], xyz_m = [0.06, 0.0, 0.0] }, { box_m = [0.2, 0.02, 0.2], xyz_m = [0.0, 0.06, 0.0] },
            { box_m = [0.2, 0.2, 0.02], xyz_m = [0.0, 0.0, 0.06] }]
)");
    }
    at(Vector3d::Constant(0.05 - kBall) - Vector3d(0.001, 0.002, 0.003));
    ASSERT_EQ(model.count, 3) << mesh;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const haptics::ContactConstraint& c = model.constraints[static_cast<std::size_t>(i)];
      EXPECT_LT((c.normal + Vector3d::Unit(i)).norm(), 1e-9);
      EXPECT_NEAR(c.gap, 0.001 * static_cast<double>(i + 1) - kMargin, 1e-9);
    }
  }
}

TEST_F(ContactFinderShapes, ManyTrianglesOfOneFaceAreOneConstraintAndNeverFlicker) {
  build(kBox);
  replace("Box", sheet(0.1, 60));
  for (int i = 0; i < 500; ++i) {
    at({0.0001 * i - 0.02, 0.00003 * i, kBall + 1e-5 * (i % 7)});
    ASSERT_EQ(model.count, 1) << i;
    ASSERT_EQ(model.constraints[0].normal, Vector3d::UnitZ()) << i;
    ASSERT_NEAR(model.constraints[0].gap, 1e-5 * (i % 7) - kMargin, 1e-12) << i;
  }
  // From below too: an open mesh has two sides.
  at({0.01, 0.01, -kBall - 0.001});
  ASSERT_EQ(model.count, 1);
  EXPECT_EQ(model.constraints[0].normal, Vector3d(-Vector3d::UnitZ()));
}

TEST_F(ContactFinderShapes, FacetsOfASmoothSurfaceFeelSmooth) {
  build("[[node]]\nname = \"Ring\"\ngeometry = [{ sphere_m = 0.03 }]\n");
  constexpr double kTube = 0.02;
  replace("Ring", geometry::torus(0.05, kTube, 120, 60));
  Vector3d last = Vector3d::Zero();
  double worst = 0;
  double worst_step = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double angle = 0.3 + 1.5 * i / 4000;  // over the crest of the ring
    const Vector3d n(0, std::cos(angle), std::sin(angle));
    at(Vector3d(0, 0.05, 0) + (kTube + kBall) * n);
    ASSERT_GE(model.count, 1);
    const Vector3d& normal = model.constraints[0].normal;
    worst = std::max(worst, (normal - n).norm());
    if (i > 0) worst_step = std::max(worst_step, (normal - last).norm());
    last = normal;
  }
  // Facets are 0.1 rad apart there, and a step is 0.000375 rad.
  EXPECT_LT(worst, 0.02);
  EXPECT_LT(worst_step, 0.004);
}

TEST_F(ContactFinderShapes, AMeshAsAnInstrumentFeelsTheSame) {
  // A cube of 4 mm, upright: over a face by its face, beside an edge by its edge.
  build(kBox, "{ box_m = [0.004, 0.004, 0.004] }");
  for (const bool mesh_instrument : {false, true}) {
    for (const bool mesh_obstacle : {false, true}) {
      adopt();
      if (mesh_instrument) replace("Probe.X.Y.Z.TIP", geometry::cube().scaled(0.004));
      if (mesh_obstacle) replace("Box", box_soup());
      at({0.01, 0.01, 0.052 + 0.001});
      ASSERT_GE(model.count, 1) << mesh_instrument << mesh_obstacle;
      EXPECT_LT((model.constraints[0].normal - Vector3d::UnitZ()).norm(), 1e-9);
      EXPECT_NEAR(model.constraints[0].gap, 0.001 - kMargin, 1e-9);
      EXPECT_NEAR(free_way(-Vector3d::UnitZ()), 0.001 - kMargin, 1e-9);
      EXPECT_GT(free_way(Vector3d::UnitX()), 0.009) << "along the face it is free";
    }
  }
}

TEST_F(ContactFinderShapes, WhatOverlapsIsPushedOut) {
  for (const bool mesh : {false, true}) {
    build(kBox);
    if (mesh) replace("Box", box_soup());
    // Less than the ball's radius deep, and the whole ball inside.
    at({0.0, 0.0, 0.05 + kBall - 0.0005});
    ASSERT_GE(model.count, 1) << mesh;
    EXPECT_LT((model.constraints[0].normal - Vector3d::UnitZ()).norm(), 1e-6);
    EXPECT_NEAR(model.constraints[0].gap, -0.0005 - kMargin, 1e-9);
    at({0.0, 0.0, 0.045});
    ASSERT_GE(model.count, 1) << mesh;
    EXPECT_LT((model.constraints[0].normal - Vector3d::UnitZ()).norm(), 1e-6) << mesh;
    EXPECT_NEAR(model.constraints[0].gap, -0.005 - kBall - kMargin, 1e-4) << mesh;
    EXPECT_TRUE(model.certain);
  }
  EXPECT_GT(sut->counters().overlaps, 0U);
}

TEST_F(ContactFinderShapes, MovingObstaclesAreFollowed) {
  build("[[node]]\nname = \"Other\"\nabstract = \"second.mpc\"\nrobot_id = \"OTHER\"\n");
  const std::size_t other = cell->robot("OTHER")->slot();
  for (int i = 0; i < 20; ++i) {
    q[other][0] = 0.02 - 0.0005 * i;
    at({0, 0, 0});
    const double gap = q[other][0] - 2 * kBall - kMargin;
    if (gap >= kReach) {
      EXPECT_EQ(model.count, 0) << i;
    } else {
      ASSERT_EQ(model.count, 1) << i;
      EXPECT_NEAR(model.constraints[0].gap, gap, 1e-12);
      EXPECT_LT((model.constraints[0].normal + Vector3d::UnitX()).norm(), 1e-12);
    }
  }
}

TEST_F(ContactFinderShapes, WhatTheCellTakesAwayIsGone) {
  build(kBox);
  EXPECT_EQ(at({0, 0, 0.055}).count, 1);
  ASSERT_TRUE(cell->deactivate("Box"));
  adopt();
  EXPECT_EQ(again().count, 0);
  ASSERT_TRUE(cell->activate("Box"));
  adopt();
  EXPECT_EQ(again().count, 1);
  // Carried by the instrument it is no longer in its way.
  ASSERT_TRUE(cell->connect("Box", "Probe.X.Y.Z.TIP", q));
  adopt();
  EXPECT_EQ(again().count, 0);
}

TEST_F(ContactFinderShapes, ARuleTakesAPairOut) {
  build(kBox);
  collision::Settings settings;
  settings.rules.push_back({"Box", "Probe", collision::PairRule::Kind::ignore, ""});
  pairs = derivation.derive(*compiled, settings);
  sut->adopt(compiled, pairs);
  EXPECT_EQ(at({0, 0, 0.055}).count, 0);
}

TEST_F(ContactFinderShapes, WithoutItsRobotThereIsNoModel) {
  ContactFinder sut_without(7, {});
  haptics::ContactModel out;
  out.sequence = 5;
  sut_without.find(poses, Timestamp{1}, out);
  EXPECT_EQ(out.sequence, 0U);
  build(kBox);
  sut_without.adopt(compiled, pairs);
  sut_without.find(poses, Timestamp{1}, out);
  EXPECT_EQ(out.sequence, 0U);
  EXPECT_FALSE(out.certain);
}

TEST_F(ContactFinderShapes, APoseThatIsNoneIsNotCertain) {
  build("[[node]]\nname = \"Other\"\nabstract = \"second.mpc\"\nrobot_id = \"OTHER\"\n");
  q[cell->robot("OTHER")->slot()][0] = std::numeric_limits<double>::quiet_NaN();
  at({0, 0, 0});
  EXPECT_FALSE(model.certain);
  EXPECT_EQ(model.count, 0);
}

TEST_F(ContactFinderShapes, LeavesTheHeapAloneInSteadyState) {
  ASSERT_TRUE(AllocationGuard::armed()) << "the interposer is not linked in";
  build(kBox);
  replace("Box", geometry::torus(0.05, 0.02, 120, 60));
  const auto round = [this] {
    for (int i = 0; i < 50; ++i) at({0.0, 0.05 - 0.001 * i, kBall + 0.0201});
  };
  round();
  const AllocationGuard guard;
  round();
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
}

}  // namespace
}  // namespace cellmirror::contact_model
