// What glTF gives a mesh to look like: pictures in the file and beside it, and light that is linear.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "config/mesh_appearance.hpp"
#include "config/mesh_file.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"
#include "tests/unit/config/mesh_appearance.hpp"
#include "tests/unit/config/mesh_text.hpp"
#include "tests/unit/config/picture_bytes.hpp"

namespace cellmirror {
namespace {

using testing::HasSubstr;

// Tetrahedra one above the other, each of one material. Beside bufferView 3, the picture, 4 has colours, as accessor 3.
struct Gltf {
  std::string attributes = R"("POSITION":0,"TEXCOORD_0":2)";
  std::vector<int> shown{0};  // the material of each tetrahedron
  std::string materials = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[0.25,1,1,1]}})";
  std::string textures = R"({"source":0})";
  std::string images = R"({"bufferView":3,"mimeType":"image/png"})";
  std::string picture = four_pixels();

  [[nodiscard]] std::string buffer() const {
    std::string out = tetra_buffer();
    for (const float part : {0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 1.0F, 1.0F, 1.0F}) put_float(out, part);
    for (const float part : {0.25F, 1.0F, 0.0F, 0.5F, 0.5F, 0.5F, 1.0F, 1.0F, 1.0F, 0.0F, 0.0F, 0.0F})
      put_float(out, part);
    return out + picture;
  }
  // `uri`: a member of the buffer, as tetra_gltf() has it.
  [[nodiscard]] std::string json(const std::string& uri) const {
    std::string roots;
    std::string nodes;
    std::string meshes;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const std::string comma = i == 0 ? "" : ",";
      const std::string number = std::to_string(i);
      roots += comma + number;
      nodes += comma + R"({"mesh":)" + number + R"(,"translation":[0,0,)" + std::to_string(5 * i) + "]}";
      meshes += comma + R"({"primitives":[{"attributes":{)" + attributes + R"(},"indices":1,"material":)" +
                std::to_string(shown[i]) + "}]}";
    }
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
           R"(],"meshes":[)" + meshes + R"(],"materials":[)" + materials + R"(],"textures":[)" + textures +
           R"(],"images":[)" + images + R"(],"buffers":[{)" + uri + R"("byteLength":)" +
           std::to_string(buffer().size()) + R"(}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24},
{"buffer":0,"byteOffset":72,"byteLength":32},{"buffer":0,"byteOffset":152,"byteLength":)" +
           std::to_string(picture.size()) + R"(},{"buffer":0,"byteOffset":104,"byteLength":48}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"},
{"bufferView":2,"componentType":5126,"count":4,"type":"VEC2"},
{"bufferView":4,"componentType":5126,"count":4,"type":"VEC3"}]})";
  }
  [[nodiscard]] std::string glb() const { return glb_of(json(""), buffer()); }
};

struct MeshLooksOfGltf : MeshLooks {
  std::shared_ptr<const MeshAppearance> look_of(const std::string& file, const Gltf& gltf) {
    const bool binary = file.ends_with(".glb");
    home.write("envlib/t.bin", gltf.buffer());
    home.write("envlib/" + file, binary ? gltf.glb() : gltf.json(R"("uri":"t.bin",)"));
    return MeshLooks::look_of(file);
  }
};

TEST_F(MeshLooksOfGltf, a_picture_in_the_file) {
  Gltf gltf;
  const auto sut = look_of("t.glb", gltf);
  ASSERT_TRUE(sut) << finding();
  const MeshMaterial& material = sut->palette[sut->materials[0]];
  ASSERT_TRUE(material.picture);
  EXPECT_EQ(material.picture->pixel(1, 0)[1], 255);
  EXPECT_NEAR(material.rgb[0], 0.5F, 1e-6F);  // a quarter of the light
  for (std::size_t i = 0; i < sut->places.size(); ++i) {
    const Eigen::Vector3d& p = geometry().mesh->vertices[geometry().mesh->triangles[i / 3][i % 3]];
    const Eigen::Vector2f wanted(p.x() + p.z() > 0 ? 1.0F : 0.0F, p.y() + p.z() > 0 ? 1.0F : 0.0F);
    EXPECT_NEAR((sut->places[i] - wanted).norm(), 0, 1e-6) << i;
  }
  gltf.picture[40] ^= 0x55;
  EXPECT_EQ(look_of("bad.glb", gltf), nullptr);
  EXPECT_THAT(finding(), HasSubstr("the mesh bad.glb: its texture in the file: it is damaged: "));
}

TEST_F(MeshLooksOfGltf, a_picture_in_the_file_is_decoded_once_for_all_materials_and_not_for_those_that_nothing_shows) {
  Gltf gltf;
  const std::string with_second = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}})";
  const std::string unused = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":2}}})";
  gltf.materials += "," + with_second + "," + unused;
  gltf.textures = R"({"source":0},{"source":0},{"source":1})";
  gltf.images += R"(,{"bufferView":4,"mimeType":"image/png"})";
  gltf.shown = {0, 1, 0};
  int asked = 0;
  PictureLibrary pictures;
  AppearanceRequest looks;
  looks.embedded = [&](std::string_view bytes) { return ++asked, pictures.of_bytes(bytes); };
  geometry::MeshFindings findings;
  const auto mesh = parse_mesh(gltf.glb(), ".glb", "t.glb", Eigen::Vector3d::Ones(), {}, findings, &looks);
  ASSERT_TRUE(mesh) << mesh.error().what;
  ASSERT_TRUE(looks.look);
  EXPECT_EQ(asked, 1);
  EXPECT_TRUE(looks.left_out.empty());
  const auto& palette = looks.look->palette;
  EXPECT_TRUE(palette.at(0).picture);
  EXPECT_EQ(palette.at(0).picture, palette.at(1).picture);
  EXPECT_EQ(palette.at(2).picture, nullptr);
  EXPECT_EQ(pictures.bytes(), 16U);
}

TEST_F(MeshLooksOfGltf, colours_of_corners_are_linear_light) {
  Gltf gltf;
  gltf.attributes = R"("POSITION":0,"COLOR_0":3)";
  const auto sut = look_of("t.glb", gltf);
  ASSERT_TRUE(sut) << finding();
  ASSERT_EQ(sut->colours.size(), 12U);
  const std::array<MeshAppearance::Rgba, 4> wanted{
      {{128, 255, 0, 255}, {180, 180, 180, 255}, {255, 255, 255, 255}, {0, 0, 0, 255}}};
  for (std::size_t i = 0; i < 12; ++i) {
    const Eigen::Vector3d& p = geometry().mesh->vertices[geometry().mesh->triangles[i / 3][i % 3]];
    EXPECT_EQ(sut->colours[i], wanted.at(static_cast<std::size_t>(p.x() + 2 * p.y() + 3 * p.z())));
  }
}

TEST_F(MeshLooksOfGltf, names_of_pictures_are_percent_coded_and_stay_in_the_home_all_the_same) {
  home.write("envlib/four pixels.png", four_pixels());
  home.write("envlib/four", four_pixels());
  for (const char* file : {"t.glb", "t.gltf"}) {
    const auto look = [&](const std::string& uri) {
      Gltf gltf;
      gltf.images = R"({"uri":")" + uri + R"("})";
      return look_of(file, gltf);
    };
    EXPECT_TRUE(look("four%20pixels.png")) << finding();
    EXPECT_EQ(look("%2e%2E%2F../four.png"), nullptr);
    EXPECT_THAT(finding(), HasSubstr("the path ../../four.png leaves HOME"));
    EXPECT_EQ(look("%2Fetc%2Fhostname"), nullptr);
    EXPECT_THAT(finding(), HasSubstr("the path /etc/hostname is absolute"));
    EXPECT_EQ(look("four%00.png"), nullptr);
    EXPECT_THAT(finding(), HasSubstr("contains a NUL byte"));
  }
}

TEST_F(MeshLooksOfGltf, images_that_repeat_the_same_bytes_are_bounded) {
  Gltf gltf;
  gltf.picture = std::string(1U << 20U, 'x');
  const std::string image = gltf.images;
  for (int i = 0; i < 128; ++i) gltf.images += "," + image;
  geometry::MeshFindings findings;
  const auto sut = parse_mesh(gltf.glb(), ".glb", "t.glb", Eigen::Vector3d::Ones(), {}, findings);
  ASSERT_FALSE(sut);
  EXPECT_EQ(sut.error().what, "the mesh t.glb is refused: its textures together exceed the size limit of a mesh");
}

}  // namespace
}  // namespace cellmirror
