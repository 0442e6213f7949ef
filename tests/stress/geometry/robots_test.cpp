// The links of the arms of ../shared/data in any posture against each other and against primitives: every answer is
// compared with the oracle's, which looks at every pair of triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "config/mesh_file.hpp"
#include "rt_core/geometry/proximity.hpp"
#include "tests/support/geometry_oracle/brute_force.hpp"
#include "tests/support/geometry_oracle/meshes.hpp"

namespace cellmirror::geometry {
namespace {

using geometry_oracle::any_pose;

constexpr double kExact = 1e-9;  // m
constexpr double kFar = std::numeric_limits<double>::infinity();

struct Link {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;
  Solid solid;
};

std::filesystem::path robots_folder() {
  if (const char* data = std::getenv("CELLMIRROR_SHARED_DATA")) return std::filesystem::path(data) / "robots";
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  return std::filesystem::path(source != nullptr ? source : ".") / ".." / "shared" / "data" / "robots";
}

// The collision meshes of all arms that have less than so many triangles: the oracle takes all pairs.
std::vector<Link> all_links(std::size_t most) {
  std::vector<Link> out;
  std::error_code missing;
  std::vector<std::filesystem::path> files;
  for (std::filesystem::recursive_directory_iterator i(robots_folder(), missing), end; !missing && i != end;
       i.increment(missing)) {
    if (i->path().extension() == ".stl" && i->path().parent_path().filename() == "collision")
      files.push_back(i->path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    MeshFindings findings;
    auto read = read_mesh_file(file, {1, 1, 1}, findings);
    if (!read || read->triangles.size() > most) continue;
    // Some files are in millimetres; as bodies in space they are as good in metres.
    double size = 0.0;
    for (const auto& vertex : read->vertices) size = std::max(size, vertex.cwiseAbs().maxCoeff());
    if (size > 10.0) {
      for (auto& vertex : read->vertices) vertex *= 1e-3;
    }
    auto mesh = geometry_oracle::shared(std::move(*read));
    out.push_back({file.string(), mesh, make_mesh_solid(mesh)});
  }
  return out;
}

class Robots : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { links_ = all_links(1200); }
  static void TearDownTestSuite() { links_.clear(); }
  void SetUp() override {
    if (links_.empty()) GTEST_SKIP() << "skipped: no arms in " << robots_folder();
  }
  const Link& any_link() { return links_[random_() % links_.size()]; }

  static std::vector<Link> links_;
  std::mt19937_64 random_{51};
};
std::vector<Link> Robots::links_;

TEST_F(Robots, linksAreAsFarApartAsTheOracleSays) {
  int touching = 0;
  for (int i = 0; i < 100 && !HasFailure(); ++i) {
    const Link& a = any_link();
    const Link& b = any_link();
    const Pose X_WA = any_pose(random_, 0.2);
    const Pose X_WB = any_pose(random_, 0.2);
    const double expected = geometry_oracle::distance(*a.mesh, X_WA, *b.mesh, X_WB);
    ProximityHint hint;
    const Separation found = separation(a.solid, X_WA, b.solid, X_WB, kFar, hint);
    EXPECT_TRUE(found.certain);
    EXPECT_NEAR(found.points.distance, expected, kExact) << a.name << ' ' << b.name;
    EXPECT_EQ(touch(a.solid, X_WA, b.solid, X_WB, hint), expected <= kTouchDistance) << a.name << ' ' << b.name;
    Contact contacts;
    EXPECT_EQ(contact(a.solid, X_WA, b.solid, X_WB, 4, contacts), expected <= kTouchDistance);
    touching += expected <= kTouchDistance ? 1 : 0;
  }
  EXPECT_GT(touching, 10);
}

// As a gateway asks: the same pair again and again, a little later, with the hint of the last answer.
TEST_F(Robots, linksInMotionMissNoTouch) {
  for (int run = 0; run < 6 && !HasFailure(); ++run) {
    const Link& a = any_link();
    const Link& b = any_link();
    const Pose X_start = any_pose(random_, 0.6);
    Eigen::Vector3d way = -1.2 * X_start.translation();
    ProximityHint hint;
    for (int step = 0; step < 400; ++step) {
      Pose X = X_start * Eigen::AngleAxisd(0.004 * step, Eigen::Vector3d(1, 1, 1).normalized());
      X.translation() += way * (step / 400.0);
      const Separation found = separation(a.solid, Pose::Identity(), b.solid, X, kFar, hint);
      ASSERT_TRUE(found.certain && std::isfinite(found.points.distance));
      if (step % 40 != 0) continue;
      ASSERT_NEAR(found.points.distance, geometry_oracle::distance(*a.mesh, Pose::Identity(), *b.mesh, X), kExact)
          << a.name << ' ' << b.name << ' ' << step;
    }
  }
}

// Every contact point lies on or in both, and the deepest is at least as deep as every corner that is inside.
TEST_F(Robots, contactsLieInBoth) {
  int compared = 0;
  for (int i = 0; i < 200 && compared < 40 && !HasFailure(); ++i) {
    const Link& a = any_link();
    const Link& b = any_link();
    if (!a.mesh->closed || !b.mesh->closed) continue;
    const Pose X_WA = any_pose(random_, 0.15);
    const Pose X_WB = any_pose(random_, 0.15);
    Contact contacts;
    if (!contact(a.solid, X_WA, b.solid, X_WB, 8, contacts)) continue;
    ++compared;
    ASSERT_FALSE(contacts.points.empty());
    EXPECT_GE(contacts.deepest.depth, 0.0);
    EXPECT_NEAR(contacts.deepest.normal.norm(), 1.0, 1e-9);
    // By a way as long as the larger body nothing is deeper.
    EXPECT_LT(contacts.deepest.depth, 2.0 * std::max(a.solid.radius, b.solid.radius));
    const auto triangles_a = geometry_oracle::placed(*a.mesh, X_WA);
    const auto triangles_b = geometry_oracle::placed(*b.mesh, X_WB);
    for (const ContactPoint& point : contacts.points) {
      const geometry_oracle::Point p{point.p_W.x(), point.p_W.y(), point.p_W.z()};
      for (const auto* surface : {&triangles_a, &triangles_b}) {
        if (geometry_oracle::winding_number(*surface, p) > 0.5L) continue;
        const auto off = geometry_oracle::surface_distance({{p, p, p}}, *surface).distance;
        EXPECT_LE(static_cast<double>(off), point.depth + 1e-6) << a.name << ' ' << b.name;
      }
    }
  }
  EXPECT_GT(compared, 5);
}

}  // namespace
}  // namespace cellmirror::geometry
