// What meshes look like: pictures of OBJ, DAE and glTF, colours of PLY, and what is said where they cannot be had.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "config/cell_file.hpp"
#include "config/mesh_looks.hpp"
#include "config/picture_file.hpp"
#include "rt_core/cell/compiled_cell.hpp"
#include "rt_core/geometry/mesh_repair.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/config/picture_bytes.hpp"
#include "tests/unit/config/temporary_home.hpp"

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

struct MeshLooks : testing::Test {
  // The look of the only mesh of a cell.
  std::shared_ptr<const MeshLook> look_of(const std::string& mesh) {
    diagnostics = {};
    loaded =
        load_cell(home.write("cell.toml", "format = 1\nname = \"c\"\n[[node]]\nname = \"A\"\ngeometry = [{ mesh = \"" +
                                              mesh + "\" }]\n"),
                  diagnostics);
    EXPECT_TRUE(loaded) << diagnostics.text();
    return loaded ? geometry().look : nullptr;
  }
  [[nodiscard]] const Geometry& geometry() const {
    return loaded->cell.node(loaded->cell.find("A").value()).definition->geometry.at(0);
  }
  std::shared_ptr<const MeshLook> square(const std::string& picture) {
    home.write("envlib/square.obj", kSquareObj);
    home.write("envlib/square.mtl", square_mtl(picture));
    return look_of("square.obj");
  }
  [[nodiscard]] std::string finding() const {
    std::string text = diagnostics.text();
    for (std::size_t at = 0; (at = text.find(home.root().string())) != std::string::npos;)
      text.replace(at, home.root().string().size(), "HOME");
    return text;
  }
  TemporaryHome home;
  Diagnostics diagnostics;
  std::optional<LoadedCell> loaded;
};

std::vector<int> rgba_at(const Image& image, int x, int y) {
  const std::uint8_t* const p = image.pixel(x, y);
  return {p[0], p[1], p[2], p[3]};
}

TEST(PictureFile, reads_png_and_jpeg) {
  const auto png = decode_picture(four_pixels());
  ASSERT_TRUE(png) << png.error().text();
  EXPECT_EQ(png->width, 2);
  EXPECT_EQ(png->height, 2);
  EXPECT_THAT(rgba_at(*png, 0, 0), ElementsAre(255, 0, 0, 255));
  EXPECT_THAT(rgba_at(*png, 1, 0), ElementsAre(0, 255, 0, 255));
  EXPECT_THAT(rgba_at(*png, 0, 1), ElementsAre(0, 0, 255, 255));
  EXPECT_THAT(rgba_at(*png, 1, 1), ElementsAre(255, 255, 255, 128));
  const auto jpeg = decode_picture(red_jpeg());
  ASSERT_TRUE(jpeg) << jpeg.error().text();
  EXPECT_EQ(jpeg->rgba.size(), 256U);
  EXPECT_GT(jpeg->pixel(4, 4)[0], 245);
  EXPECT_LT(jpeg->pixel(4, 4)[1], 10);
  EXPECT_EQ(jpeg->pixel(4, 4)[3], 255);
}

TEST(PictureFile, refuses_what_is_damaged_too_large_or_of_another_kind) {
  const auto refusal = [](const std::string& bytes) {
    const auto sut = decode_picture(bytes);
    return sut ? "accepted" : sut.error().what;
  };
  EXPECT_EQ(refusal(""), "it is empty");
  EXPECT_EQ(refusal("GIF89a"), "it is neither PNG nor JPEG");
  EXPECT_EQ(refusal(png_of(4097, 1, std::string(std::size_t{4} * 4097, 'x'))),
            "it has 4097 x 1 pixels, more than 4096 x 4096");
  EXPECT_THAT(refusal(png_of(0x7FFF'FFFF, 0x7FFF'FFFF, "")), testing::AnyOf(HasSubstr("it has"), HasSubstr("damaged")));
  const std::string png = four_pixels();
  const std::string jpeg = red_jpeg();
  for (std::size_t length = 8; length < png.size() - 12; ++length)  // without IEND it is whole enough
    EXPECT_THAT(refusal(png.substr(0, length)), HasSubstr("it is damaged: ")) << length;
  for (std::size_t length = 3; length + 2 < jpeg.size(); length += 5)
    EXPECT_NE(refusal(jpeg.substr(0, length)), "accepted") << length;
  std::string flipped = png;
  flipped[45] = static_cast<char>(flipped[45] ^ 1);
  EXPECT_THAT(refusal(flipped), HasSubstr("it is damaged: "));
}

TEST_F(MeshLooks, obj_names_its_picture_in_a_material_file) {
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

TEST_F(MeshLooks, a_picture_may_lie_anywhere_in_the_home_and_nowhere_else) {
  home.write("robots/four.png", four_pixels());
  EXPECT_TRUE(square("../robots/four.png"));
  EXPECT_TRUE(square("..\\robots\\four.png"));
  EXPECT_EQ(square("../../four.png"), nullptr);
  EXPECT_EQ(finding(),
            "HOME/cell.toml:5:22: warning: the mesh square.obj: its picture ../../four.png (square.mtl:6): the path "
            "../../four.png leaves HOME; put the picture beside the mesh\n");
  EXPECT_EQ(square("/etc/hostname"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("the path /etc/hostname is absolute"));
  EXPECT_EQ(square("http://localhost/four.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("the picture http://localhost/four.png is not a file"));
  std::filesystem::create_symlink("/etc/hostname", home.root() / "envlib/link.png");
  EXPECT_EQ(square("link.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("its picture link.png (square.mtl:6): "));
}

TEST_F(MeshLooks, what_is_missing_or_broken_is_told_and_the_cell_loads_without) {
  EXPECT_EQ(square("four.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("warning: the mesh square.obj: its picture four.png (square.mtl:6): "));
  EXPECT_EQ(geometry().mesh->triangles.size(), 2U);
  home.write("envlib/four.png", four_pixels().substr(0, 60));
  EXPECT_EQ(square("four.png"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("its picture four.png (square.mtl:6): it is damaged: "));
  home.write("envlib/red.jpg", red_jpeg().substr(0, 150));
  EXPECT_EQ(square("red.jpg"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("its picture red.jpg (square.mtl:6): it is damaged: "));
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

TEST_F(MeshLooks, pictures_of_a_cell_are_bounded_together) {
  PictureLibrary sut;
  std::vector<Picture> held;
  const std::string bytes = png_of(64, 64, std::string(std::size_t{4} * 64 * 64, 'x'));
  for (int i = 0; i < 3; ++i) held.push_back(*sut.of_bytes(bytes));
  EXPECT_EQ(sut.bytes(), std::size_t{3} * 4 * 64 * 64);
  held.clear();
  EXPECT_EQ(sut.bytes(), 0U);
}

TEST_F(MeshLooks, gltf_holds_its_picture_itself) {
  const std::string picture = four_pixels();
  std::string buffer = tetra_buffer();
  for (const float part : {0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F}) put_float(buffer, part);
  buffer += picture;
  const std::string size = std::to_string(picture.size());
  std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[0.25,1,1,1]}}],
"textures":[{"source":0}],"images":[{"bufferView":3,"mimeType":"image/png"}],
"buffers":[{"byteLength":)" +
                     std::to_string(buffer.size()) +
                     R"(}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24},
{"buffer":0,"byteOffset":72,"byteLength":32},{"buffer":0,"byteOffset":104,"byteLength":)" +
                     size + R"(}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"},
{"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"}]})";
  while (json.size() % 4 != 0) json += ' ';
  while (buffer.size() % 4 != 0) buffer += '\0';
  std::string glb = "glTF";
  put_u32(glb, 2);
  put_u32(glb, static_cast<std::uint32_t>(28 + json.size() + buffer.size()));
  put_u32(glb, static_cast<std::uint32_t>(json.size()));
  glb += "JSON" + json;
  put_u32(glb, static_cast<std::uint32_t>(buffer.size()));
  glb += std::string("BIN\0", 4) + buffer;
  home.write("envlib/t.glb", glb);
  const auto sut = look_of("t.glb");
  ASSERT_TRUE(sut) << finding();
  const MeshMaterial& material = sut->palette[sut->materials[0]];
  ASSERT_TRUE(material.picture);
  EXPECT_THAT(rgba_at(*material.picture, 1, 0), ElementsAre(0, 255, 0, 255));
  EXPECT_NEAR(material.rgb[0], 0.5F, 1e-6F);  // a quarter of the light
  for (std::size_t i = 0; i < sut->places.size(); ++i) {
    const Eigen::Vector3d& p = geometry().mesh->vertices[geometry().mesh->triangles[i / 3][i % 3]];
    const Eigen::Vector2f wanted(p.x() + p.z() > 0 ? 1.0F : 0.0F, p.y() + p.z() > 0 ? 1.0F : 0.0F);
    EXPECT_NEAR((sut->places[i] - wanted).norm(), 0, 1e-6) << i;
  }
  std::string damaged = glb;
  damaged[damaged.find("PNG") + 40] ^= 0x55;
  home.write("envlib/bad.glb", damaged);
  EXPECT_EQ(look_of("bad.glb"), nullptr);
  EXPECT_THAT(finding(), HasSubstr("the mesh bad.glb: its picture in the file: it is damaged: "));
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
    const std::array<MeshLook::Rgba, 4> wanted{
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
