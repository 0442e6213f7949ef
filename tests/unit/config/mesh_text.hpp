// Mesh files as bytes, written by hand from the descriptions of the formats.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace cellmirror {

// A tetrahedron with edges of 1 at the origin, facing outwards.
inline const std::array<std::array<float, 3>, 4> kTetraCorners{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
inline constexpr std::array<std::array<std::uint8_t, 3>, 4> kTetraFaces{{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

inline void put_u32(std::string& to, std::uint32_t value) {
  for (unsigned i = 0; i < 4; ++i) to.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
}
inline void put_float(std::string& to, float value) { put_u32(to, std::bit_cast<std::uint32_t>(value)); }

inline std::string binary_stl(const std::vector<std::array<std::array<float, 3>, 3>>& triangles,
                              const std::string& header = "made for a test") {
  std::string out = header;
  out.resize(80);
  put_u32(out, static_cast<std::uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    for (int i = 0; i < 3; ++i) put_float(out, 0.0F);
    for (const auto& corner : triangle) {
      for (const float x : corner) put_float(out, x);
    }
    out += std::string(2, '\0');
  }
  return out;
}

inline std::string tetra_stl(const std::string& header = "made for a test") {
  std::vector<std::array<std::array<float, 3>, 3>> triangles;
  for (const auto& [a, b, c] : kTetraFaces) triangles.push_back({kTetraCorners[a], kTetraCorners[b], kTetraCorners[c]});
  return binary_stl(triangles, header);
}

inline std::string tetra_ascii_stl() {
  std::string out = "solid tetra\n";
  for (const auto& face : kTetraFaces) {
    out += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint8_t corner : face) {
      out += "vertex";
      for (const float x : kTetraCorners[corner]) out += " " + std::to_string(x);
      out += "\n";
    }
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid tetra\n";
}

// An L of 2 x 2 x 1 with a notch of 1 x 1 x 1: hexagons above and below, a line and a point besides. Volume 3.
inline const char* const kLObj = R"(mtllib missing.mtl
o L
v 0 0 0
v 2 0 0
v 2 1 0
v 1 1 0
v 1 2 0
v 0 2 0
v 0 0 1
v 2 0 1
v 2 1 1
v 1 1 1
v 1 2 1
v 0 2 1
usemtl steel
f 6 5 4 3 2 1
f 7 8 9 10 11 12
f 1 2 8 7
f 2 3 9 8
f 3 4 10 9
f 4 5 11 10
f 5 6 12 11
f 6 1 7 12
l 1 12
p 3
)";

// Millimetres; the tetrahedron 500 mm up.
inline std::string tetra_dae(const std::string& up_axis) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>)" +
         up_axis + R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1000 0 0 0 1000 0 0 0 1000</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 500</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

inline const char* const kTetraPly = R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
)";

// Positions and 16 bit indices: 48 + 24 bytes.
inline std::string tetra_buffer() {
  std::string out;
  for (const auto& corner : kTetraCorners) {
    for (const float x : corner) put_float(out, x);
  }
  for (const auto& face : kTetraFaces) {
    for (const std::uint8_t corner : face) out += {static_cast<char>(corner), '\0'};
  }
  return out;
}

// `uri`: a member of the buffer ("\"uri\":\"...\"," or nothing, for GLB). Two nodes show the mesh.
inline std::string tetra_gltf(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0},{"mesh":0,"translation":[0,0,5]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"buffers":[{)" +
         uri + R"("byteLength":72}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}]})";
}

inline std::string glb_of(std::string json, std::string buffer) {
  while (json.size() % 4 != 0) json += ' ';
  while (buffer.size() % 4 != 0) buffer += '\0';
  std::string out = "glTF";
  put_u32(out, 2);
  put_u32(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  put_u32(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  put_u32(out, static_cast<std::uint32_t>(buffer.size()));
  out += std::string("BIN\0", 4) + buffer;
  return out;
}

inline std::string tetra_glb() { return glb_of(tetra_gltf(""), tetra_buffer()); }

}  // namespace cellmirror
