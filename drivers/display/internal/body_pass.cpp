#include "drivers/display/internal/body_pass.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "drivers/display/internal/shaders.hpp"
#include "rt_core/ports/palette.hpp"

namespace cellmirror::display {

namespace {

constexpr double kFarthest = 1e5;  // m: where a body may stand
constexpr float kSeeThrough = 0.35F;
constexpr float kGhostAlpha = 0.40F;

Colour mixed(const Colour& a, const Colour& b, float part) {
  Colour colour = a;
  for (std::size_t i = 0; i < 3; ++i) colour[i] += part * (b[i] - a[i]);
  return colour;
}

Colour finite(Colour colour) {
  for (float& value : colour) value = std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 1.0F;
  return colour;
}

// Of a mark: its colour and, as alpha, the share that it has in the body's.
Colour over_colour(Mark mark) {
  const auto with_share = [](Colour colour, float share) { return Colour{colour[0], colour[1], colour[2], share}; };
  switch (mark) {
    case Mark::none:
      break;
    case Mark::near:
      return with_share(palette::kNear, 0.80F);
    case Mark::touching:
      return with_share(palette::kTouching, 0.85F);
    case Mark::ghost:
      return with_share(palette::kGhost, 0.75F);
  }
  return {0, 0, 0, 0};
}

// Without its mark, but as see-through as it is drawn.
Colour own_colour(const SceneBody& body) {
  Colour colour = finite(body.rgba);
  if (body.mode == DrawMode::transparent) colour[3] = std::min(colour[3], kSeeThrough);
  if (body.mark == Mark::ghost) colour[3] = std::min(colour[3], kGhostAlpha);
  return colour;
}

// The lines of a wireframe are thin: pale colours would be lost before the pale background.
Colour line_colour(const Colour& colour) {
  constexpr float kDarker = 0.55F;
  return {colour[0] * kDarker, colour[1] * kDarker, colour[2] * kDarker, std::max(colour[3], 0.7F)};
}

bool backfaces_removed(const Scene& scene, const DrawnBody& body) {
  // Of a wireframe OpenGL removes no faces, so its edges are chosen by computation in either mode.
  const bool by_gl = scene.modes.test(static_cast<std::size_t>(DisplayMode::backface_removal));
  const bool computed = scene.modes.test(static_cast<std::size_t>(DisplayMode::cpu_backface_removal));
  return computed || (by_gl && body.mode == DrawMode::wireframe);
}

}  // namespace

std::vector<DrawnBody> drawn_bodies(const Scene& scene, MeshStore& meshes) {
  std::vector<DrawnBody> bodies;
  bodies.reserve(scene.bodies.size());
  add_drawn(scene.bodies, scene.modes.test(static_cast<std::size_t>(DisplayMode::textures)), meshes, bodies);
  return bodies;
}

void add_drawn(std::span<const SceneBody> bodies, bool pictures, MeshStore& meshes, std::vector<DrawnBody>& all) {
  for (const SceneBody& body : bodies) {
    const Eigen::Matrix4d& X_WG = body.X_WG.matrix();
    if (!X_WG.allFinite() || X_WG.cwiseAbs().maxCoeff() > kFarthest) continue;
    const ShapeUse use = meshes.shape_of(body);
    if (use.mesh == nullptr) continue;
    DrawnBody drawn;
    drawn.mesh = use.mesh;
    drawn.X_WM = X_WG * Eigen::Vector4d(use.scale.x(), use.scale.y(), use.scale.z(), 1).asDiagonal();
    drawn.own = own_colour(body);
    drawn.over = over_colour(body.mark);
    drawn.rgba = mixed(drawn.own, drawn.over, drawn.over[3]);
    if (drawn.rgba[3] <= 0) continue;
    drawn.mode = body.mode;
    drawn.textured = pictures && use.mesh->has_look() && body.mode != DrawMode::wireframe;
    drawn.mark = body.mark;
    drawn.object = body.object;
    drawn.casts_shadow = body.casts_shadow;
    const BoundingSphere& bounds = use.mesh->bounds();
    drawn.bounds_W.centre = (drawn.X_WM * bounds.centre.homogeneous()).head<3>();
    drawn.bounds_W.radius = bounds.radius * use.scale.maxCoeff();
    all.push_back(drawn);
  }
}

BodyPass::BodyPass(const GlApi& gl, TextureStore& textures)
    : gl_(gl), textures_(textures), one_sided_(gl), two_sided_(gl), striped_(gl), plain_(gl), objects_(gl) {}

Result<void> BodyPass::build(Shading& shading, std::string_view fragment,
                             std::initializer_list<std::string_view> defines) {
  const ShaderProgram& program = shading.program;
  if (auto built = shading.program.build(shaders::kBodyVertex, fragment, defines); !built) return built;
  shading.uniforms = {program.uniform("clip_from_mesh"),
                      program.uniform("world_from_normal"),
                      program.uniform("rgb"),
                      program.uniform("alpha"),
                      program.uniform("to_eye"),
                      program.uniform("object"),
                      program.uniform("picture"),
                      program.uniform("material"),
                      program.uniform("own"),
                      program.uniform("over")};
  return {};
}

Result<void> BodyPass::build() {
  Result<void> built = build(one_sided_, shaders::kBodyFragment, {});
  if (built) built = build(two_sided_, shaders::kBodyFragment, {"TWO_SIDED"});
  if (built) built = build(striped_, shaders::kBodyFragment, {"TWO_SIDED", "STRIPES"});
  if (built) built = build(plain_, shaders::kBodyFragment, {"PLAIN"});
  if (built) built = build(objects_, shaders::kObjectFragment, {"PLAIN"});
  return built;
}

BodyPass::Shading& BodyPass::with_pictures(Shading& shading) {
  if (!shading.tried) {
    shading.tried = true;
    auto made = std::make_unique<Shading>(gl_);
    const auto built = &shading == &one_sided_ ? build(*made, shaders::kBodyFragment, {"TEXTURED"})
                       : &shading == &two_sided_
                           ? build(*made, shaders::kBodyFragment, {"TEXTURED", "TWO_SIDED"})
                           : build(*made, shaders::kBodyFragment, {"TEXTURED", "TWO_SIDED", "STRIPES"});
    if (built) shading.textured = std::move(made);
  }
  return shading.textured == nullptr ? shading : *shading.textured;
}

BodyCounts BodyPass::examine(const Frame& frame, std::vector<DrawnBody>& bodies) {
  const bool test = frame.scene.modes.test(static_cast<std::size_t>(DisplayMode::visibility_test));
  BodyCounts counts;
  for (DrawnBody& body : bodies) {
    body.distance = frame.view.distance(body.bounds_W.centre);
    body.visible = !test || frame.view.sees(body.bounds_W.centre, body.bounds_W.radius);
    ++(body.visible ? counts.drawn : counts.left_out);
  }
  return counts;
}

void BodyPass::use(const Frame& frame, Shading& shading) {
  if (used_ == &shading) return;
  used_ = &shading;
  shading.program.use();
  const Eigen::Vector3f to_eye = frame.view.X_WE().linear().col(2).cast<float>();
  gl_.Uniform3fv(shading.uniforms.to_eye, 1, to_eye.data());
}

void BodyPass::put(const Frame& frame, const DrawnBody& body) {
  const Uniforms& uniforms = used_->uniforms;
  const Eigen::Matrix4f clip_from_mesh = (frame.view.clip_from_world() * body.X_WM).cast<float>();
  gl_.UniformMatrix4fv(uniforms.clip_from_mesh, 1, GL_FALSE, clip_from_mesh.data());
  if (uniforms.world_from_normal >= 0) {
    const Eigen::Matrix3f normals = body.X_WM.topLeftCorner<3, 3>().inverse().transpose().cast<float>();
    gl_.UniformMatrix3fv(uniforms.world_from_normal, 1, GL_FALSE, normals.data());
  }
  if (used_ == &objects_) return gl_.Uniform1ui(uniforms.object, body.object);
  const bool pictures = uniforms.picture >= 0;
  if (pictures) {
    gl_.Uniform3fv(uniforms.own, 1, body.own.data());
    gl_.Uniform4fv(uniforms.over, 1, body.over.data());
  }
  constexpr std::array<float, 3> kWhite{1, 1, 1};  // the light alone: the colour comes a pixel
  const Colour colour = body.mode == DrawMode::wireframe ? line_colour(body.rgba) : body.rgba;
  if (pictures)
    gl_.Uniform3fv(uniforms.rgb, 1, kWhite.data());
  else
    gl_.Uniform3fv(uniforms.rgb, 1, colour.data());
  gl_.Uniform1f(uniforms.alpha, colour[3]);
}

void BodyPass::draw(const Frame& frame, const DrawnBody& body) {
  put(frame, body);
  const bool solid = used_ == &objects_ || body.mode != DrawMode::wireframe;
  const DrawMode mode = solid && body.mode == DrawMode::wireframe ? DrawMode::gouraud : body.mode;
  const auto buffers = [&]() -> const Buffers& {
    if (backfaces_removed(frame.scene, body)) {
      const Eigen::Vector4d eye = body.X_WM.inverse() * frame.view.eye();
      return body.mesh->facing(mode, eye);
    }
    if (mode == DrawMode::wireframe) return body.mesh->wires();
    return mode == DrawMode::flat ? body.mesh->flat() : body.mesh->smooth();
  };
  const Buffers& drawn = buffers();
  gl_.BindVertexArray(drawn.array);
  if (used_->uniforms.picture >= 0) return draw_parts(body, drawn);
  gl_.DrawElements(mode == DrawMode::wireframe ? GL_LINES : GL_TRIANGLES, drawn.count, GL_UNSIGNED_INT, nullptr);
}

void BodyPass::draw_parts(const DrawnBody& body, const Buffers& buffers) {
  constexpr GLint kUnit = 2;  // 0 and 1 are the floor's
  gl_.Uniform1i(used_->uniforms.picture, kUnit);
  gl_.ActiveTexture(GL_TEXTURE0 + kUnit);
  const std::vector<StoredMaterial>& materials = body.mesh->materials(textures_);
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < buffers.ends.size() && i < materials.size(); first = buffers.ends[i++]) {
    if (buffers.ends[i] == first) continue;
    gl_.BindTexture(GL_TEXTURE_2D, materials[i].texture->name());
    gl_.Uniform3fv(used_->uniforms.material, 1, materials[i].rgb.data());
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(buffers.ends[i] - first), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(std::size_t{first} * sizeof(Corner)));
  }
}

BodyPass::Shading& BodyPass::shading_of(const Frame& frame, const DrawnBody& body) {
  if (body.mode == DrawMode::wireframe) return plain_;
  const bool two_sided = frame.scene.modes.test(static_cast<std::size_t>(DisplayMode::two_sided_light));
  Shading& plain = body.mark == Mark::touching ? striped_ : two_sided || body.see_through() ? two_sided_ : one_sided_;
  return body.textured ? with_pictures(plain) : plain;
}

void BodyPass::draw_opaque(const Frame& frame, std::vector<DrawnBody>& bodies) {
  // The nearest first: what they hide is then not shaded.
  std::stable_sort(bodies.begin(), bodies.end(),
                   [](const DrawnBody& a, const DrawnBody& b) { return a.distance < b.distance; });
  const bool cull = frame.scene.modes.test(static_cast<std::size_t>(DisplayMode::backface_removal));
  used_ = nullptr;
  if (cull) gl_.Enable(GL_CULL_FACE);
  for (const DrawnBody& body : bodies) {
    if (!body.visible || body.see_through()) continue;
    use(frame, shading_of(frame, body));
    draw(frame, body);
  }
  gl_.Disable(GL_CULL_FACE);
}

// Only the surface nearest to the eye is drawn, so that a robot's ghost looks like one object.
void BodyPass::draw_ghosts(const Frame& frame, std::span<const DrawnBody* const> ghosts) {
  gl_.ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  for (const DrawnBody* body : ghosts) {
    use(frame, plain_);
    if (body->mode != DrawMode::wireframe) draw(frame, *body);
  }
  gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl_.DepthFunc(GL_LEQUAL);
  for (const DrawnBody* body : ghosts) {
    use(frame, shading_of(frame, *body));
    draw(frame, *body);
  }
  gl_.DepthFunc(GL_LESS);
}

void BodyPass::draw_see_through(const Frame& frame, std::vector<DrawnBody>& bodies) {
  std::vector<const DrawnBody*> ghosts;
  std::vector<const DrawnBody*> others;
  for (const DrawnBody& body : bodies) {
    if (!body.visible || !body.see_through()) continue;
    (body.mark == Mark::ghost ? ghosts : others).push_back(&body);
  }
  if (ghosts.empty() && others.empty()) return;
  used_ = nullptr;
  gl_.Enable(GL_BLEND);
  draw_ghosts(frame, ghosts);
  std::stable_sort(others.begin(), others.end(),
                   [](const DrawnBody* a, const DrawnBody* b) { return a->distance > b->distance; });
  const bool cull = frame.scene.modes.test(static_cast<std::size_t>(DisplayMode::backface_removal));
  gl_.DepthMask(GL_FALSE);
  gl_.Enable(GL_CULL_FACE);
  for (const DrawnBody* body : others) {
    use(frame, shading_of(frame, *body));
    // The inside first, then what is before it.
    if (!cull) {
      gl_.CullFace(GL_FRONT);
      draw(frame, *body);
    }
    gl_.CullFace(GL_BACK);
    if (body->mode != DrawMode::wireframe || cull) draw(frame, *body);
  }
  gl_.Disable(GL_CULL_FACE);
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

void BodyPass::draw_objects(const Frame& frame, std::vector<DrawnBody>& bodies) {
  used_ = nullptr;
  if (frame.scene.modes.test(static_cast<std::size_t>(DisplayMode::backface_removal))) gl_.Enable(GL_CULL_FACE);
  for (const DrawnBody& body : bodies) {
    if (!body.visible || body.object == 0) continue;
    use(frame, objects_);
    draw(frame, body);
  }
  gl_.Disable(GL_CULL_FACE);
}

void BodyPass::draw_extra(const Frame& frame, const std::vector<DrawnBody>& bodies) {
  used_ = nullptr;
  for (const DrawnBody& body : bodies) {
    use(frame, two_sided_);
    put(frame, body);
    const Buffers& buffers = body.mesh->smooth();
    gl_.BindVertexArray(buffers.array);
    gl_.DrawElements(GL_TRIANGLES, buffers.count, GL_UNSIGNED_INT, nullptr);
  }
}

}  // namespace cellmirror::display
