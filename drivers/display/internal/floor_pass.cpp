#include "drivers/display/internal/floor_pass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drivers/display/internal/shaders.hpp"

namespace cellmirror::display {

namespace {

constexpr int kAround = 64;
constexpr float kOpaque = 0.96F;

bool is_on(const Scene& scene, DisplayMode mode) { return scene.modes.test(static_cast<std::size_t>(mode)); }

// 1, 2 or 5 times a power of ten.
double round_step(double length) {
  const double ten = std::pow(10.0, std::floor(std::log10(length)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * ten >= length) return factor * ten;
  }
  return 10 * ten;
}

bool sensible(const ShadowCatcher& catcher) {
  constexpr double kLargest = 1e4;  // m
  return std::isfinite(catcher.z_m) && std::abs(catcher.z_m) < kLargest && catcher.low.allFinite() &&
         catcher.high.allFinite() && (catcher.low.array() < catcher.high.array()).all() &&
         catcher.low.cwiseAbs().maxCoeff() < kLargest && catcher.high.cwiseAbs().maxCoeff() < kLargest;
}

// There is one picture of the shadow: it belongs to the level on which most of the cell stands.
double level_of_shadows(const Scene& scene) {
  double level = scene.floor_z_m;
  double largest = 0;
  for (const ShadowCatcher& catcher : scene.shadow_catchers) {
    if (!sensible(catcher) || !((catcher.high - catcher.low).prod() > largest)) continue;
    largest = (catcher.high - catcher.low).prod();
    level = catcher.z_m;
  }
  return level;
}

}  // namespace

FloorPass::~FloorPass() {
  if (array_ != 0) gl_.DeleteVertexArrays(1, &array_);
  if (vertices_ != 0) gl_.DeleteBuffers(1, &vertices_);
  if (indices_ != 0) gl_.DeleteBuffers(1, &indices_);
  if (tiles_texture_ != 0) gl_.DeleteTextures(1, &tiles_texture_);
}

Result<void> FloorPass::build() {
  using shaders::kFloorFragment;
  using shaders::kFloorVertex;
  Result<void> built = plain_.build(kFloorVertex, kFloorFragment);
  if (built) built = shadow_.build(kFloorVertex, kFloorFragment, {"SHADOW"});
  if (built) built = tiles_.build(kFloorVertex, kFloorFragment, {"TEXTURED"});
  if (built) built = tiles_and_shadow_.build(kFloorVertex, kFloorFragment, {"TEXTURED", "SHADOW"});
  if (built) built = shadow_alone_.build(kFloorVertex, kFloorFragment, {"SHADOW", "ALONE"});
  if (built) built = shadow_map_.build();
  if (!built) return built;
  gl_.GenVertexArrays(1, &array_);
  gl_.BindVertexArray(array_);
  gl_.GenBuffers(1, &vertices_);
  gl_.GenBuffers(1, &indices_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  gl_.EnableVertexAttribArray(0);
  gl_.EnableVertexAttribArray(1);
  constexpr GLsizei kStride = 4 * sizeof(float);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, kStride, nullptr);
  gl_.VertexAttribPointer(1, 1, GL_FLOAT, GL_FALSE, kStride, reinterpret_cast<const void*>(3 * sizeof(float)));
  return {};
}

Result<void> FloorPass::prepare(const Scene& scene, std::span<const DrawnBody> bodies,
                                std::span<const CastingSurface> surfaces) {
  static constexpr double kFarthest = 1e4;  // m
  const auto bounded = [](const Eigen::Vector2d& p, double otherwise) {
    return p.allFinite() ? Eigen::Vector2d(p.cwiseMax(-kFarthest).cwiseMin(kFarthest))
                         : Eigen::Vector2d::Constant(otherwise);
  };
  const Eigen::Vector2d low = bounded(scene.floor_low, -1);
  const Eigen::Vector2d high = bounded(scene.floor_high, 1);
  centre_ = (low + high) / 2;
  inner_ = std::max((high - low).norm() / 2, 0.05);
  outer_ = 1.9 * inner_ + std::min(inner_, 1.0);
  if (is_on(scene, DisplayMode::textures) && tiles_texture_ == 0) make_tiles();
  shadow_level_ = level_of_shadows(scene);
  if (!is_on(scene, DisplayMode::shadows)) return {};
  return shadow_map_.update(shadow_level_, 2 * inner_, bodies, surfaces);
}

Eigen::AlignedBox3d FloorPass::reach(const Scene& scene) const {
  if (!std::isfinite(scene.floor_z_m)) return {};
  const Eigen::Vector3d centre(centre_.x(), centre_.y(), scene.floor_z_m);
  const Eigen::Vector3d half(outer_, outer_, 0);
  return {centre - half, centre + half};
}

void FloorPass::make_disc(const Scene& scene) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  const auto add = [&](double radius, int i, float alpha) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    vertices.insert(vertices.end(), {static_cast<float>(centre_.x() + radius * std::cos(angle)),
                                     static_cast<float>(centre_.y() + radius * std::sin(angle)),
                                     static_cast<float>(scene.floor_z_m), alpha});
  };
  add(0, 0, kOpaque);
  const double middle = inner_ + 0.4 * (outer_ - inner_);
  for (int i = 0; i < kAround; ++i) {
    add(inner_, i, kOpaque);
    add(middle, i, kOpaque * 0.36F);
    add(outer_, i, 0);
  }
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const std::uint32_t a = 1 + 3 * i;
    const std::uint32_t b = 1 + 3 * ((i + 1) % kAround);
    for (const std::uint32_t corner :
         {0U, a, b, a, a + 1, b, b, a + 1, b + 1, a + 1, a + 2, b + 1, b + 1, a + 2, b + 2})
      indices.push_back(corner);
  }
  upload(vertices, indices);
}

void FloorPass::upload(const std::vector<float>& vertices, const std::vector<std::uint32_t>& indices) {
  gl_.BindVertexArray(array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(float)), vertices.data(),
                 GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                 indices.data(), GL_STREAM_DRAW);
  count_ = static_cast<GLsizei>(indices.size());
}

// Concrete slabs of half a metre, four of them: a mean of 0.875 of full light, slightly uneven, with dark joints.
void FloorPass::make_tiles() {
  constexpr int kEdge = 512;
  constexpr int kSlab = kEdge / 4;
  std::vector<std::uint8_t> bytes(std::size_t{kEdge} * kEdge);
  std::uint32_t dice = 20251122U;
  const auto roll = [&dice] {
    dice = dice * 1664525U + 1013904223U;
    return static_cast<int>(dice >> 24U);
  };
  std::array<int, 16> slabs{};
  for (int& brightness : slabs) brightness = roll() % 15 - 7;
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const int into_x = std::min(x % kSlab, kSlab - 1 - x % kSlab);
      const int into_y = std::min(y % kSlab, kSlab - 1 - y % kSlab);
      const int joint = std::min(into_x, into_y) < 1 ? -52 : std::min(into_x, into_y) < 2 ? -20 : 0;
      const int slab = 4 * (y / kSlab) + x / kSlab;
      const int value = 222 + slabs[static_cast<std::size_t>(slab)] + roll() % 13 - 6 + joint;
      const int at = y * kEdge + x;
      bytes[static_cast<std::size_t>(at)] = static_cast<std::uint8_t>(value);
    }
  }
  gl_.GenTextures(1, &tiles_texture_);
  gl_.ActiveTexture(GL_TEXTURE1);
  gl_.BindTexture(GL_TEXTURE_2D, tiles_texture_);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, kEdge, kEdge, 0, GL_RED, GL_UNSIGNED_BYTE, bytes.data());
  gl_.GenerateMipmap(GL_TEXTURE_2D);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void FloorPass::gather_grid(const Frame& frame) {
  constexpr Colour kLine{0.56F, 0.59F, 0.64F, 0.75F};
  constexpr int kPieces = 12;
  grid_.clear();
  const double step = round_step(inner_ / 8);
  const double z = frame.scene.floor_z_m;
  const auto colour_at = [&](const Eigen::Vector2d& p, bool major) {
    const double way = ((p - centre_).norm() - inner_ * 0.6) / (outer_ - inner_ * 0.6);
    Colour colour = kLine;
    colour[3] *= (major ? 1.0F : 0.5F) * static_cast<float>(1 - std::clamp(way, 0.0, 1.0));
    return colour;
  };
  for (int axis = 0; axis < 2; ++axis) {
    const auto first = static_cast<long>(std::ceil((centre_[axis] - outer_) / step));
    const auto last = static_cast<long>(std::floor((centre_[axis] + outer_) / step));
    for (long i = first; i <= last; ++i) {
      const double across = static_cast<double>(i) * step;
      const double half =
          std::sqrt(std::max(0.0, outer_ * outer_ - (across - centre_[axis]) * (across - centre_[axis])));
      const auto point = [&](int piece) {
        Eigen::Vector2d p;
        p[axis] = across;
        p[1 - axis] = centre_[1 - axis] + half * (2.0 * piece / kPieces - 1);
        return p;
      };
      for (int piece = 0; piece < kPieces; ++piece) {
        const Eigen::Vector2d a = point(piece);
        const Eigen::Vector2d b = point(piece + 1);
        grid_.line(frame.view, {a.x(), a.y(), z}, {b.x(), b.y(), z},
                   {colour_at(a, i % 5 == 0), colour_at(b, i % 5 == 0), i % 5 == 0 ? 1.3F : 1.0F});
      }
    }
  }
}

ShaderProgram& FloorPass::program_of(const Scene& scene) {
  const bool shadow = is_on(scene, DisplayMode::shadows);
  if (is_on(scene, DisplayMode::textures)) return shadow ? tiles_and_shadow_ : tiles_;
  return shadow ? shadow_ : plain_;
}

void FloorPass::put(const Frame& frame, const ShaderProgram& program, double z_m) {
  program.use();
  const Eigen::Matrix4f clip_from_world = frame.view.clip_from_world().cast<float>();
  const Eigen::Vector4f part = shadow_map_.part_at(z_m);
  constexpr std::array<float, 3> kGround = {0.875F, 0.885F, 0.895F};
  gl_.UniformMatrix4fv(program.uniform("clip_from_world"), 1, GL_FALSE, clip_from_world.data());
  gl_.Uniform4fv(program.uniform("shadow_part"), 1, part.data());
  gl_.Uniform3fv(program.uniform("rgb"), 1, kGround.data());
  gl_.Uniform1i(program.uniform("shadow"), 0);
  gl_.Uniform1i(program.uniform("tiles"), 1);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, shadow_map_.texture());
  gl_.ActiveTexture(GL_TEXTURE1);
  gl_.BindTexture(GL_TEXTURE_2D, tiles_texture_);
  gl_.Enable(GL_BLEND);
  gl_.Enable(GL_POLYGON_OFFSET_FILL);
  gl_.BindVertexArray(array_);
}

void FloorPass::draw_catchers(const Frame& frame) {
  constexpr double kSameLevel = 0.05;  // m
  constexpr double kAbove = 0.0005;    // m
  constexpr std::size_t kMost = 64;
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;
  for (const ShadowCatcher& catcher : frame.scene.shadow_catchers) {
    if (!sensible(catcher) || std::abs(catcher.z_m - shadow_level_) > kSameLevel || vertices.size() >= 16 * kMost)
      continue;
    const auto first = static_cast<std::uint32_t>(vertices.size() / 4);
    for (const double y : {catcher.low.y(), catcher.high.y()}) {
      for (const double x : {catcher.low.x(), catcher.high.x()})
        vertices.insert(vertices.end(),
                        {static_cast<float>(x), static_cast<float>(y), static_cast<float>(catcher.z_m + kAbove), 1.0F});
    }
    for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) indices.push_back(first + corner);
  }
  const Eigen::Vector4d eye = frame.view.eye();
  if (indices.empty() || !(eye.z() > eye.w() * shadow_level_)) return;
  put(frame, shadow_alone_, shadow_level_);
  upload(vertices, indices);
  gl_.DepthMask(GL_FALSE);
  gl_.PolygonOffset(-1, -2);
  gl_.DrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
  gl_.Disable(GL_BLEND);
}

void FloorPass::draw(const Frame& frame, RibbonPass& ribbon_pass) {
  if (is_on(frame.scene, DisplayMode::shadows)) draw_catchers(frame);
  const Eigen::Vector4d eye = frame.view.eye();
  if (!(eye.z() > eye.w() * frame.scene.floor_z_m)) return;
  make_disc(frame.scene);
  put(frame, program_of(frame.scene), frame.scene.floor_z_m);
  gl_.PolygonOffset(1, 2);  // a plate on the floor is above it
  gl_.DrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
  gl_.Disable(GL_POLYGON_OFFSET_FILL);
  gl_.Disable(GL_BLEND);
  gather_grid(frame);
  ribbon_pass.draw(grid_, false);
}

}  // namespace cellmirror::display
