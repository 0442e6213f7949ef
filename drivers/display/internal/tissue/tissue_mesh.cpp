#include "drivers/display/internal/tissue/tissue_mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace cellmirror::display {

namespace {

const void* byte_offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

template <class Item>
void fill_buffer(const GlApi& gl, GLenum target, GLuint buffer, const std::vector<Item>& items, GLenum usage) {
  gl.BindBuffer(target, buffer);
  gl.BufferData(target, static_cast<GLsizeiptr>(items.size() * sizeof(Item)), items.data(), usage);
}

void describe_tissue(const GlApi& gl, GLuint vertices, GLuint coat) {
  for (const GLuint attribute : {0U, 1U, 2U, 3U}) gl.EnableVertexAttribArray(attribute);
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices);
  gl.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(TissueVertex), byte_offset(0));
  gl.VertexAttribPointer(1, 4, GL_SHORT, GL_TRUE, sizeof(TissueVertex), byte_offset(offsetof(TissueVertex, normal)));
  gl.BindBuffer(GL_ARRAY_BUFFER, coat);
  gl.VertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, sizeof(Dress), byte_offset(0));
  gl.VertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Dress), byte_offset(offsetof(Dress, colour)));
}

}  // namespace

TissueMesh::~TissueMesh() {
  if (array_ == 0) return;
  for (const GLuint array : {array_, edge_array_}) gl_.DeleteVertexArrays(1, &array);
  for (const GLuint buffer : {vertex_buffer_, coat_buffer_, index_buffer_, edge_buffer_}) gl_.DeleteBuffers(1, &buffer);
}

void TissueMesh::make_arrays() {
  for (GLuint* buffer : {&vertex_buffer_, &coat_buffer_, &index_buffer_, &edge_buffer_}) gl_.GenBuffers(1, buffer);
  for (const auto& [array, indices] : {std::pair(&array_, index_buffer_), std::pair(&edge_array_, edge_buffer_)}) {
    gl_.GenVertexArrays(1, array);
    gl_.BindVertexArray(*array);
    describe_tissue(gl_, vertex_buffer_, coat_buffer_);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
  }
}

bool TissueMesh::take_topology(const std::shared_ptr<const TissueTopology>& topology) {
  if (topology == nullptr) return false;
  if (topology == topology_) return true;
  std::optional<TissueTriangles> triangles = divide_by_cut(*topology);
  if (!triangles) return false;
  triangles_ = std::move(*triangles);
  topology_ = topology;
  uploaded_ = 0;
  return true;
}

void TissueMesh::upload_topology() {
  if (array_ == 0) make_arrays();
  closed_ = is_closed(triangles_);
  edge_ends_ = 0;
  gl_.BindVertexArray(array_);
  fill_buffer(gl_, GL_ELEMENT_ARRAY_BUFFER, index_buffer_, triangles_.corners, GL_STATIC_DRAW);
  fill_buffer(gl_, GL_ARRAY_BUFFER, coat_buffer_, coat_of(*topology_, vertices_.size()), GL_STATIC_DRAW);
  uploaded_ = vertices_.size();
  ++topology_uploads_;
}

bool TissueMesh::update(const TissueSurface& surface) {
  if (!take_topology(surface.topology)) return false;
  const std::optional<Eigen::AlignedBox3d> bounds = pack_vertices(surface, triangles_, vertices_);
  if (!bounds) return false;
  if (uploaded_ != vertices_.size()) upload_topology();
  fill_buffer(gl_, GL_ARRAY_BUFFER, vertex_buffer_, vertices_, GL_STREAM_DRAW);
  bounds_ = *bounds;
  if (look_ != surface.look) {
    look_ = surface.look;
    texture_ = nullptr;
  }
  return true;
}

const Texture* TissueMesh::texture(TextureStore& textures) {
  if (look_ == nullptr || topology_->texture.size() != uploaded_) return nullptr;
  const auto first = std::ranges::find_if(look_->palette, [](const MeshMaterial& m) { return m.picture != nullptr; });
  if (first == look_->palette.end()) return nullptr;
  if (texture_ == nullptr) {
    texture_ = textures.texture(first->picture);
    material_ = first->rgb;
  }
  return texture_.get();
}

BoundingSphere TissueMesh::sphere() const { return {bounds_.center(), bounds_.diagonal().norm() / 2}; }

void TissueMesh::draw(std::size_t first, std::size_t end) const {
  if (first == end) return;
  gl_.BindVertexArray(array_);
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(end - first), GL_UNSIGNED_INT,
                   byte_offset(first * sizeof(Corner)));
}

void TissueMesh::draw_skin() const { draw(0, triangles_.skin_corners); }
void TissueMesh::draw_cut_faces() const { draw(triangles_.skin_corners, triangles_.corners.size()); }

void TissueMesh::draw_edges() {
  gl_.BindVertexArray(edge_array_);
  if (edge_ends_ == 0) {
    const std::vector<Corner> ends = edges_of(triangles_);
    fill_buffer(gl_, GL_ELEMENT_ARRAY_BUFFER, edge_buffer_, ends, GL_STATIC_DRAW);
    edge_ends_ = static_cast<GLsizei>(ends.size());
  }
  gl_.DrawElements(GL_LINES, edge_ends_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace cellmirror::display
