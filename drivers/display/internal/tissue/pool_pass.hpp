// Draws the surface of a fluid in a cavity: a grid of heights, see-through, wet. Private to this folder.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/shader_program.hpp"
#include "drivers/display/internal/surface.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::display {

// A pool's points, W, row by row, `columns` a row. Heights that are not a grid are taken for none, those that are not
// finite for the level. Empty: it cannot be drawn.
struct PoolGrid {
  std::vector<Vertex> vertices;
  std::uint32_t columns = 0;
};
[[nodiscard]] PoolGrid pool_grid(const TissuePool& pool);
[[nodiscard]] Colour pool_colour(const TissuePool& pool);

class PoolPass {
 public:
  explicit PoolPass(const GlApi& gl) : gl_(gl), program_(gl) {}
  ~PoolPass();
  PoolPass(const PoolPass&) = delete;
  PoolPass& operator=(const PoolPass&) = delete;

  Result<void> build();
  void prepare(const std::shared_ptr<const TissueView>& view);
  [[nodiscard]] const Eigen::AlignedBox3d& bounds() const { return bounds_; }  // W; may be empty
  // Over what is opaque; leaves depth alone.
  void draw(const Frame& frame);

 private:
  void upload(const PoolGrid& grid);

  const GlApi& gl_;
  ShaderProgram program_;
  std::shared_ptr<const TissueView> view_;
  Eigen::AlignedBox3d bounds_;
  Colour rgba_{};
  GLuint array_ = 0;
  GLuint vertices_ = 0;
  GLuint indices_ = 0;
  GLsizei count_ = 0;  // of indices; 0: none is drawn
  std::uint32_t indexed_columns_ = 0;
  std::uint32_t indexed_rows_ = 0;
};

}  // namespace cellmirror::display
