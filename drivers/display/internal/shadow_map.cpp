#include "drivers/display/internal/shadow_map.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/shaders.hpp"

namespace cellmirror::display {

namespace {

constexpr int kEdge = ShadowPicture::kEdge;
// How far the edges of shadows reach: of what is near the floor, and of what is not. Small cells have small shadows.
double sharp_edge(double extent_m) { return std::min(0.02, 0.0025 * extent_m); }
double soft_edge(double extent_m) { return std::min(0.13, 0.015 * extent_m); }
double low_height(double extent_m) { return std::min(0.45, 0.06 * extent_m); }  // above it nothing is near the floor

bool casts(const DrawnBody& body) {
  return body.casts_shadow && !body.see_through() && body.mode != DrawMode::wireframe;
}

// Along the light: from a point of the world to its shadow on the plane z = 0 below `floor_z`; keeps the height above
// it in z.
Eigen::Matrix4d shadow_projection(double level) {
  const Eigen::Vector3d light = towards_light();
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(0, 2) = -light.x() / light.z();
  matrix(1, 2) = -light.y() / light.z();
  matrix(0, 3) = level * light.x() / light.z();
  matrix(1, 3) = level * light.y() / light.z();
  matrix(2, 3) = -level;
  return matrix;
}

struct Square {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  double edge = 1;
};

Square region_of(const Eigen::Matrix4d& projection, double margin, std::span<const BoundingSphere> casting) {
  constexpr double kLargest = 60;  // m: beyond, shadows get too coarse to be of use
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = -low;
  for (const BoundingSphere& bounds_W : casting) {
    const Eigen::Vector2d at = (projection * bounds_W.centre.homogeneous()).head<2>();
    const double reach = 1.25 * bounds_W.radius + margin;
    low = low.cwiseMin(at - Eigen::Vector2d::Constant(reach));
    high = high.cwiseMax(at + Eigen::Vector2d::Constant(reach));
  }
  const double edge = std::clamp((high - low).maxCoeff(), 0.05, kLargest);
  // In steps, so that the picture of the shadow does not swim while a robot moves.
  const double step = edge / 16;
  const Eigen::Vector2d centre = (low + high) / 2;
  return {{std::floor((centre.x() - edge / 2) / step) * step, std::floor((centre.y() - edge / 2) / step) * step},
          edge + step};
}

void blur_rows(const std::uint8_t* from, std::uint8_t* to, int edge, int radius) {
  // Written transposed: two calls blur both directions and turn the picture back.
  const int window = 2 * radius + 1;
  const std::uint32_t scale = 65536U / static_cast<std::uint32_t>(window);
  for (int y = 0; y < edge; ++y) {
    const std::uint8_t* row = from + y * edge;
    std::uint32_t sum = 0;
    for (int x = 0; x < radius && x < edge; ++x) sum += row[x];
    for (int x = 0; x < edge; ++x) {
      if (x + radius < edge) sum += row[x + radius];
      if (x - radius - 1 >= 0) sum -= row[x - radius - 1];
      to[x * edge + y] = static_cast<std::uint8_t>((sum * scale) >> 16U);
    }
  }
}

}  // namespace

void blur(std::vector<std::uint8_t>& plane, int edge, int radius) {
  const int reach = std::clamp(radius, 1, edge / 4);
  std::vector<std::uint8_t> other(plane.size());
  for (int pass = 0; pass < 2; ++pass) {
    blur_rows(plane.data(), other.data(), edge, reach);
    blur_rows(other.data(), plane.data(), edge, reach);
  }
}

Result<void> ShadowMap::build() { return program_.build(shaders::kShadowVertex, shaders::kShadowFragment); }

Result<void> ShadowMap::update(double z_m, double extent_m, std::span<const DrawnBody> bodies,
                               std::span<const CastingSurface> surfaces) {
  std::vector<const DrawnBody*> casting;
  std::vector<double> wanted = {z_m, extent_m};
  for (const DrawnBody& body : bodies) {
    if (!casts(body)) continue;
    casting.push_back(&body);
    wanted.push_back(static_cast<double>(reinterpret_cast<std::uintptr_t>(body.mesh) % 1000003));
    wanted.insert(wanted.end(), body.X_WM.data(), body.X_WM.data() + 16);
  }
  for (const CastingSurface& surface : surfaces)
    wanted.insert(wanted.end(), {static_cast<double>(surface.array), static_cast<double>(surface.version)});
  if (wanted == shown_ && texture_ != 0) return {};
  if (Result<void> begun = target_.begin(Pixels::coverage, kEdge, kEdge); !begun) return begun;
  level_ = z_m;
  extent_ = std::clamp(extent_m, 0.1, 1000.0);
  draw(casting, surfaces);
  soften_and_upload();
  shown_ = std::move(wanted);
  return {};
}

Eigen::Vector4f ShadowMap::part_at(double z_m) const {
  // Higher up, the shadow meets the level earlier on its way along the light.
  const Eigen::Vector3d along = towards_light() * ((z_m - level_) / towards_light().z());
  return part_ + Eigen::Vector4f(static_cast<float>(along.x()), static_cast<float>(along.y()), 0, 0);
}

void ShadowMap::draw(std::span<const DrawnBody* const> casting, std::span<const CastingSurface> surfaces) {
  gl_.ClearColor(0, 0, 0, 0);
  gl_.Clear(GL_COLOR_BUFFER_BIT);
  const Eigen::Matrix4d projection = shadow_projection(level_);
  std::vector<BoundingSphere> bounds;
  for (const DrawnBody* body : casting) bounds.push_back(body->bounds_W);
  for (const CastingSurface& surface : surfaces) bounds.push_back(surface.bounds_W);
  const Square region = bounds.empty() ? Square{} : region_of(projection, 3 * soft_edge(extent_), bounds);
  edge_m_ = region.edge;
  const auto scale = static_cast<float>(1 / region.edge);
  part_ = {static_cast<float>(region.low.x()), static_cast<float>(region.low.y()), scale, scale};
  Eigen::Matrix4d clip_from_shadow = Eigen::Matrix4d::Identity();
  clip_from_shadow(0, 0) = clip_from_shadow(1, 1) = 2 / region.edge;
  clip_from_shadow(0, 3) = -1 - 2 * region.low.x() / region.edge;
  clip_from_shadow(1, 3) = -1 - 2 * region.low.y() / region.edge;
  clip_from_shadow.row(2).setZero();  // nothing is clipped by its height
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Enable(GL_BLEND);
  gl_.BlendEquation(GL_MAX);
  draw_casting(casting, surfaces, projection, clip_from_shadow);
  gl_.BlendEquation(GL_FUNC_ADD);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
}

void ShadowMap::draw_casting(std::span<const DrawnBody* const> casting, std::span<const CastingSurface> surfaces,
                             const Eigen::Matrix4d& projection, const Eigen::Matrix4d& clip_from_shadow) {
  program_.use();
  gl_.Uniform1f(program_.uniform("low"), static_cast<float>(low_height(extent_)));
  const GLint matrix_at = program_.uniform("shadow_from_mesh");
  const GLint height_at = program_.uniform("height_of_mesh");
  const auto draw_one = [&](const Eigen::Matrix4d& on_floor, GLuint array, GLsizei corners) {
    const Eigen::Matrix4f matrix = (clip_from_shadow * on_floor).cast<float>();
    const Eigen::Vector4f height = on_floor.row(2).cast<float>();
    gl_.UniformMatrix4fv(matrix_at, 1, GL_FALSE, matrix.data());
    gl_.Uniform4fv(height_at, 1, height.data());
    gl_.BindVertexArray(array);
    gl_.DrawElements(GL_TRIANGLES, corners, GL_UNSIGNED_INT, nullptr);
  };
  for (const DrawnBody* body : casting) {
    const Buffers& buffers = body->mesh->smooth();
    draw_one(projection * body->X_WM, buffers.array, buffers.count);
  }
  for (const CastingSurface& surface : surfaces) draw_one(projection, surface.array, surface.corners);
}

void ShadowMap::soften_and_upload() {
  constexpr std::size_t kPlaces = std::size_t{kEdge} * kEdge;
  covered_.resize(2 * kPlaces);
  target_.read_coverage(covered_.data());
  std::vector<std::uint8_t> sharp(kPlaces);
  std::vector<std::uint8_t> soft(kPlaces);
  for (std::size_t i = 0; i < kPlaces; ++i) {
    sharp[i] = covered_[2 * i];
    soft[i] = covered_[2 * i + 1];
  }
  const auto pixels = [&](double metres) { return static_cast<int>(std::lround(metres * kEdge / edge_m_)); };
  blur(sharp, kEdge, pixels(sharp_edge(extent_)));
  blur(soft, kEdge, pixels(soft_edge(extent_)));
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const int left = (255 - 150 * sharp[i] / 255) * (255 - 115 * soft[i] / 255) / 255;
    sharp[i] = static_cast<std::uint8_t>(255 - left);
  }
  // Beyond its edge the texture repeats its last row: that one is light.
  for (int i = 0; i < kEdge; ++i) {
    for (const int at : {i, (kEdge - 1) * kEdge + i, i * kEdge, i * kEdge + kEdge - 1})
      sharp[static_cast<std::size_t>(at)] = 0;
  }
  if (texture_ == 0) gl_.GenTextures(1, &texture_);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, texture_);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl_.TexParameteri(GL_TEXTURE_2D, axis, GL_CLAMP_TO_EDGE);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl_.TexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, kEdge, kEdge, 0, GL_RED, GL_UNSIGNED_BYTE, sharp.data());
}

}  // namespace cellmirror::display
