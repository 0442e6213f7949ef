// What meshes look like: pictures of OBJ and DAE, colours of PLY, and what is said where they cannot be had.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/mesh_appearance.hpp"
#include "config/mesh_file.hpp"
#include "config/mesh_library.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"
#include "tests/unit/config/mesh_appearance.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/config/picture_bytes.hpp"

namespace cellmirror {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A square with its picture upright: v goes up in OBJ, and down from the upper edge in a look.
constexpr const char* kSquareObj = R"(mtllib square.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 0.75
usemtl paint
f 1/1 2/2 3/3 4/4
)";

std::string square_mtl(const std::string& picture) {
  return "# a comment\nnewmtl other\nmap_Kd nowhere.png\nnewmtl paint\nKd 0.1 0.2 0.3\nmap_Kd " + picture + "\n";
}

struct MeshLooksOfObj : MeshLooks {
  std::shared_ptr<const MeshAppearance> square(const std::string& picture) {
    home.write("envlib/square.obj", kSquareObj);
    home.write("envlib/square.mtl", square_mtl(picture));
    return look_of("square.obj");
  }
};

TEST_F(MeshLooksOfObj, obj_names_its_picture_in_a_material_file) {
  home.write("envlib/pictures/four.png", four_pixels());
  const auto sut = square("-s 1 1 1 -clamp on pictures/four.png");
  ASSERT_TRUE(sut) << finding();
  EXPECT_EQ(finding(), "");
  ASSERT_EQ(sut->materials.size(), 2U);
  const MeshMaterial& material = sut->palette[sut->materials[0]];
  ASSERT_TRUE(material.picture);
  EXPECT_EQ(material.picture->width, 2);
  EXPECT_THAT(material.rgb, ElementsAre(1, 1, 1));  // the picture stands for Kd
  for (std::size_t i = 0; i < sut->places.size(); ++i) {
    const Eigen::Vector3d& p = geometry().mesh->vertices[geometry().mesh->triangles[i / 3][i % 3]];
    const bool fourth = p.x() == 0 && p.y() == 1;
    EXPECT_EQ(sut->places[i],
              Eigen::Vector2f(static_cast<float>(p.x()), fourth ? 0.25F : static_cast<float>(1 - p.y())));
  }
}

TEST_F(MeshLooksOfObj, a_picture_may_lie_anywhere_in_the_home_and_nowhere_else) {
  home.write("robots/four.png", four_pixels());
  EXPECT_TRUE(square("../robots/four.png"));
  EXPECT_TRUE(square("..\\robots\\four.png"));
  EXPECT_EQ(square("../../four.png"), nullptr);
  EXPECT_EQ(finding(),
            "HOME/cell.toml:5:22: warning: the mesh square.obj: its texture ../../four.png (square.mtl:6): the path "
            "../../four.png leaves HOME; put the picture beside the mesh\n");
  EXPECT_EQ(square("/etc/hostname"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("the path /etc/hostname is absolute"));
  EXPECT_EQ(square("http://localhost/four.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("the picture http://localhost/four.png is not a file"));
  std::filesystem::create_symlink("/etc/hostname", home.root() / "envlib/link.png");
  EXPECT_EQ(square("link.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("its texture link.png (square.mtl:6): "));
}

TEST_F(MeshLooksOfObj, what_is_missing_or_broken_is_told_and_the_cell_loads_without) {
  EXPECT_EQ(square("four.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("warning: the mesh square.obj: its texture four.png (square.mtl:6): "));
  EXPECT_EQ(geometry().mesh->triangles.size(), 2U);
  home.write("envlib/four.png", four_pixels().substr(0, 60));
  EXPECT_EQ(square("four.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("its texture four.png (square.mtl:6): it is damaged: "));
  home.write("envlib/red.jpg", red_jpeg().substr(0, 150));
  EXPECT_EQ(square("red.jpg"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("its texture red.jpg (square.mtl:6): it is damaged: "));
  home.write("envlib/large.png", png_of(4097, 1, std::string(std::size_t{4} * 4097, 'x')));
  EXPECT_EQ(square("large.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("it has 4097 x 1 pixels, more than 4096 x 4096; make it smaller\n"));
  home.write("envlib/square.obj", kSquareObj);
  std::filesystem::remove(home.root() / "envlib/square.mtl");
  EXPECT_EQ(look_of("square.obj"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("warning: the mesh square.obj: its materials: "));
}

TEST_F(MeshLooks, meshes_share_a_picture_and_the_shape_does_not_grow) {
  home.write("envlib/four.png", four_pixels());
  home.write("envlib/square.obj", kSquareObj);
  home.write("envlib/square.mtl", square_mtl("four.png"));
  home.write("envlib/again.obj", kSquareObj);
  loaded = load_cell(
      home.write("cell.toml",
                 "format = 1\nname = \"c\"\n[[node]]\nname = \"A\"\ngeometry = [{ mesh = \"square.obj\" }, { mesh = "
                 "\"again.obj\" }, { mesh = \"square.obj\" }, { mesh = \"square.obj\", scale = [2, 2, 2] }]\n"),
      diagnostics);
  ASSERT_TRUE(loaded) << finding();
  const auto& all = loaded->cell.node(loaded->cell.find("A").value()).definition->geometry;
  const auto picture = [&](std::size_t i) { return all[i].look->palette[all[i].look->materials[0]].picture; };
  EXPECT_EQ(all[0].look, all[2].look);
  EXPECT_NE(all[0].look, all[1].look);
  EXPECT_EQ(picture(0), picture(1));
  EXPECT_EQ(picture(0), picture(3));
  EXPECT_EQ(all[0].mesh->vertices.size(), 4U);
}

TEST(MeshLooksOfMaterials, a_picture_that_many_name_is_asked_for_once_and_told_once) {
  std::string mtl;
  std::string obj = "mtllib all.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\n";
  for (const std::string name : {"a", "b", "c"}) {
    mtl += "newmtl " + name + "\nmap_Kd four.png\n";
    obj += "usemtl " + name + "\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n";
  }
  const auto read = [&](const Result<Picture>& answer) {
    int asked = 0;
    AppearanceRequest looks;
    looks.text = [&](const std::string&) { return Result<std::string>(mtl); };
    looks.picture = [&](const std::string&) { return ++asked, answer; };
    geometry::MeshFindings findings;
    EXPECT_TRUE(parse_mesh(obj, ".obj", "all.obj", Eigen::Vector3d::Ones(), {}, findings, &looks));
    EXPECT_EQ(asked, 1);
    return looks;
  };
  const Picture picture = std::make_shared<const Image>();
  const AppearanceRequest good = read(picture);
  ASSERT_TRUE(good.look);
  EXPECT_EQ(std::ranges::count(good.look->palette, picture, &MeshMaterial::picture), 3);
  const AppearanceRequest bad = read(fail("it is damaged"));
  ASSERT_EQ(bad.left_out.size(), 1U);
  EXPECT_EQ(bad.left_out[0].what, "its texture four.png (all.mtl:2): it is damaged");
}

TEST_F(MeshLooks, a_picture_that_was_mended_is_found_when_its_mesh_is_read_again) {
  home.write("envlib/square.obj", kSquareObj);
  home.write("envlib/square.mtl", square_mtl("four.png"));
  MeshLibrary sut;
  const auto has_look = [&] {
    const std::filesystem::path folder = home.root() / "envlib";
    const auto beside = [&](const std::string& picture) { return Result<std::filesystem::path>(folder / picture); };
    return sut.mesh(folder / "square.obj", Eigen::Vector3d::Ones(), CollideAs::exact, beside, {}, diagnostics)->look !=
           nullptr;
  };
  home.write("envlib/four.png", "GIF89a");
  EXPECT_FALSE(has_look());
  home.write("envlib/four.png", four_pixels());
  EXPECT_TRUE(has_look());
}

TEST_F(MeshLooks, a_mesh_whose_look_nobody_kept_is_read_again) {
  home.write("envlib/square.obj", kSquareObj);
  home.write("envlib/square.mtl", square_mtl("four.png"));
  home.write("envlib/four.png", four_pixels());
  home.write("envlib/l.obj", kLObj);
  MeshLibrary sut;
  int readings = 0;
  sut.set_progress([&](const std::filesystem::path&) { ++readings; });
  const auto mesh = [&](const std::string& name) {
    const std::filesystem::path folder = home.root() / "envlib";
    return sut.mesh(
        folder / name, Eigen::Vector3d::Ones(), CollideAs::exact,
        [&](const std::string& picture) { return Result<std::filesystem::path>(folder / picture); }, {}, diagnostics);
  };
  const auto shape = mesh("square.obj")->mesh;
  const auto again = mesh("square.obj");
  EXPECT_TRUE(again->look);
  EXPECT_EQ(mesh("square.obj")->look, again->look);
  EXPECT_EQ(readings, 2);
  const auto without_look = mesh("l.obj")->mesh;
  EXPECT_EQ(mesh("l.obj")->mesh, without_look);
  EXPECT_EQ(readings, 3);
}

TEST_F(MeshLooks, dae_names_its_picture) {
  std::string dae = tetra_dae("Z_UP");
  const auto put = [&](const std::string& before, const std::string& text) { dae.insert(dae.find(before), text); };
  put("<library_geometries>", R"(<library_images><image id="i"><init_from>four%20pixels.png</init_from></image>
</library_images><library_effects><effect id="e"><profile_COMMON>
<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>
<technique sid="c"><lambert><diffuse><texture texture="t" texcoord="UV"/></diffuse></lambert></technique>
</profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>)");
  put("<vertices", R"(<source id="u"><float_array id="ua" count="2">0.25 0.75</float_array><technique_common>
<accessor source="#ua" count="1" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor>
</technique_common></source>)");
  put("<p>", R"(<input semantic="TEXCOORD" source="#u" offset="1" set="0"/>)");
  dae.replace(dae.find("<triangles "), 11, R"(<triangles material="skin" )");
  dae.replace(dae.find("0 2 1 0 1 3 0 3 2 1 2 3"), 23, "0 0 2 0 1 0 0 0 1 0 3 0 0 0 3 0 2 0 1 0 2 0 3 0");
  const std::string show = R"(<instance_geometry url="#g"/>)";
  dae.replace(dae.find(show), show.size(), R"(<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="skin" target="#m"><bind_vertex_input semantic="UV" input_semantic="TEXCOORD"
input_set="0"/></instance_material></technique_common></bind_material></instance_geometry>)");
  home.write("envlib/t.dae", dae);
  home.write("envlib/four pixels.png", four_pixels());
  const auto sut = look_of("t.dae");
  ASSERT_TRUE(sut) << finding();
  EXPECT_TRUE(sut->palette[sut->materials[0]].picture);
  EXPECT_EQ(sut->places[0], Eigen::Vector2f(0.25F, 0.25F));
}

TEST_F(MeshLooks, ply_has_colours_at_its_corners) {
  std::string ply = kTetraPly;
  ply.insert(ply.find("element face"), "property uchar red\nproperty uchar green\nproperty uchar blue\n");
  ply.replace(ply.find("0 0 0\n"), 6, "0 0 0 255 0 10\n");
  ply.replace(ply.find("1 0 0\n"), 6, "1 0 0 0 255 10\n");
  ply.replace(ply.find("0 1 0\n"), 6, "0 1 0 0 0 255\n");
  ply.replace(ply.find("0 0 1\n"), 6, "0 0 1 9 9 9\n");
  home.write("envlib/t.ply", ply);
  const auto sut = look_of("t.ply");
  ASSERT_TRUE(sut) << finding();
  ASSERT_EQ(sut->colours.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) {
    const Eigen::Vector3d& p = geometry().mesh->vertices[geometry().mesh->triangles[i / 3][i % 3]];
    const std::array<MeshAppearance::Rgba, 4> wanted{
        {{255, 0, 10, 255}, {0, 255, 10, 255}, {0, 0, 255, 255}, {9, 9, 9, 255}}};
    EXPECT_EQ(sut->colours[i], wanted[static_cast<std::size_t>(p.x() + 2 * p.y() + 3 * p.z())]);
  }
  EXPECT_THAT(sut->palette[sut->materials[0]].rgb, ElementsAre(1, 1, 1));
}

TEST_F(MeshLooks, shapes_alone_have_none) {
  home.write("envlib/t.stl", tetra_stl());
  home.write("envlib/l.obj", kLObj);
  for (const char* mesh : {"t.stl", "l.obj"}) {
    EXPECT_EQ(look_of(mesh), nullptr);
    EXPECT_EQ(finding(), "");
  }
}

TEST_F(MeshLooks, repaired_triangles_keep_their_places) {
  // A closed box of which a face is turned, stands twice, and is cut by a flat triangle; u is x, v is y.
  std::string obj = "mtllib square.mtl\n";
  for (const char* z : {"0", "1"}) {
    for (const char* xy : {"0 0", "1 0", "1 1", "0 1"})
      obj += "v " + std::string(xy) + " " + z + "\nvt " + std::string(xy) + "\n";
  }
  obj += "v 0.5 0 1\nvt 0.5 0\nusemtl paint\n";
  for (const char* face :
       {"4 3 2 1", "5 6 7", "5 8 7", "5 8 7", "5 9 6", "1 2 6 9 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"}) {
    obj += "f";
    for (const char corner : std::string_view(face)) {
      if (corner != ' ') obj += std::string(" ") + corner + "/" + corner;
    }
    obj += "\n";
  }
  home.write("envlib/box.obj", obj);
  home.write("envlib/square.mtl", square_mtl("four.png"));
  home.write("envlib/four.png", four_pixels());
  const auto sut = look_of("box.obj");
  ASSERT_TRUE(sut) << finding();
  EXPECT_TRUE(geometry().mesh->closed) << finding();
  ASSERT_EQ(sut->places.size(), 3 * geometry().mesh->triangles.size());
  for (std::size_t i = 0; i < sut->places.size(); ++i) {
    const Eigen::Vector3d& p = geometry().mesh->vertices[geometry().mesh->triangles[i / 3][i % 3]];
    EXPECT_NEAR(sut->places[i].x(), p.x(), 1e-6);
    EXPECT_NEAR(sut->places[i].y(), 1 - p.y(), 1e-6);
  }
}

}  // namespace
}  // namespace cellmirror
