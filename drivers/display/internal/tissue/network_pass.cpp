#include "drivers/display/internal/tissue/network_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "drivers/display/internal/tissue/tissue_shaders.hpp"
#include "rt_core/ports/palette.hpp"

namespace cellmirror::display {

namespace {

constexpr std::size_t kMostNodes = 200'000;
constexpr std::size_t kMostLinks = 2'000'000;
constexpr float kFarthestNode = 1e5F;  // m
constexpr float kUsualNode = 0.0008F;  // m, of a network without links
constexpr float kNodePart = 0.13F;     // of the mean length of a link
constexpr float kMarkedNode = 1.5F;    // how much larger those in contact and fixed ones are: not by colour alone
constexpr double kSmallestNode = 2.0;  // pixels
constexpr auto kLeftOut = std::numeric_limits<std::uint32_t>::max();

struct NodeLook {
  std::array<std::uint8_t, 4> rgba{};
  float size = 1;
};

NodeLook look_of_node(TissueNodeKind kind) {
  NodeLook look;
  const Colour colour = palette::colour_of(kind);
  for (std::size_t i = 0; i < 4; ++i) look.rgba[i] = static_cast<std::uint8_t>(std::lround(255.0F * colour[i]));
  if (kind == TissueNodeKind::contact || kind == TissueNodeKind::fixed) look.size = kMarkedNode;
  return look;
}

}  // namespace

NetworkShape network_shape(const TissueNetwork& network) {
  NetworkShape shape;
  const auto nodes = std::span(network.nodes).first(std::min(network.nodes.size(), kMostNodes));
  const bool known = network.kinds.size() == network.nodes.size();
  std::vector<std::uint32_t> vertex_of(nodes.size(), kLeftOut);
  shape.vertices.reserve(4 * nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Vector3f& p = nodes[i];
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kFarthestNode) continue;
    vertex_of[i] = static_cast<std::uint32_t>(shape.vertices.size());
    const NodeLook look = look_of_node(known ? network.kinds[i] : TissueNodeKind::inner);
    shape.vertices.insert(shape.vertices.end(), 4, {{p.x(), p.y(), p.z()}, look.size, look.rgba});
    shape.bounds.extend(p.cast<double>());
  }
  double length = 0;
  for (const auto& [a, b] : std::span(network.links).first(std::min(network.links.size(), kMostLinks))) {
    if (a >= nodes.size() || b >= nodes.size() || vertex_of[a] == kLeftOut || vertex_of[b] == kLeftOut) continue;
    shape.links.insert(shape.links.end(), {vertex_of[a], vertex_of[b]});
    length += static_cast<double>((nodes[a] - nodes[b]).norm());
  }
  shape.radius_m = kUsualNode;
  if (length > 0) shape.radius_m = kNodePart * static_cast<float>(2 * length / static_cast<double>(shape.links.size()));
  return shape;
}

NetworkPass::~NetworkPass() {
  if (node_array_ == 0) return;
  for (const GLuint array : {node_array_, link_array_}) gl_.DeleteVertexArrays(1, &array);
  for (const GLuint buffer : {vertices_, node_indices_, link_indices_}) gl_.DeleteBuffers(1, &buffer);
}

Result<void> NetworkPass::build() {
  Result<void> built = nodes_.build(shaders::kNetworkVertex, shaders::kNetworkFragment);
  if (built) built = links_.build(shaders::kNetworkVertex, shaders::kNetworkFragment, {"LINKS"});
  if (!built) return built;
  for (GLuint* buffer : {&vertices_, &node_indices_, &link_indices_}) gl_.GenBuffers(1, buffer);
  for (const auto& [array, indices] :
       {std::pair(&node_array_, node_indices_), std::pair(&link_array_, link_indices_)}) {
    gl_.GenVertexArrays(1, array);
    gl_.BindVertexArray(*array);
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
    for (const GLuint attribute : {0U, 1U}) gl_.EnableVertexAttribArray(attribute);
    gl_.VertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(NodeVertex), nullptr);
    gl_.VertexAttribPointer(1, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(NodeVertex),
                            reinterpret_cast<const void*>(offsetof(NodeVertex, rgba)));
  }
  return {};
}

void NetworkPass::upload(const NetworkShape& shape) {
  const auto fill = [&](GLenum target, const auto& items, GLenum usage) {
    gl_.BufferData(target, static_cast<GLsizeiptr>(items.size() * sizeof(items[0])), items.data(), usage);
  };
  gl_.BindVertexArray(link_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  fill(GL_ARRAY_BUFFER, shape.vertices, GL_STREAM_DRAW);
  fill(GL_ELEMENT_ARRAY_BUFFER, shape.links, GL_STREAM_DRAW);
  link_ends_ = static_cast<GLsizei>(shape.links.size());
  const std::size_t nodes = shape.vertices.size() / 4;
  node_count_ = static_cast<GLsizei>(nodes);
  if (nodes <= indexed_nodes_) return;
  std::vector<std::uint32_t> indices;
  indices.reserve(12 * nodes);
  for (std::uint32_t first = 0; first < 4 * nodes; first += 4) {
    for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 3U, 1U, 0U, 2U, 3U, 1U, 3U, 2U})
      indices.push_back(first + corner);
  }
  gl_.BindVertexArray(node_array_);
  fill(GL_ELEMENT_ARRAY_BUFFER, indices, GL_STATIC_DRAW);
  indexed_nodes_ = nodes;
}

void NetworkPass::prepare(const std::shared_ptr<const TissueView>& view) {
  if (view == view_) return;
  view_ = view;
  node_count_ = 0;
  link_ends_ = 0;
  bounds_.setEmpty();
  if (view == nullptr || view->network.nodes.empty()) return;
  const NetworkShape shape = network_shape(view->network);
  if (shape.vertices.empty()) return;
  bounds_ = shape.bounds;
  radius_m_ = shape.radius_m;
  upload(shape);
}

void NetworkPass::draw(const Frame& frame) {
  if (node_count_ == 0) return;
  const Eigen::Matrix4f clip_from_world = frame.view.clip_from_world().cast<float>();
  const Eigen::Vector3f to_eye = frame.view.X_WE().linear().col(2).cast<float>();
  nodes_.use();
  gl_.UniformMatrix4fv(nodes_.uniform("clip_from_world"), 1, GL_FALSE, clip_from_world.data());
  gl_.Uniform3fv(nodes_.uniform("to_eye"), 1, to_eye.data());
  gl_.Uniform1f(nodes_.uniform("radius_m"), radius_m_);
  gl_.Uniform1f(nodes_.uniform("smallest"), static_cast<float>(kSmallestNode * frame.view.metres_per_pixel(1)));
  gl_.BindVertexArray(node_array_);
  gl_.DrawElements(GL_TRIANGLES, 12 * node_count_, GL_UNSIGNED_INT, nullptr);
  if (link_ends_ == 0) return;
  links_.use();
  gl_.UniformMatrix4fv(links_.uniform("clip_from_world"), 1, GL_FALSE, clip_from_world.data());
  gl_.BindVertexArray(link_array_);
  gl_.DrawElements(GL_LINES, link_ends_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace cellmirror::display
