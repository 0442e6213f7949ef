// Contacts of instruments, rigid bodies and tissue with tissue.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "rt_core/geometry/solid.hpp"
#include "tests/unit/tissue/world_scene.hpp"

namespace cellmirror::tissue {
namespace {

using Eigen::Vector3d;

// How deep the surface is in the effector's or the shaft's cylinder, m; negative: no point is.
double deepest(const TissueSurface& surface, const Pose& X_WT, double effector_radius) {
  const InstrumentShape shape;
  const Pose X_TW = X_WT.inverse();
  double depth = -1;
  for (const Eigen::Vector3f& p_W : surface.vertices) {
    const Vector3d p = X_TW * p_W.cast<double>();
    const auto below = [&](double from, double to, double radius) {
      const Vector3d on_axis(0, 0, std::clamp(p.z(), from, to));
      depth = std::max(depth, radius - (p - on_axis).norm());
    };
    below(-shape.effector_length_m, -effector_radius, effector_radius);
    below(-shape.shaft_length_m, -shape.effector_length_m, shape.shaft_radius_m);
  }
  return depth;
}

double mass_of(const TissueState& state, std::size_t object) { return 1000.0 * state.objects[object].volume_m3; }

TEST(WorldContact, an_instrument_that_presses_is_pushed_back_with_the_same_force) {
  Scene scene({block("liver", {0.06, 0.06, 0.04})});
  scene.instrument(0, downwards({0.001, 0.002, 0.003}));
  scene.move(0, {0.001, 0.002, -0.004}, 0.02);
  scene.steps(400);
  const double at_4_mm = scene.response(0).force_W.z();
  const InstrumentResponse felt = scene.response(0);
  EXPECT_GT(at_4_mm, 0.1) << "N";
  EXPECT_LT(std::hypot(felt.force_W.x(), felt.force_W.y()), 0.3 * at_4_mm);
  EXPECT_GT(felt.contacts, 0U);
  // The static force is steady.
  double low = 1e9;
  double high = 0;
  for (int i = 0; i < 100; ++i) {
    scene.step();
    low = std::min(low, scene.response(0).force_W.z());
    high = std::max(high, scene.response(0).force_W.z());
  }
  EXPECT_LT(high - low, 0.05 * high);
  scene.move(0, {0.001, 0.002, -0.005}, 0.02);
  scene.steps(400);
  const double at_5_mm = scene.response(0).force_W.z();
  const double stiffness = (at_5_mm - at_4_mm) / 0.001;
  EXPECT_GT(stiffness, 20) << "N/m";
  // The stiffness that it reports is that, about: it was learnt on the way.
  const double reported = scene.response(0).stiffness(2, 2);
  EXPECT_GT(reported, 0.5 * stiffness);
  EXPECT_LT(reported, 2.0 * stiffness);
  scene.move(0, {0.001, 0.002, 0.01}, 0.05);
  scene.steps(100);
  EXPECT_EQ(scene.response(0).contacts, 0U);
  EXPECT_EQ(scene.response(0).force_W.norm(), 0);
  EXPECT_EQ(scene.response(0).stiffness.norm(), 0);
}

TEST(WorldContact, a_stiffness_is_symmetric_positive_and_bounded) {
  Scene scene({block("liver", {0.06, 0.06, 0.03})});
  scene.instrument(0, downwards({0, 0, 0.002}));
  scene.move(0, {0, 0, -0.004}, 0.1);
  for (int i = 0; i < 600; ++i) {
    const double t = 0.001 * i;
    scene.instrument(
        0, downwards({0.006 * std::sin(20 * t), 0.004 * std::sin(31 * t), -0.004 + 0.004 * std::cos(50 * t)}));
    scene.step();
    const InstrumentResponse felt = scene.response(0);
    ASSERT_NEAR((felt.stiffness - felt.stiffness.transpose()).norm(), 0, 1e-9);
    const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(felt.stiffness).eigenvalues();
    ASSERT_GE(values.minCoeff(), -1e-6);
    ASSERT_LE(values.maxCoeff(), 2000.0 + 1e-6);
    ASSERT_GE(felt.force_W.z(), -0.01) << "nothing is held: the tissue below never pulls";
  }
}

TEST(WorldContact, nothing_tunnels_at_half_a_metre_a_second) {
  // From above, from below and along the surface; a block that gives way and one that is fixed.
  for (const bool fixed : {true, false}) {
    for (const int way : {0, 1, 2}) {
      if (fixed && way == 1) continue;  // its lower nodes do not move
      Scene scene({block("flap", {0.05, 0.05, 0.016}, fixed)});
      const Vector3d from = way == 0   ? Vector3d(0.002, 0.001, 0.02)
                            : way == 1 ? Vector3d(0.002, 0.001, -0.036)
                                       : Vector3d(-0.06, 0, -0.003);
      const Vector3d along = way == 0 ? Vector3d(0, 0, -1) : way == 1 ? Vector3d(0, 0, 1) : Vector3d(1, 0, 0);
      Pose X = way == 0 ? downwards(from) : way == 2 ? along_x(from) : downwards(from);
      if (way == 1) X.linear().setIdentity();
      double worst = -1;
      const int steps = way == 0 && fixed ? 44 : 80;  // at most to 2 mm below the surface where it cannot give way
      for (int i = 0; i < steps; ++i) {
        X.translation() = from + i * 0.0005 * along;
        scene.instrument(0, X);
        scene.step();
        const TissueView view = scene.view();
        ASSERT_TRUE(finite(view));
        worst = std::max(worst, deepest(view.surfaces[0], X, InstrumentShape().effector_radius_m));
      }
      EXPECT_LT(worst, 0.0015) << "way " << way << (fixed ? ", fixed" : ", free");
      EXPECT_GT(worst, -0.001) << "it was touched: way " << way << (fixed ? ", fixed" : ", free");
    }
  }
}

TEST(WorldContact, an_impulse_moves_a_free_body_by_its_mass) {
  Scene scene({block("lump", {0.03, 0.03, 0.03}, false)});
  const double mass = mass_of(scene.state(), 0);
  scene.instrument(0, downwards({0, 0, 0.01}));
  Vector3d impulse = Vector3d::Zero();
  for (int i = 0; i < 60; ++i) {
    scene.instrument(0, downwards({0, 0, 0.01 - 0.0004 * i}));
    scene.step();
    impulse -= scene.response(0).force_W * kStep_s;
  }
  scene.remove_instrument(0);
  const TissueView before = scene.view();
  scene.steps(20);
  const TissueView after = scene.view();
  Eigen::Vector3d moved = Vector3d::Zero();
  const auto count = static_cast<double>(before.surfaces[0].vertices.size());
  for (std::size_t i = 0; i < before.surfaces[0].vertices.size(); ++i) {
    moved += (after.surfaces[0].vertices[i] - before.surfaces[0].vertices[i]).cast<double>() / count;
  }
  EXPECT_NEAR(mass * moved.z() / 0.02, impulse.z(), 0.25 * std::abs(impulse.z())) << "drag and vibration aside";
  EXPECT_LT(impulse.z(), -1e-3);
}

TEST(WorldContact, friction_drags_the_surface_along) {
  Scene scene({block("liver", {0.06, 0.06, 0.03})});
  scene.instrument(0, downwards({-0.005, 0, 0.001}));
  scene.move(0, {-0.005, 0, -0.003}, 0.05);
  scene.steps(100);
  const double pressed = scene.response(0).force_W.z();
  scene.move(0, {0.005, 0, -0.003}, 0.02);
  const Vector3d force = scene.response(0).force_W;
  EXPECT_LT(force.x(), -0.01 * pressed) << "against the motion";
  EXPECT_GT(force.z(), 0.3 * pressed);
}

TEST(WorldContact, attributes_say_what_is_touched) {
  for (const bool contact : {true, false}) {
    ObjectDescription d = block("liver", {0.05, 0.05, 0.02});
    if (!contact) d.attributes &= static_cast<std::uint16_t>(~static_cast<unsigned>(TissueAttribute::contact));
    Scene scene({d});
    scene.instrument(0, downwards({0, 0, 0.001}));
    scene.move(0, {0, 0, -0.003}, 0.05);
    EXPECT_EQ(scene.response(0).contacts > 0, contact);
    EXPECT_EQ(scene.response(0).force_W.norm() > 0, contact);
  }
}

TEST(WorldContact, a_free_block_rests_on_a_rigid_body_with_its_weight) {
  for (const bool as_mesh : {false, true}) {
    ObjectDescription d = block("lump", {0.03, 0.03, 0.03}, false);
    d.attributes |= static_cast<std::uint16_t>(TissueAttribute::gravity);
    d.X_WO.translation().z() = 0.031;
    d.material.damping_s = 1e-3;
    Scene scene({d});
    const double weight = 9.81 * mass_of(scene.state(), 0);
    geometry::Solid table = geometry::make_primitive(Shape::box, {0.2, 0.2, 0.02});
    if (as_mesh) {
      auto mesh = std::make_shared<geometry::TriangleMesh>();
      const SurfaceMesh box = box_surface({-0.1, -0.1, -0.01}, {0.1, 0.1, 0.01});
      mesh->name = "table";
      mesh->vertices = box.vertices;
      mesh->triangles = box.triangles;
      mesh->closed = true;
      table = geometry::make_mesh_solid(mesh);
    }
    Pose X_WB = Pose::Identity();
    X_WB.translation().z() = -0.01;
    scene.set_bodies({{.id = 5, .solid = &table, .X_WB = X_WB}});
    scene.steps(1500);
    double force = 0;
    double lowest = 1;
    for (int i = 0; i < 200; ++i) {
      scene.step();
      TissueView view;
      scene.world().view(view, true);
      for (const auto& one : view.network.forces) force += static_cast<double>(one[1].z()) / 200;
      for (const Eigen::Vector3f& p : view.surfaces[0].vertices) lowest = std::min(lowest, static_cast<double>(p.z()));
    }
    EXPECT_NEAR(force, weight, 0.1 * weight) << (as_mesh ? "mesh" : "box");
    EXPECT_GT(lowest, -0.001);
    EXPECT_LT(lowest, 0.0005);
    EXPECT_GT(scene.state().objects[0].contacts, 0U);
  }
}

TEST(WorldContact, a_rigid_body_that_moves_pushes) {
  Scene scene({block("lump", {0.03, 0.03, 0.03}, false)});
  const geometry::Solid ball = geometry::make_primitive(Shape::sphere, Vector3d::Constant(0.02));
  Pose X_WB = Pose::Identity();
  for (int i = 0; i < 600; ++i) {
    X_WB.translation() = Vector3d(-0.05 + 0.0001 * i, 0, -0.015);
    scene.set_bodies({{.id = 1, .solid = &ball, .X_WB = X_WB}});
    scene.step();
  }
  const TissueView view = scene.view();
  ASSERT_TRUE(finite(view));
  for (const Eigen::Vector3f& p : view.surfaces[0].vertices) {
    EXPECT_GT((p.cast<double>() - X_WB.translation()).norm(), ball.radius - 0.0015);
  }
}

TEST(WorldContact, tissue_rests_on_tissue) {
  ObjectDescription lower = block("liver", {0.05, 0.05, 0.02});
  ObjectDescription upper = block("lump", {0.024, 0.024, 0.024}, false);
  upper.X_WO.translation() = Vector3d(0.003, 0.002, 0.0245);
  upper.attributes |= static_cast<std::uint16_t>(TissueAttribute::gravity);
  upper.material.damping_s = 1e-3;
  Scene scene({lower, upper});
  const double weight = 9.81 * mass_of(scene.state(), 1);
  scene.steps(1500);
  double force = 0;
  constexpr int kSteps = 600;  // it wobbles
  for (int i = 0; i < kSteps; ++i) {
    scene.step();
    TissueView view;
    scene.world().view(view, true);
    for (const auto& one : view.network.forces) force += std::abs(static_cast<double>(one[1].z())) / kSteps;
  }
  EXPECT_NEAR(force, weight, 0.1 * weight);
  const TissueView view = scene.view();
  double lowest = 1;
  for (const Eigen::Vector3f& p : view.surfaces[1].vertices) lowest = std::min(lowest, static_cast<double>(p.z()));
  EXPECT_GT(lowest, -0.003);
  EXPECT_LT(lowest, 0.001);
}

TEST(WorldContact, what_overlaps_at_the_start_is_left_so) {
  ObjectDescription lower = block("liver", {0.05, 0.05, 0.024});
  ObjectDescription upper = block("gallbladder", {0.024, 0.024, 0.024}, false);
  upper.X_WO.translation().z() = 0.014;  // 10 mm deep
  Scene scene({lower, upper});
  scene.steps(300);
  const TissueState state = scene.state();
  EXPECT_LT(state.objects[0].energy_j + state.objects[1].energy_j, 1e-5);
}

TEST(WorldContact, hostile_poses_are_ignored_and_counted) {
  Scene scene({block("liver", {0.05, 0.05, 0.02})});
  scene.instrument(0, downwards({0, 0, 0.001}));
  scene.steps(5);
  const double nan = std::nan("");
  for (const Vector3d& p :
       {Vector3d(nan, 0, 0), Vector3d(0, HUGE_VAL, 0), Vector3d(0, 0, 1e9), Vector3d(0, 0, -0.005)}) {
    scene.instrument(0, downwards(p));
    scene.step();
    ASSERT_TRUE(finite(scene.view()));
  }
  Pose bent = downwards({0, 0, -0.004});
  bent.linear() *= 3.0;
  scene.instrument(0, bent);
  scene.step();
  EXPECT_GE(scene.state().excesses[0], 5U);
  // An instrument that appears in the middle of the tissue does not throw it apart.
  for (int i = 0; i < 200; ++i) {
    scene.instrument(0, downwards({0.004 * (i % 5) - 0.008, 0.003 * (i % 7) - 0.01, i % 2 == 0 ? -0.012 : 0.02}));
    scene.step();
    ASSERT_TRUE(finite(scene.view()));
  }
  EXPECT_LT(scene.state().objects[0].energy_j, 0.05);
  scene.instrument(0, downwards({0, 0, 0.1}));
  scene.steps(1500);
  EXPECT_LT(scene.state().objects[0].energy_j, 1e-5) << "it goes back to its shape";
  // Slots that cannot be, and more instruments than there is room for.
  for (int slot = -3; slot < 40; ++slot) scene.instrument(slot, downwards({0, 0, 0.05}));
  scene.steps(3);
  EXPECT_LE(scene.state().instruments.size(), 8U);
}

}  // namespace
}  // namespace cellmirror::tissue
