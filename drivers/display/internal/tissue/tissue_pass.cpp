#include "drivers/display/internal/tissue/tissue_pass.hpp"

#include <algorithm>
#include <string>

#include "drivers/display/internal/tissue/tissue_shaders.hpp"

namespace cellmirror::display {

namespace {

constexpr std::size_t kMostSurfaces = 64;
constexpr float kSeeThroughTissue = 0.35F;
constexpr GLint kTissueUnit = 2;  // of textures; 0 and 1 are the floor's

bool mode_is_on(const Scene& scene, DisplayMode mode) { return scene.modes.test(static_cast<std::size_t>(mode)); }

// Nodes inside of an object are seen through its surface.
DrawMode mode_of(const Scene& scene, std::size_t surface) {
  const DrawMode mode = surface < scene.tissue_modes.size() ? scene.tissue_modes[surface] : DrawMode::gouraud;
  if (scene.tissue->network.nodes.empty() || mode == DrawMode::wireframe) return mode;
  return DrawMode::transparent;
}

}  // namespace

TissuePass::TissuePass(const GlApi& gl, TextureStore& textures)
    : gl_(gl), textures_(textures), smooth_(gl), smooth_textured_(gl), flat_(gl), flat_textured_(gl), plain_(gl) {}

Result<void> TissuePass::build(Shading& shading, std::initializer_list<std::string_view> defines) {
  const std::string fragment = std::string(shaders::kWetLight) + std::string(shaders::kTissueFragment);
  ShaderProgram& program = shading.program;
  if (Result<void> built = program.build(shaders::kTissueVertex, fragment, defines); !built) return built;
  shading.clip_from_world = program.uniform("clip_from_world");
  shading.eye = program.uniform("eye");
  shading.to_eye = program.uniform("to_eye");
  shading.wet = program.uniform("wet");
  shading.raw = program.uniform("raw");
  shading.alpha = program.uniform("alpha");
  shading.picture = program.uniform("picture");
  shading.material = program.uniform("material");
  return {};
}

Result<void> TissuePass::build() {
  Result<void> built = build(smooth_, {});
  if (built) built = build(smooth_textured_, {"TEXTURED"});
  if (built) built = build(flat_, {"FLAT"});
  if (built) built = build(flat_textured_, {"FLAT", "TEXTURED"});
  if (built) built = build(plain_, {"PLAIN"});
  return built;
}

void TissuePass::upload(const TissueView& view) {
  surfaces_.resize(std::min(view.surfaces.size(), kMostSurfaces));
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    Drawn& drawn = surfaces_[i];
    if (drawn.mesh == nullptr) drawn.mesh = std::make_unique<TissueMesh>(gl_);
    const std::uint64_t before = drawn.mesh->topology_uploads();
    drawn.usable = view.surfaces[i].visible && drawn.mesh->update(view.surfaces[i]);
    drawn.wet = view.surfaces[i].wet;
    topology_uploads_ += drawn.mesh->topology_uploads() - before;
  }
  ++version_;
}

void TissuePass::prepare(const Scene& scene) {
  casting_.clear();
  bounds_.setEmpty();
  if (scene.tissue == nullptr) {
    surfaces_.clear();
    view_ = nullptr;
    return;
  }
  if (scene.tissue != view_) upload(*scene.tissue);
  view_ = scene.tissue;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    Drawn& drawn = surfaces_[i];
    drawn.mode = mode_of(scene, i);
    if (!drawn.usable) continue;
    bounds_.extend(drawn.mesh->bounds());
    if (drawn.mode == DrawMode::flat || drawn.mode == DrawMode::gouraud)
      casting_.push_back({drawn.mesh->array(), drawn.mesh->corners(), drawn.mesh->sphere(), version_});
  }
}

TissuePass::Shading& TissuePass::shading_of(DrawMode mode, bool textured) {
  if (mode == DrawMode::wireframe) return plain_;
  if (mode == DrawMode::flat) return textured ? flat_textured_ : flat_;
  return textured ? smooth_textured_ : smooth_;
}

void TissuePass::use(const Frame& frame, const Shading& shading, const Drawn& surface) {
  shading.program.use();
  const Eigen::Matrix4f clip_from_world = frame.view.clip_from_world().cast<float>();
  const Eigen::Vector4f eye = frame.view.eye().cast<float>();
  const Eigen::Vector3f to_eye = frame.view.X_WE().linear().col(2).cast<float>();
  gl_.UniformMatrix4fv(shading.clip_from_world, 1, GL_FALSE, clip_from_world.data());
  gl_.Uniform4fv(shading.eye, 1, eye.data());
  gl_.Uniform3fv(shading.to_eye, 1, to_eye.data());
  gl_.Uniform1f(shading.wet, surface.wet ? 1.0F : 0.0F);
  gl_.Uniform1f(shading.alpha, surface.mode == DrawMode::transparent ? kSeeThroughTissue : 1.0F);
  gl_.Uniform1f(shading.raw, 0.0F);
}

void TissuePass::draw(const Frame& frame, Drawn& surface) {
  const bool wires = surface.mode == DrawMode::wireframe;
  const bool pictures = !wires && mode_is_on(frame.scene, DisplayMode::textures);
  const Texture* const texture = pictures ? surface.mesh->texture(textures_) : nullptr;
  if (texture != nullptr) {
    const Shading& shading = shading_of(surface.mode, true);
    use(frame, shading, surface);
    gl_.ActiveTexture(GL_TEXTURE0 + kTissueUnit);
    gl_.BindTexture(GL_TEXTURE_2D, texture->name());
    gl_.Uniform1i(shading.picture, kTissueUnit);
    gl_.Uniform3fv(shading.material, 1, surface.mesh->material().data());
    surface.mesh->draw_skin();
    if (!surface.mesh->has_cut_faces()) return;
  }
  const Shading& shading = shading_of(surface.mode, false);
  use(frame, shading, surface);
  if (wires) return surface.mesh->draw_edges();
  if (texture == nullptr) surface.mesh->draw_skin();
  gl_.Uniform1f(shading.raw, 1.0F);
  surface.mesh->draw_cut_faces();
}

// Nobody sees those of a closed surface, and they are half of the work; but the near plane may open it. Of a
// transparent one only the near side is drawn: the far one would make it hard to read.
bool TissuePass::back_faces_wanted(const Frame& frame, const Drawn& surface) {
  if (mode_is_on(frame.scene, DisplayMode::backface_removal) ||
      mode_is_on(frame.scene, DisplayMode::cpu_backface_removal) || surface.mode == DrawMode::transparent)
    return false;
  const BoundingSphere sphere = surface.mesh->sphere();
  return !surface.mesh->closed() || !frame.view.before_eye(sphere.centre, sphere.radius);
}

void TissuePass::draw_those(const Frame& frame, bool see_through) {
  const bool test = mode_is_on(frame.scene, DisplayMode::visibility_test);
  for (Drawn& surface : surfaces_) {
    if (!surface.usable || (surface.mode == DrawMode::transparent) != see_through) continue;
    const BoundingSphere sphere = surface.mesh->sphere();
    if (test && !frame.view.sees(sphere.centre, sphere.radius)) continue;
    if (!back_faces_wanted(frame, surface)) gl_.Enable(GL_CULL_FACE);
    draw(frame, surface);
    gl_.Disable(GL_CULL_FACE);
  }
}

void TissuePass::draw_opaque(const Frame& frame) { draw_those(frame, false); }

void TissuePass::draw_see_through(const Frame& frame) {
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  draw_those(frame, true);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

}  // namespace cellmirror::display
