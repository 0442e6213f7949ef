#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "config/mesh_file.hpp"
#include "config/mesh_reader/polygon.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

using geometry::TriangleMesh;

Result<TriangleMesh> parse(std::string_view bytes, std::string_view extension,
                           const Eigen::Vector3d& scale = Eigen::Vector3d::Ones()) {
  geometry::MeshFindings findings;
  return parse_mesh(bytes, extension, "m", scale, {}, findings);
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : mesh.vertices) box.extend(p);
  return box;
}

void expect_tetrahedron(const Result<TriangleMesh>& sut, double low_z = 0.0) {
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_TRUE(sut->closed);
  EXPECT_EQ(sut->triangles.size(), 4U);
  EXPECT_EQ(sut->vertices.size(), 4U);
  EXPECT_NEAR(geometry::signed_volume(*sut), 1.0 / 6.0, 1e-7);
  EXPECT_TRUE(
      box_of(*sut).isApprox(Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, low_z), Eigen::Vector3d(1, 1, low_z + 1)), 1e-6));
}

std::string refusal(std::string_view bytes, std::string_view extension) {
  const auto result = parse(bytes, extension);
  return result ? "accepted" : result.error().what;
}

TEST(MeshFile, reads_stl_in_both_kinds) {
  expect_tetrahedron(parse(tetra_stl(), ".stl"));
  expect_tetrahedron(parse(tetra_stl("solid, says the header of this binary file"), ".stl"));
  expect_tetrahedron(parse(tetra_ascii_stl(), ".stl"));
}

TEST(MeshFile, reads_stl_text_behind_a_mark_and_blanks_and_in_capitals) {
  std::string capitals = tetra_ascii_stl();
  std::ranges::transform(capitals, capitals.begin(), [](char c) { return static_cast<char>(std::toupper(c)); });
  expect_tetrahedron(parse(" \r\n" + tetra_ascii_stl(), ".stl"));
  expect_tetrahedron(parse("\xEF\xBB\xBF" + tetra_ascii_stl(), ".stl"));
  expect_tetrahedron(parse("\xEF\xBB\xBF\n" + capitals, ".stl"));
  expect_tetrahedron(parse("solid" + capitals.substr(5), ".stl"));
  expect_tetrahedron(parse(tetra_stl(" SOLID, says the header of this binary file"), ".stl"));
  EXPECT_THAT(refusal("SOLID of nothing\n", ".stl"), testing::HasSubstr("it has no facets"));
}

TEST(MeshFile, reads_a_dae_whose_cameras_have_one_name) {
  std::string dae = tetra_dae("Z_UP");
  const std::string lens =
      "<optics><technique_common><perspective><yfov>30</yfov><znear>0.1</znear><zfar>10</zfar></perspective>"
      "</technique_common></optics></camera>";
  dae.insert(dae.find("<library_visual_scenes"),
             "<library_cameras><camera id=\"c1\" name=\"Camera\">" + lens + "</library_cameras>");
  const std::string node = "<node id=\"Camera\" name=\"Camera\"><instance_camera url=\"#c1\"/></node>";
  dae.insert(dae.find("</visual_scene>"), node + node);
  expect_tetrahedron(parse(dae, ".dae"), 0.5);
}

TEST(MeshFile, reads_ply) { expect_tetrahedron(parse(kTetraPly, ".ply")); }

TEST(MeshFile, reads_obj_with_polygons_and_without_lines_and_points) {
  const auto sut = parse(kLObj, ".obj");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_TRUE(sut->closed);
  EXPECT_EQ(sut->vertices.size(), 12U);
  EXPECT_EQ(sut->triangles.size(), 20U);
  EXPECT_NEAR(geometry::signed_volume(*sut), 3.0, 1e-12);
}

TEST(MeshFile, takes_the_unit_of_dae_and_leaves_its_axes) {
  expect_tetrahedron(parse(tetra_dae("Z_UP"), ".dae"), 0.5);
  expect_tetrahedron(parse(tetra_dae("Y_UP"), ".dae"), 0.5);
}

TEST(MeshFile, merges_what_the_nodes_of_gltf_show) {
  for (const auto& sut : {parse(tetra_glb(), ".glb")}) {
    ASSERT_TRUE(sut) << sut.error().text();
    EXPECT_TRUE(sut->closed);
    EXPECT_EQ(sut->triangles.size(), 8U);
    EXPECT_NEAR(box_of(*sut).max().z(), 6.0, 1e-6);
  }
}

TEST(MeshFile, reads_the_buffer_beside_a_gltf_and_no_other_file) {
  const TemporaryHome home;
  home.write("envlib/buffers/t.bin", tetra_buffer());
  home.write("t.bin", tetra_buffer());
  const auto read = [&](const std::string& uri) {
    geometry::MeshFindings findings;
    return read_mesh_file(home.write("envlib/t.gltf", tetra_gltf("\"uri\":\"" + uri + "\",")), Eigen::Vector3d::Ones(),
                          findings);
  };
  const auto sut = read("buffers/t.bin");
  ASSERT_TRUE(sut) << sut.error().text();
  EXPECT_EQ(sut->triangles.size(), 8U);
  EXPECT_EQ(sut->name, "t.gltf");
  for (const std::string uri : {"missing.bin", "../t.bin", "/etc/hostname", "buffers"}) {
    EXPECT_FALSE(read(uri)) << uri;
  }
  const auto missing = read("missing.bin");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().text(),
            "the mesh t.gltf is refused: its buffer missing.bin is missing; put it beside the mesh");
  // One that nothing uses need not be there.
  EXPECT_TRUE(read("buffers/t.bin\",\"byteLength\":72},{\"uri\":\"missing.bin"));
}

TEST(MeshFile, scales_and_mirrors) {
  const auto larger = parse(tetra_stl(), ".stl", {2, 3, 4});
  ASSERT_TRUE(larger);
  EXPECT_NEAR(geometry::signed_volume(*larger), 4.0, 1e-12);
  geometry::MeshFindings findings;
  const auto mirrored = parse_mesh(tetra_stl(), ".stl", "m", {-1, 1, 1}, {}, findings);
  ASSERT_TRUE(mirrored);
  EXPECT_NEAR(geometry::signed_volume(*mirrored), 1.0 / 6.0, 1e-12);
  EXPECT_EQ(findings.inside_out_shells, 0U);
}

TEST(MeshFile, refuses_damaged_files_with_the_reason) {
  const std::string stl = tetra_stl();
  EXPECT_EQ(refusal(stl.substr(0, stl.size() - 1), ".stl"),
            "the mesh m is refused: it is not an STL file: 4 triangles need 284 bytes, but it has 283");
  EXPECT_EQ(refusal(stl.substr(0, 50), ".stl"), "the mesh m is refused: it is not an STL file");
  EXPECT_EQ(refusal("", ".stl"), "the mesh m is refused: it is empty");
  EXPECT_EQ(refusal("solid\nendsolid\n", ".stl"), "the mesh m is refused: it has no facets");
  EXPECT_EQ(refusal(stl, ".step"), "the mesh m is refused: its kind is unknown");
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal(binary_stl({{{{0, 0, 0}, {1, 0, 0}, {0, 1, kNan}}}}), ".stl"),
            "the mesh m is refused: a coordinate of vertex 3 is not a number");
  EXPECT_EQ(refusal(binary_stl({{{{0, 0, 0}, {1e9F, 0, 0}, {0, 1, 0}}}}), ".stl"),
            "the mesh m is refused: vertex 2 is 1e+09 m away from the origin");
  for (const char* extension : {".obj", ".dae", ".ply", ".gltf", ".glb"}) {
    EXPECT_TRUE(refusal("nonsense", extension).starts_with("the mesh m is refused: ")) << extension;
    EXPECT_TRUE(refusal(stl, extension).starts_with("the mesh m is refused: ")) << extension;
  }
  EXPECT_EQ(refusal("v 0 0 0\nv 1 0 0\nl 1 2\n", ".obj").substr(0, 23), "the mesh m is refused: ");
}

TEST(MeshFile, refuses_a_dae_with_a_skin_and_takes_empty_controllers) {
  const auto with = [](const std::string& controllers) {
    std::string dae = tetra_dae("Z_UP");
    return dae.insert(dae.find("<library_visual_scenes"),
                      "<library_controllers>" + controllers + "</library_controllers>");
  };
  expect_tetrahedron(parse(with(""), ".dae"), 0.5);
  EXPECT_NE(refusal(with(R"(<controller id="c"><skin source="#g"/></controller>)"), ".dae")
                .find("skins a mesh to a skeleton"),
            std::string::npos);
}

TEST(MeshFile, reads_no_dae_beyond_the_end_of_its_arrays) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string dae = tetra_dae("Z_UP");
    const std::size_t at = dae.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return dae.replace(at, from.size(), to);
  };
  const std::string beyond = "the mesh m is refused: <accessor> in line 6 reaches beyond its array";
  EXPECT_EQ(refusal(changed(R"("pa" count="12")", R"("pa")"), ".dae"), beyond);
  EXPECT_EQ(refusal(changed(R"(count="4" stride)", R"(count="5" stride)"), ".dae"), beyond);
  EXPECT_EQ(refusal(changed(R"(stride="3")", R"(stride="4")"), ".dae"), beyond);
  EXPECT_EQ(refusal(changed(R"(stride="3")", R"(stride="3" offset="1")"), ".dae"), beyond);
  EXPECT_EQ(
      refusal(changed(R"(<param name="X")", R"(<extra><param name="E" type="float"/></extra><param name="X")"), ".dae"),
      beyond);
  EXPECT_EQ(refusal(changed("#pa", "#other"), ".dae"), beyond);
  const std::string names =
      R"(<source id="i"><Name_array id="ia" count="4">A B C D</Name_array><technique_common><accessor source="#ia"
count="4"><param name="X" type="name"/></accessor></technique_common></source>)";
  const std::string with_names =
      changed("<library_geometries>",
              "<library_animations><animation>" + names + "</animation></library_animations><library_geometries>");
  expect_tetrahedron(parse(with_names, ".dae"), 0.5);
  std::string shows_names = with_names;
  const std::string positions = R"("POSITION" source="#p")";
  shows_names.replace(shows_names.find(positions), positions.size(), R"("POSITION" source="#i")");
  EXPECT_EQ(refusal(shows_names, ".dae"), "the mesh m is refused: <input> in line 9 refers to no numbers");
}

// The area that triangles of a plane polygon cover, those that face down counted negative.
double covered(const std::vector<Eigen::Vector3d>& vertices, const std::vector<geometry::TriangleIndices>& triangles) {
  double area = 0.0;
  for (const auto& [a, b, c] : triangles)
    area += 0.5 * (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]).z();
  return area;
}

TEST(Polygon, cuts_concave_polygons_without_overlap) {
  // A comb: every other corner lies deep.
  std::vector<Eigen::Vector3d> vertices{{0, -1, 0}, {40, -1, 0}};
  for (int i = 40; i >= 0; --i) vertices.emplace_back(i, i % 2 == 0 ? 10 : 0.1, 0);
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < vertices.size(); ++i) corners.push_back(i);
  std::vector<geometry::TriangleIndices> sut;
  cut_polygon(corners, vertices, sut);
  ASSERT_EQ(sut.size(), corners.size() - 2);
  double absolute = 0.0;
  for (const auto& triangle : sut) {
    const double area = covered(vertices, {triangle});
    EXPECT_GE(area, 0.0);
    absolute += std::abs(area);
  }
  EXPECT_NEAR(absolute, 40.0 * (10.0 + 0.1) / 2.0 + 40.0, 1e-9);
}

TEST(Polygon, leaves_nothing_out_where_a_polygon_crosses_itself_or_is_flat) {
  const std::vector<Eigen::Vector3d> vertices{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 2, 0}};
  std::vector<geometry::TriangleIndices> sut;
  cut_polygon(std::vector<std::uint32_t>{0, 1, 2, 3}, vertices, sut);
  EXPECT_EQ(sut.size(), 2U);
  sut.clear();
  cut_polygon(std::vector<std::uint32_t>{0, 0, 0, 0, 0}, vertices, sut);
  EXPECT_EQ(sut.size(), 3U);
  sut.clear();
  cut_polygon(std::vector<std::uint32_t>{0, 1}, vertices, sut);
  EXPECT_TRUE(sut.empty());
}

}  // namespace
}  // namespace cellmirror
