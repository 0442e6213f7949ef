// What a body cannot be made of is refused with its place and a remedy.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "rt_core/tissue/body/lattice.hpp"
#include "tests/support/tissue/bodies.hpp"

namespace cellmirror::tissue {
namespace {

using namespace tissue_bodies;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void refused(const ObjectDescription& d, const std::string& words) {
  SCOPED_TRACE(words);
  const Result<Body> body = Body::make(d);
  ASSERT_FALSE(body);
  EXPECT_TRUE(body.error().what.starts_with(d.name + ":")) << body.error().what;
  EXPECT_NE(body.error().what.find(words), std::string::npos) << body.error().what;
  EXPECT_FALSE(body.error().remedy.empty()) << body.error().what;
}

TEST(TissueMake, SurfacesThatEncloseNothingAreRefused) {
  ObjectDescription open = ball(0.03, 0.007);
  open.surface.triangles.pop_back();
  refused(open, "not closed");
  ObjectDescription empty = ball(0.03, 0.007);
  empty.surface.triangles.clear();
  refused(empty, "no triangles");
  empty.surface.vertices.clear();
  refused(empty, "no triangles");
  ObjectDescription thin = ball(0.03, 0.007);
  for (Eigen::Vector3d& p : thin.surface.vertices) p.z() = 1e-5 * p.z() + 1e-3;
  refused(thin, "within the surface");
  ObjectDescription flat = ball(0.03, 0.007);
  for (Eigen::Vector3d& p : flat.surface.vertices) p.setZero();
  refused(flat, "area");
}

TEST(TissueMake, LatticesThatAreTooFineAreRefusedWithASizeThatWorks) {
  refused(ball(0.03, 1e-4), "too many nodes");
  ObjectDescription d = ball(0.03, 0.00095);
  const Result<Body> body = Body::make(d);
  ASSERT_FALSE(body);
  EXPECT_NE(body.error().what.find("elements"), std::string::npos) << body.error().what;
  EXPECT_NE(body.error().remedy.find("element_size_m"), std::string::npos);
  for (const double size : {0.0, -0.007, kNan, kInfinity, 1e-300, 1e300}) refused(ball(0.03, size), "element_size_m");
}

TEST(TissueMake, ASurfaceThatIsInsideOutIsTakenForWhatItEncloses) {
  ObjectDescription d = ball(0.03, 0.007);
  const double volume = made(d).volume_at_rest();
  for (auto& t : d.surface.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(made(d).volume_at_rest(), volume, 1e-9 * volume);
}

TEST(TissueMake, IndicesAndCoordinatesThatMakeNoSenseAreRefused) {
  ObjectDescription d = ball(0.03, 0.007);
  d.surface.triangles[7][1] = 4'000'000'000;
  refused(d, "triangle 8 of the surface refers to vertex 4000000001");
  d = ball(0.03, 0.007);
  d.surface.vertices[2].y() = kNan;
  refused(d, "vertex 3");
  d = ball(0.03, 0.007);
  d.surface.vertices[2].y() = 1e30;
  refused(d, "vertex 3");
  d = ball(0.03, 0.007);
  d.surface.texture.resize(3, Eigen::Vector2f::Zero());
  refused(d, "texture");
  d = ball(0.03, 0.007);
  d.X_WO.translation().x() = kNan;
  refused(d, "place");
}

TEST(TissueMake, TetrahedraThatNoBodyHasAreRefused) {
  const ObjectDescription good = block(Eigen::Vector3d(0.02, 0.02, 0.02), {2, 2, 2});
  ASSERT_TRUE(Body::make(good));
  ObjectDescription d = good;
  d.volume.tetrahedra[4][2] = static_cast<std::uint32_t>(d.volume.nodes.size());
  refused(d, "tetrahedron 5");
  d = good;
  d.volume.tetrahedra[4][2] = d.volume.tetrahedra[4][1];
  refused(d, "tetrahedron 5 at (");
  d = good;
  d.volume.nodes[d.volume.tetrahedra[0][0]].z() = kInfinity;
  refused(d, "tetrahedron 1");
  d = good;
  for (Eigen::Vector3d& p : d.volume.nodes) p *= 1e200;
  refused(d, "tetrahedron 1");
  d = good;
  for (Eigen::Vector3d& p : d.volume.nodes) p *= 1e-12;
  refused(d, "tetrahedron 1 is flat");
  d = good;
  d.volume.tetrahedra.push_back(d.volume.tetrahedra[3]);
  d.volume.tetrahedra.push_back(d.volume.tetrahedra[3]);
  refused(d, "shares a face");
  d = good;
  d.volume.tetrahedra.assign(2'000'000, d.volume.tetrahedra[0]);
  refused(d, "2000000 tetrahedra");
}

// A sound block, and beside it one tetrahedron whose fourth corner is nearly in the plane of the others.
TEST(TissueMake, SliversAreRefusedWithTheirPlace) {
  ObjectDescription d = block(Eigen::Vector3d(0.02, 0.02, 0.02), {2, 2, 2});
  const auto add_sliver = [&d](double height) {
    const auto first = static_cast<std::uint32_t>(d.volume.nodes.size());
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.1, 0, 0), Eigen::Vector3d(0.11, 0, 0),
                                     Eigen::Vector3d(0.1, 0.01, 0), Eigen::Vector3d(0.103, 0.003, height)})
      d.volume.nodes.push_back(p);
    d.volume.tetrahedra.push_back({first, first + 1, first + 2, first + 3});
  };
  ObjectDescription good = d;
  add_sliver(1e-6);
  refused(d, "tetrahedron 49 at (103.");
  refused(d, "mm is flat: its quality is 5e-05");
  d = good;
  add_sliver(3e-5);  // a quality of 0.0015
  refused(d, "times its mass for a stable step");
  d = good;
  add_sliver(4e-3);
  EXPECT_TRUE(Body::make(d));
}

TEST(TissueMake, TetrahedraThatAreInsideOutAreTurned) {
  ObjectDescription d = block(Eigen::Vector3d(0.02, 0.02, 0.02), {2, 2, 2});
  for (std::size_t t = 0; t < d.volume.tetrahedra.size(); t += 2)
    std::swap(d.volume.tetrahedra[t][0], d.volume.tetrahedra[t][1]);
  d.volume.nodes.emplace_back(5, 5, 5);  // which no tetrahedron has
  Body body = made(d);
  EXPECT_NEAR(body.volume_at_rest(), 8e-6, 1e-15);
  EXPECT_EQ(body.positions().size(), 27U);
  body.begin_step(0.001, Eigen::Vector3d::Zero());
  for (const Eigen::Vector3d& force : body.internal_forces()) EXPECT_LT(force.norm(), 1e-7);
}

TEST(TissueMake, MaterialsThatMakeNoSenseAreRefused) {
  const std::vector<std::pair<std::string, std::function<void(Material&, double)>>> figures{
      {"youngs_modulus_pa", [](Material& m, double v) { m.youngs_modulus_pa = v; }},
      {"poissons_ratio", [](Material& m, double v) { m.poissons_ratio = v; }},
      {"density_kg_m3", [](Material& m, double v) { m.density_kg_m3 = v; }},
      {"damping_s", [](Material& m, double v) { m.damping_s = v; }},
      {"drag_1_s", [](Material& m, double v) { m.drag_1_s = v; }},
      {"yield_strain", [](Material& m, double v) { m.yield_strain = v; }},
      {"tear_strain", [](Material& m, double v) { m.tear_strain = v; }},
  };
  for (const auto& [name, set] : figures) {
    for (const double value : {kNan, kInfinity, -1.0, 1e30}) {
      ObjectDescription d = ball(0.03, 0.01);
      set(d.material, value);
      refused(d, name);
      d.material = {};
      d.regions.push_back({.name = "hard", .radius_m = 0.01, .material = {}});
      set(d.regions[0].material, value);
      refused(d, "region hard: " + name);
    }
  }
  ObjectDescription d = ball(0.03, 0.01);
  d.material.poissons_ratio = 0.5;
  refused(d, "poissons_ratio");
  d.material = {};
  d.regions.push_back({.name = "hard", .radius_m = 0, .material = {}});
  refused(d, "region hard");
}

TEST(TissueMake, FixedZonesTurnWithTheirObject) {
  ObjectDescription d = block(Eigen::Vector3d(0.04, 0.02, 0.02), {4, 2, 2});
  d.fixed.push_back({.low = Eigen::Vector3d(-1, -1, -1), .high = Eigen::Vector3d(0.001, 1, 1)});
  d.X_WO = Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ());
  const Body body = made(d);
  std::size_t fixed = 0;
  for (std::size_t n = 0; n < body.positions().size(); ++n) {
    const bool at_end = (d.X_WO.inverse() * body.positions()[n]).x() < 0.001;
    EXPECT_EQ(body.inverse_masses()[n] == 0, at_end);
    fixed += at_end ? 1U : 0U;
  }
  EXPECT_EQ(fixed, 9U);
}

}  // namespace
}  // namespace cellmirror::tissue
