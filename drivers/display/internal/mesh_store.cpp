#include "drivers/display/internal/mesh_store.hpp"

#include <cmath>
#include <cstddef>

#include "drivers/display/internal/primitives.hpp"
#include "rt_core/geometry/shape.hpp"

namespace cellmirror::display {

namespace {

constexpr GLuint kPosition = 0;  // as in the shaders
constexpr GLuint kNormal = 1;
constexpr GLuint kPlace = 2;
constexpr GLuint kColour = 3;

const void* offset_of(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

void describe_vertices(const GlApi& gl) {
  gl.EnableVertexAttribArray(kPosition);
  gl.VertexAttribPointer(kPosition, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset_of(0));
  gl.EnableVertexAttribArray(kNormal);
  gl.VertexAttribPointer(kNormal, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), offset_of(offsetof(Vertex, normal)));
}

void describe_dress(const GlApi& gl) {
  gl.EnableVertexAttribArray(kPlace);
  gl.VertexAttribPointer(kPlace, 2, GL_FLOAT, GL_FALSE, sizeof(Dress), offset_of(0));
  gl.EnableVertexAttribArray(kColour);
  gl.VertexAttribPointer(kColour, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Dress), offset_of(offsetof(Dress, colour)));
}

void fill_indices(const GlApi& gl, Buffers& buffers, const std::vector<Corner>& corners, GLenum usage) {
  if (buffers.indices == 0) gl.GenBuffers(1, &buffers.indices);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers.indices);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(Corner)), corners.data(),
                usage);
  buffers.count = static_cast<GLsizei>(corners.size());
}

// Other triangles or edges over the vertices of `of`.
void share_vertices(const GlApi& gl, const Buffers& of, Buffers& buffers) {
  if (buffers.array != 0) return gl.BindVertexArray(buffers.array);
  gl.GenVertexArrays(1, &buffers.array);
  gl.BindVertexArray(buffers.array);
  gl.BindBuffer(GL_ARRAY_BUFFER, of.vertices);
  describe_vertices(gl);
  if (of.dress == 0) return;
  gl.BindBuffer(GL_ARRAY_BUFFER, of.dress);
  describe_dress(gl);
}

void free_buffers(const GlApi& gl, Buffers& buffers) {
  if (buffers.array != 0) gl.DeleteVertexArrays(1, &buffers.array);
  if (buffers.vertices != 0) gl.DeleteBuffers(1, &buffers.vertices);
  if (buffers.dress != 0) gl.DeleteBuffers(1, &buffers.dress);
  if (buffers.indices != 0) gl.DeleteBuffers(1, &buffers.indices);
  buffers = {};
}

// Meshes of files have been through make_mesh(); one that was put together otherwise must not be read past its end.
bool sound(const geometry::TriangleMesh& mesh) {
  for (const geometry::TriangleIndices& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (v >= mesh.vertices.size()) return false;
    }
  }
  for (const Eigen::Vector3d& p : mesh.vertices) {
    if (!p.allFinite()) return false;
  }
  return !mesh.triangles.empty();
}

bool usable(double size) {
  constexpr double kLargestSize = 1e5;  // m
  return size > 0 && size < kLargestSize;
}

}  // namespace

StoredMesh::StoredMesh(const GlApi& gl, std::shared_ptr<const geometry::TriangleMesh> mesh,
                       std::shared_ptr<const MeshAppearance> look)
    : gl_(gl),
      mesh_(std::move(mesh)),
      look_(std::move(look)),
      dressed_(look_ != nullptr && sound(*look_, mesh_->triangles.size())),
      bounds_(bounding_sphere(*mesh_)) {
  if (dressed_) order_ = order_by_material(*look_);
  Surface surface = smooth_surface(*mesh_);
  upload(surface, smooth_);
  smooth_corners_ = std::move(surface.corners);
}

StoredMesh::~StoredMesh() {
  for (Buffers* buffers : {&smooth_, &flat_, &wires_, &facing_}) free_buffers(gl_, *buffers);
}

void StoredMesh::upload(Surface& surface, Buffers& buffers) {
  const std::vector<Dress> dresses = dressed_ ? dress(surface, *look_) : std::vector<Dress>();
  gl_.GenVertexArrays(1, &buffers.array);
  gl_.BindVertexArray(buffers.array);
  gl_.GenBuffers(1, &buffers.vertices);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers.vertices);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(surface.vertices.size() * sizeof(Vertex)),
                 surface.vertices.data(), GL_STATIC_DRAW);
  describe_vertices(gl_);
  if (!dressed_) return fill_indices(gl_, buffers, surface.corners, GL_STATIC_DRAW);
  gl_.GenBuffers(1, &buffers.dress);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers.dress);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(dresses.size() * sizeof(Dress)), dresses.data(),
                 GL_STATIC_DRAW);
  describe_dress(gl_);
  std::vector<Corner> corners;
  corners.reserve(surface.corners.size());
  for (const std::size_t triangle : order_.triangles)
    corners.insert(corners.end(), {surface.corners[3 * triangle], surface.corners[3 * triangle + 1],
                                   surface.corners[3 * triangle + 2]});
  for (const std::uint32_t end : order_.ends) buffers.ends.push_back(3 * end);
  fill_indices(gl_, buffers, corners, GL_STATIC_DRAW);
}

const std::vector<StoredMaterial>& StoredMesh::materials(TextureStore& textures) {
  if (!dressed_ || !materials_.empty()) return materials_;
  for (const MeshMaterial& material : look_->palette)
    materials_.push_back({textures.texture(material.picture), material.rgb});
  return materials_;
}

const Buffers& StoredMesh::flat() {
  if (flat_.array != 0) return flat_;
  Surface surface = flat_surface(*mesh_);
  upload(surface, flat_);
  return flat_;
}

const Buffers& StoredMesh::wires() {
  if (wires_.array != 0) return wires_;
  edges_ = feature_edges(*mesh_);
  // Any of the vertices that the surface has at a vertex of the mesh has its position.
  std::vector<Corner> at(mesh_->vertices.size(), 0);
  for (std::size_t i = 0; i < smooth_corners_.size(); ++i) at[mesh_->triangles[i / 3][i % 3]] = smooth_corners_[i];
  std::vector<Corner> ends;
  ends.reserve(2 * edges_.size());
  for (FeatureEdge& edge : edges_) {
    for (std::uint32_t& vertex : edge.vertices) {
      vertex = at[vertex];
      ends.push_back(vertex);
    }
  }
  share_vertices(gl_, smooth_, wires_);
  fill_indices(gl_, wires_, ends, GL_STATIC_DRAW);
  return wires_;
}

void StoredMesh::select_facing(DrawMode mode, const Eigen::Vector4d& eye) {
  if (normals_.empty()) normals_ = face_normals(*mesh_);
  faces_.resize(normals_.size());
  for (std::size_t i = 0; i < normals_.size(); ++i) {
    const Eigen::Vector3d to_eye = eye.head<3>() - eye.w() * mesh_->vertices[mesh_->triangles[i][0]];
    faces_[i] = to_eye.dot(normals_[i].cast<double>()) > 0;
  }
  selected_.clear();
  if (mode == DrawMode::wireframe) {
    for (const FeatureEdge& edge : edges_) {
      if (faces_[edge.triangles[0]] || faces_[edge.triangles[1]])
        selected_.insert(selected_.end(), edge.vertices.begin(), edge.vertices.end());
    }
    return;
  }
  facing_.ends.clear();
  if (!dressed_) {
    for (std::uint32_t i = 0; i < faces_.size(); ++i) append(mode, i);
    return;
  }
  std::uint32_t at = 0;
  for (const std::uint32_t end : order_.ends) {
    for (; at < end; ++at) append(mode, order_.triangles[at]);
    facing_.ends.push_back(static_cast<std::uint32_t>(selected_.size()));
  }
}

void StoredMesh::append(DrawMode mode, std::uint32_t triangle) {
  if (!faces_[triangle]) return;
  for (std::size_t c = std::size_t{3} * triangle; c < std::size_t{3} * triangle + 3; ++c)
    selected_.push_back(mode == DrawMode::flat ? static_cast<Corner>(c) : smooth_corners_[c]);
}

const Buffers& StoredMesh::facing(DrawMode mode, const Eigen::Vector4d& eye) {
  if (mode == DrawMode::wireframe) wires();
  const Buffers& of = mode == DrawMode::flat ? flat() : smooth_;
  select_facing(mode, eye);
  if (facing_.array != 0) {
    gl_.DeleteVertexArrays(1, &facing_.array);
    facing_.array = 0;
  }
  share_vertices(gl_, of, facing_);
  fill_indices(gl_, facing_, selected_, GL_STREAM_DRAW);
  return facing_;
}

StoredMesh* MeshStore::stored(const std::shared_ptr<const geometry::TriangleMesh>& mesh,
                              const std::shared_ptr<const MeshAppearance>& look) {
  if (mesh == nullptr) return nullptr;
  const Key key(mesh.get(), look.get());
  auto entry = meshes_.find(key);
  if (entry == meshes_.end()) {
    if (!sound(*mesh)) return nullptr;
    entry = meshes_.emplace(key, std::make_unique<StoredMesh>(gl_, mesh, look)).first;
    ++uploads_;
  }
  entry->second->last_used = frame_;
  return entry->second.get();
}

StoredMesh& MeshStore::solid(Solid solid) {
  std::unique_ptr<StoredMesh>& entry = solids_[static_cast<std::size_t>(solid)];
  if (entry != nullptr) return *entry;
  const auto make = [](Solid kind) {
    switch (kind) {
      case Solid::box:
        return unit_box();
      case Solid::cylinder:
        return unit_cylinder();
      case Solid::sphere:
        return unit_sphere();
      case Solid::cone:
        return unit_cone();
      case Solid::funnel:
        break;
    }
    return unit_funnel();
  };
  entry = std::make_unique<StoredMesh>(gl_, std::make_shared<const geometry::TriangleMesh>(make(solid)));
  return *entry;
}

ShapeUse MeshStore::shape_of(const SceneBody& body) {
  const Eigen::Vector3d& size = body.size;
  switch (body.shape) {
    case Shape::box:
      if (!usable(size.x()) || !usable(size.y()) || !usable(size.z())) return {};
      return {&solid(Solid::box), size};
    case Shape::cylinder:
      if (!usable(size.x()) || !usable(size.y())) return {};
      return {&solid(Solid::cylinder), {size.x(), size.x(), size.y()}};
    case Shape::sphere:
      if (!usable(size.x())) return {};
      return {&solid(Solid::sphere), Eigen::Vector3d::Constant(size.x())};
    case Shape::capsule: {
      if (!usable(size.x()) || !(size.y() >= 0) || !usable(size.x() + size.y())) return {};
      std::unique_ptr<StoredMesh>& entry = capsules_[{size.x(), size.y()}];
      if (entry == nullptr) {
        entry = std::make_unique<StoredMesh>(
            gl_, std::make_shared<const geometry::TriangleMesh>(capsule(size.x(), size.y())));
        ++uploads_;
      }
      entry->last_used = frame_;
      return {entry.get(), Eigen::Vector3d::Ones()};
    }
    case Shape::mesh:
      return {stored(body.mesh, body.look), Eigen::Vector3d::Ones()};
  }
  return {};
}

void MeshStore::end_frame() {
  constexpr std::uint64_t kFramesToKeep = 600;
  std::erase_if(meshes_, [&](const auto& item) {
    const StoredMesh& mesh = *item.second;
    return mesh.last_used != frame_ && (mesh.unshared() || frame_ - mesh.last_used > kFramesToKeep);
  });
  std::erase_if(capsules_, [&](const auto& item) { return item.second->last_used != frame_; });
}

}  // namespace cellmirror::display
