// The glTF file of a scene: container, sharing, bounds. tests/support/glb_reader.py reads whole files as others do.
#include "drivers/display/geometry_export.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "drivers/display/internal/glb_writer.hpp"
#include "drivers/display/internal/primitives.hpp"
#include "rt_core/geometry/shape.hpp"
#include "rt_core/geometry/triangle_mesh.hpp"

namespace cellmirror::display {
namespace {

using nlohmann::json;

std::uint32_t word(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(at + i))) << (8 * i);
  return value;
}

struct File {
  json document;
  std::string buffer;
};

// Section 4.4 of the specification, by hand.
File read(const std::string& glb) {
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(word(glb, 4), 2u);
  EXPECT_EQ(word(glb, 8), glb.size());
  const std::size_t json_bytes = word(glb, 12);
  EXPECT_EQ(json_bytes % 4, 0u);
  EXPECT_EQ(glb.substr(16, 4), "JSON");
  File file{json::parse(glb.substr(20, json_bytes)), {}};
  const std::size_t behind = 20 + json_bytes;
  if (behind == glb.size()) return file;
  EXPECT_EQ(word(glb, behind) + behind + 8, glb.size());
  EXPECT_EQ(glb.substr(behind + 4, 4), std::string_view("BIN\0", 4));
  file.buffer = glb.substr(behind + 8);
  return file;
}

SceneBody body(Shape shape, const Eigen::Vector3d& size) {
  SceneBody out;
  out.object = 7;
  out.shape = shape;
  out.size = size;
  return out;
}

BodyName name_of(std::uint32_t object) { return {"Cell.Node_" + std::to_string(object), "ROBOT"}; }

File export_of(const std::vector<SceneBody>& bodies) { return read(GeometryExport().make(bodies, name_of)); }

std::shared_ptr<geometry::TriangleMesh> mesh_of(std::size_t triangles) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (std::size_t i = 0; i <= triangles + 1; ++i)
    mesh->vertices.emplace_back(static_cast<double>(i), i % 2 == 0 ? 0.0 : 1.0, 0.0);
  for (std::uint32_t i = 0; i < triangles; ++i) mesh->triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(GeometryExport, AnEmptyCellIsAFileWithoutABuffer) {
  const File file = export_of({});
  EXPECT_EQ(file.document["nodes"].size(), 1u);
  EXPECT_FALSE(file.document["nodes"][0].contains("children"));
  for (const char* name : {"meshes", "materials", "accessors", "bufferViews", "buffers"})
    EXPECT_FALSE(file.document.contains(name)) << name;
  EXPECT_TRUE(file.buffer.empty());
}

TEST(GeometryExport, ABodyIsANodeWithItsNamePoseAndColour) {
  SceneBody box = body(Shape::box, {1, 2, 3});
  box.X_WG.translation() = Eigen::Vector3d(0.5, -1, 2);
  box.rgba = {1, 0.5F, 0, 0.25F};
  const json document = export_of({box}).document;
  const json& node = document["nodes"][1];
  EXPECT_EQ(node["name"], "Cell.Node_7");
  EXPECT_EQ(node["scale"], json({1, 2, 3}));
  EXPECT_EQ(node["translation"], json({0.5, -1, 2}));
  EXPECT_EQ(node["extras"], json({{"index", 0}, {"object", 7}, {"path", "Cell.Node_7"}, {"robot", "ROBOT"}}));
  EXPECT_EQ(document["meshes"][0]["primitives"][0]["attributes"].size(), 2u);
  const json& material = document["materials"][0];
  const json& colour = material["pbrMetallicRoughness"]["baseColorFactor"];
  EXPECT_NEAR(colour[1].get<double>(), 0.2140, 1e-4) << "linear light of 0.5 in sRGB";
  EXPECT_EQ(colour[3], 0.25);
  EXPECT_EQ(material["alphaMode"], "BLEND");
}

TEST(GeometryExport, EqualGeometryIsWrittenOnce) {
  const auto mesh = mesh_of(5);
  std::vector<SceneBody> bodies = {body(Shape::box, {1, 1, 1}), body(Shape::box, {2, 1, 1}),
                                   body(Shape::capsule, {1, 2, 0}), body(Shape::capsule, {1, 3, 0}),
                                   body(Shape::mesh, {1, 1, 1})};
  bodies.back().mesh = mesh;
  bodies.push_back(bodies.back());
  bodies.back().rgba = {1, 0, 0, 1};
  const File file = export_of(bodies);
  EXPECT_EQ(file.document["accessors"].size(), 3u * 4) << "box, two capsules, the mesh";
  EXPECT_EQ(file.document["meshes"].size(), 5u) << "the mesh in two colours";
  EXPECT_EQ(file.document["nodes"][1]["mesh"], file.document["nodes"][2]["mesh"]);
  EXPECT_EQ(file.document["materials"].size(), 3u) << "grey, grey from both sides since the mesh is open, red";
}

TEST(GeometryExport, AccessorsLieInTheBufferAndTellTheirBounds) {
  std::vector<SceneBody> bodies = {body(Shape::mesh, {1, 1, 1}), body(Shape::sphere, {2, 0, 0})};
  bodies[0].mesh = mesh_of(3);  // 9 indices of 2 bytes: padded
  const File file = export_of(bodies);
  for (const json& accessor : file.document["accessors"]) {
    const json& view = file.document["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), file.buffer.size());
  }
  EXPECT_EQ(file.document["accessors"][0]["min"], json({0, 0, 0}));
  EXPECT_EQ(file.document["accessors"][0]["max"], json({4, 1, 0}));
  EXPECT_EQ(std::bit_cast<float>(word(file.buffer, 12)), 1.0F) << "x of the second vertex";
}

TEST(GeometryExport, ManyVerticesNeedWideIndices) {
  std::vector<SceneBody> bodies = {body(Shape::mesh, {1, 1, 1})};
  bodies[0].mesh = mesh_of(70'000);
  const json document = export_of(bodies).document;
  const json& indices = document["accessors"][2];
  EXPECT_EQ(indices["componentType"], 5125);
  EXPECT_EQ(indices["count"], 210'000);
}

TEST(GeometryExport, WhatCannotBeDrawnIsANodeWithoutAMesh) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<SceneBody> bodies = {body(Shape::box, {0, 1, 1}),  body(Shape::sphere, {nan, 0, 0}),
                                   body(Shape::mesh, {1, 1, 1}), body(Shape::cylinder, {1, 1e9, 0}),
                                   body(Shape::box, {1, 1, 1}),  body(Shape::mesh, {1, 1, 1})};
  bodies[4].X_WG.translation().x() = nan;
  bodies[4].rgba = {std::numeric_limits<float>::infinity(), -1, 2, std::numeric_limits<float>::quiet_NaN()};
  bodies[5].mesh = std::make_shared<geometry::TriangleMesh>();
  const json document = export_of(bodies).document;
  for (const int i : {1, 2, 3, 4, 6}) EXPECT_FALSE(document["nodes"][i].contains("mesh")) << i;
  EXPECT_TRUE(document["nodes"][5].contains("mesh"));
  EXPECT_FALSE(document["nodes"][5].contains("translation"));
  for (const json& part : document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"]) {
    EXPECT_GE(part.get<double>(), 0);
    EXPECT_LE(part.get<double>(), 1);
  }
  EXPECT_EQ(document["asset"]["extras"]["left_out"], 0);
}

TEST(GeometryExport, NamesOfAnyBytesAreText) {
  const auto odd = [](std::uint32_t) {
    return BodyName{
        "a\"\\\n\xFF"
        "b",
        ""};
  };
  const std::vector<SceneBody> bodies = {body(Shape::box, {1, 1, 1})};
  const json document = read(GeometryExport().make(bodies, odd)).document;
  EXPECT_EQ(document["nodes"][1]["name"], "a\"\\\n\uFFFDb");
}

TEST(GlbBuffer, IsBounded) {
  const Surface surface = smooth_surface(unit_box());
  GlbBuffer roomy(1 << 20);
  ASSERT_TRUE(roomy.add(surface));
  const std::size_t size = roomy.size();
  GlbBuffer exact(2 * size);
  EXPECT_TRUE(exact.add(surface));
  EXPECT_TRUE(exact.add(surface));
  EXPECT_FALSE(exact.add(surface)) << "full";
  EXPECT_EQ(exact.size(), 2 * size);
  EXPECT_FALSE(GlbBuffer(size - 1).add(surface));
}

}  // namespace
}  // namespace cellmirror::display
