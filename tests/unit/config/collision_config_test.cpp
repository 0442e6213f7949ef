// Meshes, collision rules and sensors in cell files.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "config/cell_file.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/config/temporary_home.hpp"

namespace cellmirror {
namespace {

struct CollisionConfig : testing::Test {
  CollisionConfig() {
    home.write("envlib/tetra.stl", tetra_stl());
    home.write("envlib/l.obj", kLObj);
  }
  std::optional<LoadedCell> load(const std::string& text) { return load_text("format = 1\nname = \"c\"\n" + text); }
  std::optional<LoadedCell> load_text(const std::string& text) {
    diagnostics = {};
    return load_cell(home.write("cell.toml", text), diagnostics);
  }
  [[nodiscard]] std::string finding() const {
    const std::string text = diagnostics.text();
    const std::string folder = home.root().string() + "/";
    return text.starts_with(folder) ? text.substr(folder.size()) : text;
  }
  static const std::vector<Geometry>& geometry(const LoadedCell& loaded, std::string_view path) {
    return loaded.cell.node(loaded.cell.find(path).value()).definition->geometry;
  }
  TemporaryHome home;
  Diagnostics diagnostics;
};

TEST_F(CollisionConfig, reads_each_mesh_once_a_scale) {
  const auto sut = load(R"(
[[node]]
name = "A"
geometry = [{ mesh = "tetra.stl" }, { mesh = "tetra.stl", xyz_m = [2, 0, 0] }]
[[node]]
name = "B"
geometry = [{ mesh = "tetra.stl" }, { mesh = "tetra.stl", scale = [2, 2, 2] }]
)");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(diagnostics.text(), "");
  const auto& a = geometry(*sut, "A");
  const auto& b = geometry(*sut, "B");
  ASSERT_TRUE(a[0].mesh);
  EXPECT_EQ(a[0].mesh->name, "tetra.stl");
  EXPECT_EQ(a[0].mesh, a[1].mesh);
  EXPECT_EQ(a[0].mesh, b[0].mesh);
  ASSERT_TRUE(b[1].mesh);
  EXPECT_NEAR(geometry::signed_volume(*b[1].mesh), 8.0 / 6.0, 1e-12);
  EXPECT_EQ(a[0].collide_as, CollideAs::exact);
  EXPECT_TRUE(a[0].pieces.empty());
}

TEST_F(CollisionConfig, loads_without_a_mesh_that_is_only_drawn_and_cannot_be_read) {
  home.write("envlib/broken.stl", "solid but not STL\n");
  const auto sut = load(
      "[[node]]\nname = \"A\"\ngeometry = [\n{ mesh = \"broken.stl\", collides = false },\n"
      "{ mesh = \"l.obj\", collides = false, collide_as = \"hull\" }]\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(finding(), "cell.toml:6:10: warning: the mesh broken.stl is refused: it has no facets; it is not drawn\n");
  EXPECT_EQ(geometry(*sut, "A")[0].mesh, nullptr);
  EXPECT_NE(geometry(*sut, "A")[1].mesh, nullptr);
  EXPECT_TRUE(geometry(*sut, "A")[1].pieces.empty());
}

TEST_F(CollisionConfig, refuses_a_bad_mesh_where_it_is_named) {
  home.write("envlib/broken.stl", "solid but not STL\n");
  home.write("envlib/part.mpc", "format = 1\ngeometry = [\n  { mesh = \"broken.stl\" },\n]\n");
  EXPECT_FALSE(load("[[node]]\nname = \"A\"\nabstract = \"part.mpc\"\n"));
  EXPECT_EQ(finding(), "envlib/part.mpc:3:12: error: geometry 1: the mesh broken.stl is refused: it has no facets\n");
  home.write(
      "robots/r.urdf",
      "<robot name=\"r\">\n<link name=\"base\">\n<collision><geometry>\n<mesh filename=\"../envlib/broken.stl\"/>\n"
      "</geometry></collision></link></robot>");
  EXPECT_FALSE(load("[[node]]\nname = \"A\"\nabstract = \"r.urdf\"\n"));
  EXPECT_EQ(finding(), "robots/r.urdf:4: error: <mesh>: the mesh broken.stl is refused: it has no facets\n");
}

TEST_F(CollisionConfig, tells_what_was_repaired) {
  std::string obj = kLObj;
  obj += "f 1 2 8 7\nf 1 1 2\n";
  home.write("envlib/twice.obj", obj);
  const auto sut = load("geometry = [\n{ mesh = \"twice.obj\" }, { mesh = \"twice.obj\" }]\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(finding(),
            "cell.toml:4:10: note: the mesh twice.obj: 1 triangle has no area, 2 triangles appear twice; it was "
            "repaired while reading\n");
}

TEST_F(CollisionConfig, makes_hulls_and_parts_where_the_file_says_so) {
  const auto sut = load(R"(
[[node]]
name = "H"
geometry = [{ mesh = "l.obj", collide_as = "hull" }, { mesh = "l.obj", collide_as = "hull" }]
[[node]]
name = "P"
geometry = [{ mesh = "l.obj", collide_as = "parts" }]
)");
  ASSERT_TRUE(sut) << diagnostics.text();
  const auto& hull = geometry(*sut, "H");
  EXPECT_EQ(hull[0].collide_as, CollideAs::hull);
  ASSERT_EQ(hull[0].pieces.size(), 1U);
  EXPECT_TRUE(hull[0].pieces[0]->convex);
  EXPECT_NEAR(geometry::signed_volume(*hull[0].pieces[0]), 3.5, 1e-9);
  EXPECT_EQ(hull[0].pieces, hull[1].pieces);
  const auto& parts = geometry(*sut, "P")[0];
  EXPECT_EQ(parts.collide_as, CollideAs::parts);
  EXPECT_EQ(parts.mesh, hull[0].mesh);
  ASSERT_EQ(parts.pieces.size(), 2U);
  EXPECT_NEAR(geometry::signed_volume(*parts.pieces[0]) + geometry::signed_volume(*parts.pieces[1]), 3.0, 1e-9);
}

TEST_F(CollisionConfig, takes_collide_as_of_a_node_for_the_meshes_of_its_component) {
  home.write("envlib/part.mpc",
             "format = 1\ngeometry = [{ mesh = \"l.obj\" }, { mesh = \"l.obj\", collide_as = \"exact\" }]\n");
  home.write("robots/r.urdf",
             "<robot name=\"r\"><link name=\"base\"><collision><geometry><mesh filename=\"../envlib/l.obj\"/>"
             "</geometry></collision></link></robot>");
  const auto sut = load(R"(
[[node]]
name = "A"
abstract = "part.mpc"
collide_as = "hull"
[[node]]
name = "B"
abstract = "part.mpc"
[[node]]
name = "C"
abstract = "r.urdf"
collide_as = "hull"
)");
  ASSERT_TRUE(sut) << diagnostics.text();
  const auto content = [&](const char* path) { return sut->cell.node(sut->cell.find(path).value()).content; };
  EXPECT_EQ(content("A")->geometry[0].collide_as, CollideAs::hull);
  EXPECT_EQ(content("A")->geometry[1].collide_as, CollideAs::exact);
  EXPECT_EQ(content("B")->geometry[0].collide_as, CollideAs::exact);
  EXPECT_EQ(content("A")->geometry[0].mesh, content("B")->geometry[0].mesh);
  EXPECT_EQ(geometry(*sut, "C.base")[0].collide_as, CollideAs::hull);
  EXPECT_EQ(geometry(*sut, "C.base")[0].pieces, content("A")->geometry[0].pieces);
  EXPECT_EQ(sut->files.size(), 3U);
}

TEST_F(CollisionConfig, refuses_collide_as_where_it_means_nothing) {
  EXPECT_FALSE(
      load("geometry = [{ sphere_m = 1, collide_as = \"hull\" }]\n[[node]]\nname = \"A\"\ncollide_as = \"hul\"\n"));
  EXPECT_EQ(diagnostics.errors(), 3U) << diagnostics.text();
  EXPECT_NE(diagnostics.text().find("collide_as belongs to a mesh only"), std::string::npos);
  EXPECT_NE(diagnostics.text().find("collide_as belongs to a node with an ABSTRACT file"), std::string::npos);
}

TEST_F(CollisionConfig, a_flat_mesh_has_no_hull) {
  home.write("envlib/sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_FALSE(load("geometry = [{ mesh = \"sheet.obj\", collide_as = \"hull\" }]\n"));
  EXPECT_NE(diagnostics.text().find("sheet.obj is flat and has no convex hull"), std::string::npos)
      << diagnostics.text();
}

TEST_F(CollisionConfig, reads_meshes_of_components_that_are_loaded_later_and_frees_them) {
  home.write("envlib/part.mpc", "format = 1\ngeometry = [{ mesh = \"l.obj\", collide_as = \"parts\" }]\n");
  auto sut = load("[[node]]\nname = \"A\"\nabstract = \"part.mpc\"\nshown = \"hidden\"\nloaded = false\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  std::weak_ptr<const geometry::TriangleMesh> mesh;
  std::weak_ptr<const geometry::TriangleMesh> piece;
  for (int round = 0; round < 2; ++round) {
    ASSERT_TRUE(sut->cell.activate("A"));
    const auto content = sut->cell.node(sut->cell.find("A").value()).content;
    mesh = content->geometry[0].mesh;
    piece = content->geometry[0].pieces.at(0);
    EXPECT_FALSE(mesh.expired());
  }
  ASSERT_TRUE(sut->cell.delete_node("A"));
  static_cast<void>(sut->cell.compile());  // the picture held them as well
  EXPECT_TRUE(mesh.expired());
  EXPECT_TRUE(piece.expired());
  home.write("envlib/l.obj", "nonsense");
  EXPECT_FALSE(sut->cell.activate("A"));
  home.write("envlib/l.obj", kLObj);
  EXPECT_TRUE(sut->cell.activate("A"));
}

TEST_F(CollisionConfig, tells_progress) {
  home.write("envlib/part.mpc", "format = 1\ngeometry = [{ mesh = \"l.obj\" }, { mesh = \"tetra.stl\" }]\n");
  std::vector<std::string> told;
  const auto sut = load_cell(
      home.write("cell.toml",
                 "format = 1\nname = \"c\"\ngeometry = [{ mesh = \"tetra.stl\" }]\n[[node]]\nname = \"A\"\nabstract = "
                 "\"part.mpc\"\n"),
      diagnostics, [&](std::size_t done, std::size_t total, std::string_view what) {
        told.push_back(std::to_string(done) + "/" + std::to_string(total) + " " + std::string(what));
      });
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(told, (std::vector<std::string>{"0/3 tetra.stl", "1/3 part.mpc", "2/3 l.obj"}));
}

constexpr const char* kNodes = R"(
[[node]]
name = "A"
[[node]]
name = "B"
parent = "A"
[[node]]
name = "C"
abstract = "part.mpc"
shown = "hidden"
loaded = false
)";

TEST_F(CollisionConfig, reads_rules_with_full_paths_ignore_before_test) {
  home.write("envlib/part.mpc", "format = 1\n[[node]]\nname = \"D\"\n");
  const auto sut = load(std::string(kNodes) + R"(
[collision]
active = false
warning_distance_m = 0.2
test = [{ a = "A.B", b = "C" }]
ignore = [{ a = "B", b = "C.D", reason = "guarded" }, { a = "", b = "C" }]
)");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_FALSE(sut->collision.active);
  EXPECT_EQ(sut->collision.warning_distance_m, 0.2);
  ASSERT_EQ(sut->collision.rules.size(), 3U);
  using collision::PairRule;
  EXPECT_EQ(sut->collision.rules[0].kind, PairRule::Kind::ignore);
  EXPECT_EQ(sut->collision.rules[0].a, "A.B");
  EXPECT_EQ(sut->collision.rules[0].b, "C.D");
  EXPECT_EQ(sut->collision.rules[0].reason, "guarded");
  EXPECT_EQ(sut->collision.rules[1].a, "");
  EXPECT_EQ(sut->collision.rules[2].kind, PairRule::Kind::test);
}

TEST_F(CollisionConfig, a_rule_can_be_about_the_cells_own_geometry) {
  const std::string cell = R"(format = 1
name = "bench"
geometry = [{ box_m = [1.0, 1.0, 0.1] }]
[[node]]
name = "A"
[[node]]
name = "bench"
parent = "A"
)";
  const auto sut = load_text(cell + "[collision]\nignore = [{ a = \"bench\", b = \"A.bench\" }]\n");
  ASSERT_TRUE(sut) << diagnostics.text();
  EXPECT_EQ(sut->collision.rules.at(0).a, "bench");
  EXPECT_EQ(sut->collision.rules.at(0).b, "A.bench");
  EXPECT_EQ(sut->cell.compile()->name, "bench");
}

TEST_F(CollisionConfig, refuses_a_node_with_the_name_of_a_cell_that_has_geometry) {
  const std::string cell = "format = 1\nname = \"bench\"\n";
  const std::string node = "[[node]]\nname = \"bench\"\n";
  EXPECT_TRUE(load_text(cell + node)) << diagnostics.text();
  EXPECT_FALSE(load_text(cell + "geometry = [{ box_m = [1.0, 1.0, 0.1] }]\n" + node));
  EXPECT_NE(diagnostics.text().find("the node bench has the name of the cell"), std::string::npos)
      << diagnostics.text();
}

TEST_F(CollisionConfig, has_settings_without_a_table) {
  const auto sut = load("");
  ASSERT_TRUE(sut);
  EXPECT_TRUE(sut->collision.active);
  EXPECT_EQ(sut->collision.warning_distance_m, 0.05);
  EXPECT_TRUE(sut->collision.rules.empty());
}

TEST_F(CollisionConfig, refuses_rules_about_nothing) {
  home.write("envlib/part.mpc", "format = 1\n");
  EXPECT_FALSE(load(std::string(kNodes) + R"(
[collision]
ignore = [
  { a = "A", b = "Bb" },
  { a = "A.X", b = "B" },
  { a = "C.any.thing", b = "B" },
]
)"));
  EXPECT_EQ(diagnostics.errors(), 2U) << diagnostics.text();
  EXPECT_NE(finding().find("cell.toml:17:18: error: "), std::string::npos) << diagnostics.text();
  EXPECT_NE(finding().find("cell.toml:18:9: error: "), std::string::npos) << diagnostics.text();
}

TEST_F(CollisionConfig, refuses_faulty_rules) {
  EXPECT_FALSE(load("[collision]\nwarning_distance_m = -1\nspeed = 3\nignore = [{ a = \"A\" }]\n"));
  EXPECT_EQ(diagnostics.errors(), 3U) << diagnostics.text();
}

TEST_F(CollisionConfig, reads_sensors_with_their_beam) {
  const auto sut = load(R"(
[[node]]
name = "S"
type = "sensor"
sensor = { range_m = 2, half_angle_rad = 0.2, blind_zone_m = 0.05, active = true, max_incidence_rad = 0.6, noise_m = 0.002, seed = 42 }
[[node]]
name = "T"
type = "sensor"
)");
  ASSERT_TRUE(sut) << diagnostics.text();
  const auto sensor = [&](const char* path) { return sut->cell.node(sut->cell.find(path).value()).sensor; };
  EXPECT_TRUE(sensor("S").active);
  EXPECT_EQ(sensor("S").max_incidence_rad, 0.6);
  EXPECT_EQ(sensor("S").noise_m, 0.002);
  EXPECT_EQ(sensor("S").seed, 42U);
  EXPECT_FALSE(sensor("T").active);
  EXPECT_EQ(sensor("T").noise_m, 0.0);
}

TEST_F(CollisionConfig, refuses_impossible_sensors) {
  for (const char* bad : {"range_m = 0", "half_angle_rad = 0", "half_angle_rad = 1.5707963267948966",
                          "blind_zone_m = 3", "max_incidence_rad = 1.6", "noise_m = -0.1", "seed = -1", "active = 1"}) {
    EXPECT_FALSE(load(std::string("[[node]]\nname = \"S\"\ntype = \"sensor\"\nsensor = { ") + bad + " }\n")) << bad;
    EXPECT_EQ(diagnostics.errors(), 1U) << diagnostics.text();
  }
}

// Which of the real robots' meshes are solids. Told in the log of the test, since a new robot may well have open ones.
TEST(RealRobots, every_mesh_that_collides_is_read) {
  const char* set = std::getenv("CELLMIRROR_SHARED_DATA");
  const char* source = std::getenv("CELLMIRROR_SOURCE_DIR");
  const std::filesystem::path robots =
      std::filesystem::path(set != nullptr      ? set
                            : source != nullptr ? std::string(source) + "/../shared/data"
                                                : "") /
      "robots";
  if (!std::filesystem::is_directory(robots)) GTEST_SKIP() << "skipped: no shared data at " << robots;
  std::size_t meshes = 0;
  std::size_t closed = 0;
  for (const auto& entry : std::filesystem::directory_iterator(robots)) {
    const std::string name = entry.path().filename().string();
    const std::filesystem::path urdf = entry.path() / (name + ".urdf");
    if (!std::filesystem::exists(urdf)) continue;
    TemporaryHome home;
    std::filesystem::copy(entry.path(), home.root() / "robots" / name, std::filesystem::copy_options::recursive);
    Diagnostics diagnostics;
    const auto sut =
        load_cell(home.write("cell.toml", "format = 1\nname = \"c\"\n[[node]]\nname = \"R\"\nabstract = \"" + name +
                                              "/" + name + ".urdf\"\n"),
                  diagnostics);
    ASSERT_TRUE(sut) << diagnostics.text();
    EXPECT_EQ(diagnostics.warnings(), 0U) << diagnostics.text();
    const auto content = sut->cell.node(sut->cell.find("R").value()).content;
    std::string open;
    std::size_t triangles = 0;
    for (const ComponentNode& node : content->nodes) {
      for (const Geometry& geometry : node.geometry) {
        if (geometry.shape != Shape::mesh || !geometry.collides) continue;
        ASSERT_TRUE(geometry.mesh) << name << " " << node.name;
        ++meshes;
        triangles += geometry.mesh->triangles.size();
        if (geometry.mesh->closed) ++closed;
        if (!geometry.mesh->closed) open += " " + geometry.mesh->name;
      }
    }
    std::printf("%s: %zu triangles, open:%s\n", name.c_str(), triangles, open.empty() ? " none" : open.c_str());
  }
  EXPECT_GT(meshes, 20U);
  std::printf("%zu of %zu meshes are closed\n", closed, meshes);
}

}  // namespace
}  // namespace cellmirror
