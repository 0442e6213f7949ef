#include "drivers/display/internal/tissue/pool_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "drivers/display/internal/tissue/tissue_shaders.hpp"

namespace cellmirror::display {

namespace {

constexpr double kLargestPool = 1e3;  // m, of an edge, a height, a distance of the origin
constexpr std::size_t kMostAlong = 512;

bool sensible_pool(const TissuePool& pool) {
  const Eigen::Matrix4d& X_WP = pool.X_WP.matrix();
  return pool.present && X_WP.allFinite() && X_WP.cwiseAbs().maxCoeff() < kLargestPool && pool.size_m.allFinite() &&
         pool.size_m.minCoeff() > 0 && static_cast<double>(pool.size_m.maxCoeff()) < kLargestPool &&
         std::isfinite(pool.level_m) && std::abs(pool.level_m) < kLargestPool;
}

struct Heights {
  std::size_t columns = 2;
  std::size_t rows = 2;
  const std::vector<float>* values = nullptr;  // null: level

  [[nodiscard]] float at(std::size_t column, std::size_t row) const {
    if (values == nullptr) return 0;
    const float height = (*values)[row * columns + column];
    return std::isfinite(height) && std::abs(height) < static_cast<float>(kLargestPool) ? height : 0.0F;
  }
};

Heights heights_of(const TissuePool& pool) {
  const std::size_t columns = pool.columns;
  if (columns < 2 || columns > kMostAlong || pool.heights_m.size() % columns != 0) return {};
  const std::size_t rows = pool.heights_m.size() / columns;
  if (rows < 2 || rows > kMostAlong) return {};
  return {columns, rows, &pool.heights_m};
}

// By differences of the neighbours, at the edges of the nearest two.
Eigen::Vector3f normal_at(const Heights& heights, std::size_t column, std::size_t row, const Eigen::Vector2f& step) {
  const std::size_t left = column == 0 ? 0 : column - 1;
  const std::size_t right = std::min(column + 1, heights.columns - 1);
  const std::size_t lower = row == 0 ? 0 : row - 1;
  const std::size_t upper = std::min(row + 1, heights.rows - 1);
  const float along_x = static_cast<float>(right - left) * step.x();
  const float along_y = static_cast<float>(upper - lower) * step.y();
  return Eigen::Vector3f(-(heights.at(right, row) - heights.at(left, row)) / along_x,
                         -(heights.at(column, upper) - heights.at(column, lower)) / along_y, 1)
      .normalized();
}

}  // namespace

PoolGrid pool_grid(const TissuePool& pool) {
  if (!sensible_pool(pool)) return {};
  const Heights heights = heights_of(pool);
  const Eigen::Isometry3f X_WP = pool.X_WP.cast<float>();
  const Eigen::Vector2f step = pool.size_m.cwiseQuotient(
      Eigen::Vector2f(static_cast<float>(heights.columns - 1), static_cast<float>(heights.rows - 1)));
  PoolGrid grid;
  grid.columns = static_cast<std::uint32_t>(heights.columns);
  grid.vertices.reserve(heights.columns * heights.rows);
  for (std::size_t row = 0; row < heights.rows; ++row) {
    for (std::size_t column = 0; column < heights.columns; ++column) {
      const Eigen::Vector2f at =
          Eigen::Vector2f(static_cast<float>(column), static_cast<float>(row)).cwiseProduct(step) - pool.size_m / 2;
      const float z = static_cast<float>(pool.level_m) + heights.at(column, row);
      grid.vertices.push_back(
          {X_WP * Eigen::Vector3f(at.x(), at.y(), z), X_WP.linear() * normal_at(heights, column, row, step)});
    }
  }
  return grid;
}

Colour pool_colour(const TissuePool& pool) {
  Colour colour{};
  for (std::size_t i = 0; i < 4; ++i)
    colour[i] = std::isfinite(pool.rgba[i]) ? std::clamp(pool.rgba[i], 0.0F, 1.0F) : 0.5F;
  return colour;
}

PoolPass::~PoolPass() {
  if (array_ == 0) return;
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(1, &vertices_);
  gl_.DeleteBuffers(1, &indices_);
}

Result<void> PoolPass::build() {
  const std::string fragment = std::string(shaders::kWetLight) + std::string(shaders::kPoolFragment);
  if (Result<void> built = program_.build(shaders::kPoolVertex, fragment); !built) return built;
  gl_.GenVertexArrays(1, &array_);
  gl_.BindVertexArray(array_);
  gl_.GenBuffers(1, &vertices_);
  gl_.GenBuffers(1, &indices_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  for (const GLuint attribute : {0U, 1U}) gl_.EnableVertexAttribArray(attribute);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  gl_.VertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(offsetof(Vertex, normal)));
  return {};
}

void PoolPass::upload(const PoolGrid& grid) {
  gl_.BindVertexArray(array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(grid.vertices.size() * sizeof(Vertex)), grid.vertices.data(),
                 GL_STREAM_DRAW);
  const std::uint32_t columns = grid.columns;
  const auto rows = static_cast<std::uint32_t>(grid.vertices.size() / columns);
  count_ = static_cast<GLsizei>(6 * (columns - 1) * (rows - 1));
  if (columns == indexed_columns_ && rows == indexed_rows_) return;
  std::vector<std::uint32_t> indices;
  indices.reserve(static_cast<std::size_t>(count_));
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t first = row * columns + column;
      for (const std::uint32_t corner : {0U, 1U, columns + 1, 0U, columns + 1, columns})
        indices.push_back(first + corner);
    }
  }
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                 indices.data(), GL_STATIC_DRAW);
  indexed_columns_ = columns;
  indexed_rows_ = rows;
}

void PoolPass::prepare(const std::shared_ptr<const TissueView>& view) {
  if (view == view_) return;
  view_ = view;
  count_ = 0;
  bounds_.setEmpty();
  if (view == nullptr) return;
  const PoolGrid grid = pool_grid(view->pool);
  rgba_ = pool_colour(view->pool);
  if (grid.vertices.empty() || !(rgba_[3] > 0)) return;
  for (const Vertex& vertex : grid.vertices) bounds_.extend(vertex.position.cast<double>());
  upload(grid);
}

void PoolPass::draw(const Frame& frame) {
  if (count_ == 0) return;
  const Eigen::Matrix4f clip_from_world = frame.view.clip_from_world().cast<float>();
  const Eigen::Vector4f eye = frame.view.eye().cast<float>();
  const Eigen::Vector3f to_eye = frame.view.X_WE().linear().col(2).cast<float>();
  program_.use();
  gl_.UniformMatrix4fv(program_.uniform("clip_from_world"), 1, GL_FALSE, clip_from_world.data());
  gl_.Uniform4fv(program_.uniform("eye"), 1, eye.data());
  gl_.Uniform3fv(program_.uniform("to_eye"), 1, to_eye.data());
  gl_.Uniform4fv(program_.uniform("rgba"), 1, rgba_.data());
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  gl_.BindVertexArray(array_);
  gl_.DrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

}  // namespace cellmirror::display
