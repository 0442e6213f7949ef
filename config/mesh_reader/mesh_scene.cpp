#include "config/mesh_reader/mesh_scene.hpp"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "config/mesh_reader/polygon.hpp"
#include "rt_core/geometry/mesh_repair/mesh_repair.hpp"

namespace cellmirror {

using geometry::kMostTriangles;

namespace {

Eigen::Matrix4d matrix_of(const aiMatrix4x4& m) {
  Eigen::Matrix4d out;
  out << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return out;
}

Error too_many() { return {fmt::format("there are more than {} triangles", kMostTriangles), "reduce the mesh"}; }

float part_of_one(float value) { return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 1.0F; }

std::uint8_t byte_of(float value) { return static_cast<std::uint8_t>(std::lround(255.0F * part_of_one(value))); }

Eigen::Vector2f place_of(const aiVector3D& at) {
  if (!(std::abs(at.x) <= kFarthestPlace) || !(std::abs(at.y) <= kFarthestPlace)) return Eigen::Vector2f::Zero();
  return {at.x, at.y};
}

// Where light is linear, as in the colours of glTF; near enough, sRGB is its root.
aiColor4D root_of(const aiColor4D& light) {
  return {std::sqrt(part_of_one(light.r)), std::sqrt(part_of_one(light.g)), std::sqrt(part_of_one(light.b)), light.a};
}

// assimp gives such a colour to every material of glTF, and to no other.
bool has_base_colour(const aiMaterial& material, aiColor4D& colour) {
  return material.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS;
}

class Collector {
 public:
  Collector(const aiScene& scene, bool with_looks) : scene_(scene), with_looks_(with_looks) {
    aiColor4D ignored;
    linear_ = scene.mNumMaterials > 0 && has_base_colour(*scene.mMaterials[0], ignored);
  }

  Result<void> add(const aiMesh& mesh, const Eigen::Matrix4d& X) {
    if (mesh.mVertices == nullptr || mesh.mFaces == nullptr) return {};
    const auto first = static_cast<std::uint32_t>(out_.vertices.size());
    if (mesh.mNumVertices > 3 * kMostTriangles - first) return std::unexpected(too_many());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& p = mesh.mVertices[i];
      out_.vertices.emplace_back((X * Eigen::Vector4d(p.x, p.y, p.z, 1.0)).head<3>());
    }
    const bool mirrored = X.topLeftCorner<3, 3>().determinant() < 0.0;
    std::vector<std::uint32_t> corners;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices < 3) continue;
      if (face.mNumIndices - 2 > kMostTriangles - out_.triangles.size()) return std::unexpected(too_many());
      corners.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) return fail("a face refers to a missing vertex");
        corners.push_back(first + face.mIndices[k]);
      }
      if (mirrored) std::ranges::reverse(corners);
      cut_polygon(corners, out_.vertices, out_.triangles);
    }
    if (with_looks_) add_look(mesh);
    return {};
  }

  ScenePolygons finish() {
    if (with_looks_) {
      read_palette();
      read_embedded();
    }
    return std::move(out_);
  }

 private:
  // Of the vertices and triangles that were added last.
  void add_look(const aiMesh& mesh) {
    const std::size_t known = out_.vertices.size() - mesh.mNumVertices;
    const bool has_material = mesh.mMaterialIndex < std::min<std::size_t>(scene_.mNumMaterials, kMostMaterials);
    const unsigned material = has_material ? mesh.mMaterialIndex : 0;
    out_.materials.resize(out_.triangles.size(), static_cast<std::uint16_t>(material));
    const unsigned channel = has_material ? channel_of(*scene_.mMaterials[material]) : 0;
    if (const aiVector3D* places = mesh.mTextureCoords[channel]; places != nullptr) {
      out_.places.resize(known, Eigen::Vector2f::Zero());
      std::transform(places, places + mesh.mNumVertices, std::back_inserter(out_.places), place_of);
    }
    if (const aiColor4D* colours = mesh.mColors[0]; colours != nullptr) {
      out_.colours.resize(known, MeshAppearance::Rgba{255, 255, 255, 255});
      std::transform(colours, colours + mesh.mNumVertices, std::back_inserter(out_.colours),
                     [this](const aiColor4D& given) {
                       const aiColor4D c = linear_ ? root_of(given) : given;
                       return MeshAppearance::Rgba{byte_of(c.r), byte_of(c.g), byte_of(c.b), 255};
                     });
    }
    if (!out_.places.empty()) out_.places.resize(out_.vertices.size(), Eigen::Vector2f::Zero());
    if (!out_.colours.empty()) out_.colours.resize(out_.vertices.size(), MeshAppearance::Rgba{255, 255, 255, 255});
  }

  static bool picture_of(const aiMaterial& material, aiString& path, unsigned& channel) {
    for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
      if (material.GetTexture(type, 0, &path, nullptr, &channel) == aiReturn_SUCCESS && path.length > 0) return true;
    }
    return false;
  }

  static unsigned channel_of(const aiMaterial& material) {
    aiString path;
    unsigned channel = 0;
    return picture_of(material, path, channel) && channel < AI_MAX_NUMBER_OF_TEXTURECOORDS ? channel : 0;
  }

  void read_palette() {
    const std::size_t count = std::min<std::size_t>(scene_.mNumMaterials, kMostMaterials);
    for (std::size_t i = 0; i < count; ++i) {
      const aiMaterial& material = *scene_.mMaterials[i];
      SceneMaterial& to = out_.palette.emplace_back();
      aiString text;
      if (material.Get(AI_MATKEY_NAME, text) == aiReturn_SUCCESS) to.name = text.C_Str();
      aiColor4D colour;
      to.is_factor = has_base_colour(material, colour);
      if (to.is_factor) colour = root_of(colour);
      if (to.is_factor || material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS)
        to.rgb = {part_of_one(colour.r), part_of_one(colour.g), part_of_one(colour.b)};
      unsigned channel = 0;
      if (!picture_of(material, text, channel)) continue;
      // "*3". Other names of such textures are not references.
      if (text.C_Str()[0] == '*') {
        if (const int index = scene_.GetEmbeddedTextureAndIndex(text.C_Str()).second;
            index >= 0 && static_cast<std::size_t>(index) < kMostMaterials)
          to.embedded = static_cast<std::size_t>(index);
      }
      if (!to.embedded) to.picture = text.C_Str();
    }
    if (out_.palette.empty()) out_.palette.emplace_back();
  }

  void read_embedded() {
    const std::size_t count = std::min<std::size_t>(scene_.mNumTextures, kMostMaterials);
    for (std::size_t i = 0; i < count; ++i) {
      const aiTexture& texture = *scene_.mTextures[i];
      const bool as_a_file = texture.mHeight == 0 && texture.pcData != nullptr;
      out_.embedded.emplace_back(as_a_file ? reinterpret_cast<const char*>(texture.pcData) : "",
                                 as_a_file ? texture.mWidth : 0);
    }
  }

  const aiScene& scene_;
  bool with_looks_;
  bool linear_ = false;
  ScenePolygons out_;
};

}  // namespace

Result<ScenePolygons> collect_polygons(const aiScene& scene, const Eigen::Vector3d& scale, bool with_looks) {
  struct Open {
    const aiNode* node;
    Eigen::Matrix4d X;
  };
  Collector collector(scene, with_looks);
  Eigen::Matrix4d outermost = Eigen::Matrix4d::Identity();
  outermost.diagonal().head<3>() = scale;
  std::vector<Open> open{{scene.mRootNode, outermost}};
  constexpr int kMostNodes = 100'000;
  for (int visited = 0; !open.empty(); ++visited) {
    if (visited >= kMostNodes) return fail(fmt::format("there are more than {} nodes", kMostNodes));
    const Open top = open.back();
    open.pop_back();
    const Eigen::Matrix4d X = top.X * matrix_of(top.node->mTransformation);
    for (unsigned i = 0; i < top.node->mNumMeshes; ++i) {
      if (top.node->mMeshes[i] >= scene.mNumMeshes) return fail("a node refers to a missing mesh");
      if (auto added = collector.add(*scene.mMeshes[top.node->mMeshes[i]], X); !added)
        return std::unexpected(added.error());
    }
    for (unsigned i = 0; i < top.node->mNumChildren; ++i) open.push_back({top.node->mChildren[i], X});
  }
  return collector.finish();
}

}  // namespace cellmirror
