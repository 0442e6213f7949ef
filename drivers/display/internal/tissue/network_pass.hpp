// Draws the network of deforming objects: nodes as tetrahedra coloured by their kind, links as lines. Private to this
// folder.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/shader_program.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::display {

struct NodeVertex {
  std::array<float, 3> node;  // W
  float size = 1;             // of a usual node
  std::array<std::uint8_t, 4> rgba{};
};
static_assert(sizeof(NodeVertex) == 20);

// Bounded in number; nodes that are not finite are left out with their links, and so are links to nodes that are not
// there. Without kinds, or with another number of them, all nodes are inner ones.
struct NetworkShape {
  std::vector<NodeVertex> vertices;  // four equal ones a node
  std::vector<std::uint32_t> links;  // pairs, of vertices
  float radius_m = 0;                // of a usual node
  Eigen::AlignedBox3d bounds;        // W
};
[[nodiscard]] NetworkShape network_shape(const TissueNetwork& network);

class NetworkPass {
 public:
  explicit NetworkPass(const GlApi& gl) : gl_(gl), nodes_(gl), links_(gl) {}
  ~NetworkPass();
  NetworkPass(const NetworkPass&) = delete;
  NetworkPass& operator=(const NetworkPass&) = delete;

  Result<void> build();
  void prepare(const std::shared_ptr<const TissueView>& view);
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }  // W; may be empty
  void draw(const Frame& frame);

 private:
  void upload(const NetworkShape& shape);

  const GlApi& gl_;
  ShaderProgram nodes_;
  ShaderProgram links_;
  std::shared_ptr<const TissueView> view_;
  Eigen::AlignedBox3d bounds_;
  float radius_m_ = 0;
  GLuint node_array_ = 0;
  GLuint link_array_ = 0;
  GLuint vertices_ = 0;
  GLuint node_indices_ = 0;
  GLuint link_indices_ = 0;
  GLsizei node_count_ = 0;
  GLsizei link_ends_ = 0;
  std::size_t indexed_nodes_ = 0;
};

}  // namespace cellmirror::display
