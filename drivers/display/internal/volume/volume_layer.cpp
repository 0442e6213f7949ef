#include "drivers/display/internal/volume/volume_layer.hpp"

#include "drivers/display/internal/volume/volume_shaders.hpp"

namespace cellmirror::display {

namespace {

constexpr GLint kVolumeUnit = 3;  // of textures; 0 to 2 are the floor's and those of surfaces

}  // namespace

VolumeLayer::~VolumeLayer() {
  if (!built_) return;
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteTextures(1, &colours_);
  gl_.DeleteTextures(1, &depths_);
}

// With the first volume: most scenes have none.
Result<void> VolumeLayer::build() {
  if (built_) return {};
  if (Result<void> done = over_.build(shaders::kVolumeVertex, shaders::kVolumeFragment); !done) return done;
  if (Result<void> done = depth_.build(shaders::kVolumeVertex, shaders::kVolumeFragment, {"DEPTH"}); !done) return done;
  gl_.GenVertexArrays(1, &array_);
  gl_.GenTextures(1, &colours_);
  gl_.GenTextures(1, &depths_);
  gl_.ActiveTexture(GL_TEXTURE0 + kVolumeUnit);
  for (const GLuint texture : {colours_, depths_}) {
    const GLint filter = texture == colours_ ? GL_LINEAR : GL_NEAREST;
    gl_.BindTexture(GL_TEXTURE_2D, texture);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      gl_.TexParameteri(GL_TEXTURE_2D, axis, GL_CLAMP_TO_EDGE);
  }
  built_ = true;
  return {};
}

void VolumeLayer::upload(const volume::VolumePicture& picture) {
  gl_.ActiveTexture(GL_TEXTURE0 + kVolumeUnit);
  gl_.BindTexture(GL_TEXTURE_2D, depths_);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R32F, picture.width, picture.height, 0, GL_RED, GL_FLOAT, picture.depth.data());
  gl_.BindTexture(GL_TEXTURE_2D, colours_);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width, picture.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 picture.rgba.data());
}

Result<void> VolumeLayer::draw(const Frame& frame, std::size_t pane, RenderTarget& target) {
  if (frame.scene.volumes.empty()) return {};
  if (Result<void> done = build(); !done) return done;
  const PixelRect& pixels = frame.view.pixels();
  scene_depth_.resize(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height));
  if (Result<void> read = target.read_depth(pixels.x, pixels.y, pixels.width, pixels.height, scene_depth_.data());
      !read)
    return read;
  const auto [picture, reduction] = casting_.cast(frame, pane, scene_depth_);
  if (picture == nullptr) return {};
  upload(*picture);
  const std::array<float, 4> part = {
      static_cast<float>(pixels.width) / static_cast<float>(picture->width * reduction),
      static_cast<float>(pixels.height) / static_cast<float>(picture->height * reduction), 0, 0};
  const auto lay = [&](const ShaderProgram& program) {
    program.use();
    gl_.Uniform1i(program.uniform("picture"), kVolumeUnit);
    gl_.Uniform4fv(program.uniform("part"), 1, part.data());
    gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  };
  gl_.BindVertexArray(array_);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Enable(GL_BLEND);
  gl_.BlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  lay(over_);
  gl_.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
  gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  gl_.BindTexture(GL_TEXTURE_2D, depths_);
  lay(depth_);
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  return {};
}

void VolumeLayer::pick(const Frame& frame, std::span<const float> depth, int width, std::span<std::uint32_t> objects) {
  const PixelRect& pixels = frame.view.pixels();
  scene_depth_.resize(static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height));
  const auto in_picture = [&](int x, int y) {
    return static_cast<std::size_t>(pixels.y + y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(pixels.x + x);
  };
  std::size_t i = 0;
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) scene_depth_[i++] = depth[in_picture(x, y)];
  }
  casting_.cast_each(frame, scene_depth_, [&](const VolumeCasting::Seen& seen) {
    std::size_t at = 0;
    for (int y = 0; y < pixels.height; ++y) {
      for (int x = 0; x < pixels.width; ++x, ++at) {
        if (seen.picture->depth[at] >= scene_depth_[at]) continue;
        scene_depth_[at] = seen.picture->depth[at];
        objects[in_picture(x, y)] = seen.object;
      }
    }
  });
}

}  // namespace cellmirror::display
