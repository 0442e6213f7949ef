// What the reader of meshes answers, as bytes that nobody believes.
#include "config/mesh_message/mesh_message.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace cellmirror {
namespace {

ScenePolygons one_triangle() {
  ScenePolygons out;
  out.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}};
  out.triangles = {{0, 1, 2}};
  out.places = {{0, 0}, {1, 0}, {0, 1}};
  out.colours = {{1, 2, 3, 255}, {4, 5, 6, 255}, {7, 8, 9, 255}};
  out.materials = {1};
  out.palette.resize(2);
  out.palette[0].picture = "a.png";
  out.palette[1] = {"m", "", 0, "", {0.25F, 0.5F, 1.0F}, true};
  out.embedded = {std::string(10'000, 'p')};
  return out;
}

std::string bytes_of(const ScenePolygons& polygons) {
  const Result<ScenePolygons> answer = polygons;
  return encode_mesh_answer(answer).joined();
}

bool is_taken(const ScenePolygons& polygons, bool with_looks = true) {
  return decode_mesh_answer(bytes_of(polygons), with_looks).has_value();
}

TEST(MeshMessage, brings_polygons_and_looks_whole) {
  const ScenePolygons sent = one_triangle();
  const auto answer = decode_mesh_answer(bytes_of(sent), true);
  ASSERT_TRUE(answer && *answer);
  const ScenePolygons& sut = **answer;
  EXPECT_EQ(sut.vertices, sent.vertices);
  EXPECT_EQ(sut.triangles, sent.triangles);
  EXPECT_EQ(sut.places, sent.places);
  EXPECT_EQ(sut.colours, sent.colours);
  EXPECT_EQ(sut.materials, sent.materials);
  EXPECT_EQ(sut.embedded, sent.embedded);
  ASSERT_EQ(sut.palette.size(), 2U);
  EXPECT_EQ(sut.palette[0].picture, "a.png");
  EXPECT_FALSE(sut.palette[0].embedded);
  EXPECT_EQ(sut.palette[1].name, "m");
  EXPECT_EQ(sut.palette[1].embedded, 0U);
  EXPECT_EQ(sut.palette[1].rgb, sent.palette[1].rgb);
  EXPECT_TRUE(sut.palette[1].is_factor);
}

TEST(MeshMessage, brings_requests_whole) {
  const std::string bytes(10'000, 'b');
  const std::string message =
      encode_mesh_request({".gltf", bytes, {{"a.bin", "AA"}, {"b.bin", bytes}}, {1, -2, 0.5}, true}).joined();
  const auto sut = decode_mesh_request(message);
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->extension, ".gltf");
  EXPECT_EQ(sut->bytes, bytes);
  ASSERT_EQ(sut->buffers.size(), 2U);
  EXPECT_EQ(sut->buffers[0], (std::pair<std::string_view, std::string_view>("a.bin", "AA")));
  EXPECT_EQ(sut->buffers[1].second, bytes);
  EXPECT_EQ(sut->scale, Eigen::Vector3d(1, -2, 0.5));
  EXPECT_TRUE(sut->with_looks);
  EXPECT_FALSE(decode_mesh_request(message + "x"));
  EXPECT_FALSE(decode_mesh_request(message.substr(0, message.size() - 1)));
}

TEST(MeshMessage, brings_errors_printable_and_short) {
  const auto sut =
      decode_mesh_answer(encode_mesh_answer(fail("it\n" + std::string(100'000, 'x'), "mend\x1b[2J")).joined(), false);
  ASSERT_TRUE(sut && !*sut);
  EXPECT_TRUE(sut->error().what.starts_with("it\\x0axxx"));
  EXPECT_LT(sut->error().what.size(), 400U);
  EXPECT_EQ(sut->error().remedy, "mend\\x1b[2J");
}

TEST(MeshMessage, takes_no_answer_that_ends_early_or_late) {
  const std::string whole = bytes_of(one_triangle());
  for (std::size_t size = 0; size < whole.size(); size += size < 600 ? 1 : 500)
    EXPECT_FALSE(decode_mesh_answer(whole.substr(0, size), true)) << size;
  EXPECT_FALSE(decode_mesh_answer(whole + "x", true));
}

TEST(MeshMessage, takes_no_answer_that_names_what_is_not_there) {
  EXPECT_TRUE(is_taken(one_triangle()));
  const auto changed = [](const auto& change) {
    ScenePolygons out = one_triangle();
    change(out);
    return is_taken(out);
  };
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.triangles[0][1] = 3; }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.materials[0] = 2; }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.materials.clear(); }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.places.pop_back(); }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.colours.pop_back(); }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.palette[1].embedded = 1; }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.palette[1].name = std::string(5000, 'n'); }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.palette.resize(kMostMaterials + 1); }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.places[0].x() = std::numeric_limits<float>::quiet_NaN(); }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.places[0].y() = 2 * kFarthestPlace; }));
  EXPECT_FALSE(changed([](ScenePolygons& p) { p.palette[0].rgb[2] = std::numeric_limits<float>::infinity(); }));
}

TEST(MeshMessage, takes_no_looks_that_nobody_wanted) {
  ScenePolygons shape;
  shape.vertices = one_triangle().vertices;
  shape.triangles = one_triangle().triangles;
  EXPECT_TRUE(is_taken(shape, false));
  EXPECT_FALSE(is_taken(shape, true));  // whose materials are missing
  EXPECT_FALSE(is_taken(one_triangle(), false));
}

TEST(MeshMessage, believes_no_count) {
  // Kinds, counts and lengths of any size, and nothing behind them.
  for (const std::size_t count : {std::size_t{1}, std::size_t{1} << 40U, std::numeric_limits<std::size_t>::max()}) {
    for (const std::size_t kind : {std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
      MeshMessage message;
      message.number(kind);
      message.number(count);
      message.number(count);
      EXPECT_FALSE(decode_mesh_answer(message.joined(), true));
    }
  }
}

}  // namespace
}  // namespace cellmirror
