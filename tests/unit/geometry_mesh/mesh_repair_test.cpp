#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"
#include "tests/unit/geometry_mesh/shapes.hpp"

namespace cellmirror::geometry {
namespace {

struct Repaired {
  MeshFindings findings;
  Result<TriangleMesh> mesh;
};

Repaired repair(const Soup& soup) {
  Repaired out{{}, fail("")};
  out.mesh = make_mesh("test", soup.vertices, soup.triangles, out.findings);
  return out;
}

// Nothing but the parts of the contract of TriangleMesh.
void expect_fit(const TriangleMesh& mesh) {
  std::set<std::array<double, 3>> points;
  for (const Eigen::Vector3d& p : mesh.vertices) {
    EXPECT_TRUE(p.allFinite());
    EXPECT_TRUE(points.insert({p.x(), p.y(), p.z()}).second);
  }
  std::set<TriangleIndices> seen;
  for (TriangleIndices t : mesh.triangles) {
    for (const std::uint32_t corner : t) ASSERT_LT(corner, mesh.vertices.size());
    const Eigen::Vector3d u = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    EXPECT_GT(u.cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]).norm(), 0.0);
    std::ranges::sort(t);
    EXPECT_TRUE(seen.insert(t).second);
  }
  if (mesh.closed) {
    EXPECT_GT(signed_volume(mesh), 0.0);
  }
}

TEST(MeshRepair, leaves_a_good_mesh_as_it_is) {
  const auto [findings, sut] = repair(cube());
  ASSERT_TRUE(sut);
  expect_fit(*sut);
  EXPECT_TRUE(sut->closed);
  EXPECT_EQ(sut->vertices.size(), 8U);
  EXPECT_EQ(sut->triangles.size(), 12U);
  EXPECT_NEAR(signed_volume(*sut), 1.0, 1e-15);
  EXPECT_TRUE(findings.repairs().empty());
  EXPECT_EQ(findings.shells, 1U);
}

TEST(MeshRepair, welds_the_corners_of_stl) {
  const auto [findings, sut] = repair(cube().unshared());
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->closed);
  EXPECT_EQ(sut->vertices.size(), 8U);
  EXPECT_EQ(findings.welded_vertices, 28U);
  EXPECT_TRUE(findings.repairs().empty());
}

TEST(MeshRepair, welds_positions_that_differ_by_rounding_and_by_the_sign_of_zero) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> noise(-1e-10, 1e-10);
  Soup soup = torus(1.0, 0.3, 20, 10).unshared();
  for (Eigen::Vector3d& p : soup.vertices) p += Eigen::Vector3d(noise(random), noise(random), noise(random));
  soup.vertices[0].z() = soup.vertices[0].z() == 0.0 ? -0.0 : soup.vertices[0].z();
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  expect_fit(*sut);
  EXPECT_TRUE(sut->closed) << findings.why_open();
  EXPECT_EQ(sut->vertices.size(), 200U);
}

TEST(MeshRepair, keeps_apart_what_is_apart) {
  Soup soup = cube();
  soup.add(cube().scaled(1e-6));  // a mite in a room
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->vertices.size(), 16U);
  EXPECT_TRUE(sut->closed);
}

TEST(MeshRepair, works_at_every_scale_and_far_from_the_origin) {
  for (const double scale : {1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const auto [findings, sut] = repair(torus(0.6, 0.3, 16, 8).unshared().scaled(scale));
    ASSERT_TRUE(sut) << scale;
    expect_fit(*sut);
    EXPECT_TRUE(sut->closed) << scale << ": " << findings.why_open();
    EXPECT_EQ(sut->vertices.size(), 128U) << scale;
  }
  const auto [findings, sut] = repair(torus(0.6, 0.3, 16, 8).unshared().moved({1e5, -2e5, 3e4}));
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->closed) << findings.why_open();
  EXPECT_NEAR(signed_volume(*sut), signed_volume(*repair(torus(0.6, 0.3, 16, 8)).mesh), 1e-9);
}

TEST(MeshRepair, drops_triangles_that_are_lines_and_points_without_opening_the_mesh) {
  Soup soup = cube();
  soup.triangles.push_back({0, 1, 1});
  soup.triangles.push_back({3, 3, 3});
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->closed);
  EXPECT_EQ(sut->triangles.size(), 12U);
  EXPECT_EQ(findings.degenerate_triangles, 2U);
  EXPECT_EQ(findings.lost_lines, 0U);
  EXPECT_EQ(findings.repairs().size(), 1U);
}

TEST(MeshRepair, splits_the_neighbour_of_a_flat_triangle_so_that_the_mesh_stays_closed) {
  // The side 0-1 is split at its middle in one face, and a triangle without area fills the seam.
  Soup soup = cube();
  soup.vertices.emplace_back(0.0, -0.5, -0.5);  // 8
  soup.triangles[4] = {0, 8, 5};                // was {0, 1, 5}
  soup.triangles.push_back({8, 1, 5});
  soup.triangles.push_back({0, 1, 8});
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  expect_fit(*sut);
  EXPECT_TRUE(sut->closed) << findings.why_open();
  EXPECT_EQ(findings.degenerate_triangles, 1U);
  EXPECT_EQ(sut->triangles.size(), 14U);
  EXPECT_NEAR(signed_volume(*sut), 1.0, 1e-15);
}

TEST(MeshRepair, stays_closed_with_a_fan_of_flat_triangles_on_one_side) {
  Soup soup = cube();
  soup.triangles.erase(soup.triangles.begin() + 4);  // {0, 1, 5}: made of ten strips instead
  std::vector<std::uint32_t> along{0};
  for (int i = 1; i < 10; ++i) {
    along.push_back(static_cast<std::uint32_t>(soup.vertices.size()));
    soup.vertices.emplace_back(-0.5 + 0.1 * i, -0.5, -0.5);
  }
  along.push_back(1);
  for (std::size_t i = 0; i + 1 < along.size(); ++i) {
    soup.triangles.push_back({along[i], along[i + 1], 5});
    if (i > 0) soup.triangles.push_back({0, along[i + 1], along[i]});  // fills the seam, flat
  }
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  expect_fit(*sut);
  EXPECT_TRUE(sut->closed) << findings.why_open();
  EXPECT_EQ(findings.degenerate_triangles, 9U);
  EXPECT_EQ(findings.lost_lines, 0U);
}

TEST(MeshRepair, drops_needles_to_rounding_and_keeps_thin_triangles) {
  Soup soup;
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-15, 0}, {0.5, 1e-6, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->triangles.size(), 2U);
  EXPECT_EQ(findings.degenerate_triangles, 1U);
  EXPECT_EQ(findings.lost_lines, 0U);  // the side 0-1 is there
}

TEST(MeshRepair, tells_of_a_bare_line_that_is_lost) {
  Soup soup = cube();
  soup.add({{{2, 0, 0}, {2, 0, 3}, {2, 0, 1}}, {{0, 1, 2}}});
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->closed);
  EXPECT_EQ(findings.lost_lines, 1U);
  EXPECT_NEAR(findings.longest_lost_m, 3.0, 1e-12);
  ASSERT_EQ(findings.repairs().size(), 2U);
  EXPECT_NE(findings.repairs()[1].find("3 m"), std::string::npos) << findings.repairs()[1];
}

TEST(MeshRepair, drops_identical_triangles_whatever_corner_comes_first) {
  Soup soup = cube();
  soup.triangles.push_back({2, 3, 0});
  soup.triangles.push_back({5, 7, 4});
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->closed);
  EXPECT_EQ(sut->triangles.size(), 12U);
  EXPECT_EQ(findings.duplicate_triangles, 2U);
  EXPECT_EQ(findings.back_to_back, 0U);
}

TEST(MeshRepair, keeps_one_side_of_a_sheet_drawn_from_both_sides) {
  Soup soup;
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_FALSE(sut->closed);
  EXPECT_EQ(sut->triangles.size(), 2U);
  EXPECT_EQ(findings.back_to_back, 2U);
}

TEST(MeshRepair, a_closed_shell_without_volume_has_no_inside) {
  // The same square, its sides cut along different diagonals.
  Soup soup;
  soup.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_FALSE(sut->closed);
  EXPECT_TRUE(findings.flat_shell);
  EXPECT_EQ(findings.why_open(), "a shell has no volume");
}

TEST(MeshRepair, an_open_mesh_is_kept_as_a_surface) {
  Soup soup = cube();
  soup.triangles.pop_back();
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_FALSE(sut->closed);
  EXPECT_EQ(findings.open_edges, 3U);
  EXPECT_EQ(findings.why_open(), "3 edges belong to one triangle only");
  EXPECT_TRUE(findings.repairs().empty());
}

TEST(MeshRepair, cubes_that_touch_along_an_edge_are_a_solid) {
  for (const bool inside_out : {false, true}) {
    Soup soup = cube();
    soup.add(cube().moved({1, 1, 0}));
    const auto [findings, sut] = repair(inside_out ? soup.inside_out() : soup);
    ASSERT_TRUE(sut);
    expect_fit(*sut);
    EXPECT_TRUE(sut->closed) << findings.why_open();
    EXPECT_EQ(findings.shells, 1U);
    EXPECT_NEAR(signed_volume(*sut), 2.0, 1e-12);
  }
}

TEST(MeshRepair, a_fin_on_a_cube_makes_a_surface_of_it) {
  Soup soup = cube();
  soup.vertices.emplace_back(-2, -2, -0.5);
  soup.triangles.push_back({0, 4, 8});
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_FALSE(sut->closed);
  EXPECT_EQ(findings.crowded_edges, 1U);
  EXPECT_EQ(findings.open_edges, 2U);
  EXPECT_EQ(findings.why_open(), "2 edges belong to one triangle only, 1 edge belongs to too many triangles");
}

TEST(MeshRepair, turns_a_mesh_that_is_inside_out) {
  const auto [findings, sut] = repair(cube().inside_out());
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->closed);
  EXPECT_NEAR(signed_volume(*sut), 1.0, 1e-15);
  EXPECT_EQ(findings.inside_out_shells, 1U);
  ASSERT_EQ(findings.repairs().size(), 1U);
  EXPECT_EQ(findings.repairs()[0], "1 shell was inside out");
}

TEST(MeshRepair, makes_all_triangles_face_the_same_way) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    Soup soup = torus(1.0, 0.3, 12, 8);
    for (TriangleIndices& t : soup.triangles) {
      if (random() % 3 == 0) std::swap(t[0], t[1]);
    }
    const auto [findings, sut] = repair(soup);
    ASSERT_TRUE(sut);
    EXPECT_TRUE(sut->closed) << findings.why_open();
    EXPECT_GT(findings.flipped_triangles, 0U);
    EXPECT_NEAR(signed_volume(*sut), signed_volume(*repair(torus(1.0, 0.3, 12, 8)).mesh), 1e-12);
  }
}

TEST(MeshRepair, a_moebius_strip_is_a_surface) {
  Soup soup;
  const std::uint32_t n = 12;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double u = 2.0 * std::numbers::pi * i / n;
    const Eigen::Vector3d across(std::cos(u) * std::cos(u / 2), std::sin(u) * std::cos(u / 2), std::sin(u / 2));
    const Eigen::Vector3d centre(std::cos(u), std::sin(u), 0);
    soup.vertices.emplace_back(centre - 0.2 * across);
    soup.vertices.emplace_back(centre + 0.2 * across);
    const bool last = i + 1 == n;
    const std::uint32_t a = 2 * i;
    const std::uint32_t b = last ? 1 : a + 2;
    const std::uint32_t c = last ? 0 : a + 3;
    soup.triangles.push_back({a, b, c});
    soup.triangles.push_back({a, c, a + 1});
  }
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_FALSE(sut->closed);
  EXPECT_TRUE(findings.not_orientable);
}

TEST(MeshRepair, keeps_cavities_and_turns_shells_beside_and_within_them) {
  Soup soup = cube();
  soup.add(cube().scaled(0.8).inside_out());                   // a cavity
  soup.add(cube().scaled(0.5).inside_out());                   // a body in the cavity, inside out
  soup.add(cube().scaled(0.3).moved({3, 0, 0}).inside_out());  // a body beside it, inside out
  soup.add(cube().scaled(0.1).moved({3, 0.05, 0}));            // a body within a body
  const auto [findings, sut] = repair(soup);
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->closed);
  EXPECT_EQ(findings.shells, 5U);
  EXPECT_EQ(findings.inside_out_shells, 2U);
  EXPECT_NEAR(signed_volume(*sut), 1.0 - 0.512 + 0.125 + 0.027 + 0.001, 1e-12);
}

TEST(MeshRepair, refuses_what_cannot_be_trusted) {
  const auto refused = [](const Soup& soup) {
    const auto result = repair(soup).mesh;
    return result ? std::string("accepted") : result.error().what;
  };
  Soup nan = cube();
  nan.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused(nan), "a coordinate of vertex 4 is not a number");
  Soup infinite = cube();
  infinite.vertices[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refused(infinite), "a coordinate of vertex 1 is not a number");
  EXPECT_EQ(refused(cube().scaled(1e7)), "vertex 1 is 5e+06 m away from the origin");
  Soup index = cube();
  index.triangles[5][1] = 8;
  EXPECT_EQ(refused(index), "triangle 6 refers to vertex 9, but there are 8");
  EXPECT_EQ(refused({}), "there are no triangles");
  EXPECT_EQ(refused({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}}), "no triangle has an area");
  EXPECT_EQ(refused(cube().scaled(0.0)), "no triangle has an area");
  EXPECT_EQ(refused(cube().scaled(1e-300)), "no triangle has an area");
  Soup many{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<TriangleIndices>(kMostTriangles + 1, {0, 1, 2})};
  EXPECT_EQ(refused(many), "there are 2000001 triangles, more than 2000000");
}

TEST(MeshRepair, any_soup_gives_a_fit_mesh_or_a_reason) {
  std::mt19937 random(11);
  const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random() % end); };
  for (int round = 0; round < 2000; ++round) {
    // Few positions on a small grid: collinear, coplanar, equal corners everywhere.
    Soup soup;
    const std::uint32_t vertices = 3 + below(12);
    for (std::uint32_t i = 0; i < vertices; ++i) soup.vertices.emplace_back(below(3), below(3), below(2));
    const std::uint32_t triangles = 1 + below(30);
    for (std::uint32_t i = 0; i < triangles; ++i)
      soup.triangles.push_back({below(vertices), below(vertices), below(vertices)});
    const auto [findings, sut] = repair(soup);
    if (!sut) {
      EXPECT_EQ(sut.error().what, "no triangle has an area");
      continue;
    }
    expect_fit(*sut);
    EXPECT_EQ(sut->closed, findings.why_open().empty());
  }
}

}  // namespace
}  // namespace cellmirror::geometry
