#include "drivers/display/internal/tissue/particle_pass.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "drivers/display/internal/tissue/tissue_shaders.hpp"

namespace cellmirror::display {

namespace {

constexpr std::size_t kMostParticles = 8'000;
constexpr float kLargestParticle = 1.0F;   // m
constexpr float kFarthestParticle = 1e4F;  // m
constexpr double kSmallestDrop = 0.8;      // pixels
constexpr float kVanishing = 0.7F;         // the age from which a drop shrinks
constexpr std::uint8_t kBloodKind = 0;     // as TissueParticle::kind
constexpr std::uint8_t kSmokeKind = 1;
constexpr std::uint8_t kWaterKind = 2;

bool sensible_particle(const TissueParticle& particle) {
  return particle.kind <= kWaterKind && particle.at.allFinite() &&
         particle.at.cwiseAbs().maxCoeff() < kFarthestParticle && particle.radius_m > 0 &&
         particle.radius_m < kLargestParticle;
}

float age_of(const TissueParticle& particle) {
  return std::isfinite(particle.age) ? std::clamp(particle.age, 0.0F, 1.0F) : 0.0F;
}

std::array<std::uint8_t, 4> tint_of(const TissueParticle& particle) {
  const auto alpha = [](float value) { return static_cast<std::uint8_t>(std::lround(255.0F * value)); };
  if (particle.kind == kSmokeKind) return {168, 166, 168, alpha(0.42F * (1.0F - age_of(particle)))};
  if (particle.kind == kWaterKind) return {200, 214, 222, alpha(0.45F)};
  return {122, 8, 10, 255};
}

void add_disc(const Frame& frame, const TissueParticle& particle, std::vector<ParticleVertex>& vertices) {
  const Eigen::Matrix3f R_WE = frame.view.X_WE().linear().cast<float>();
  float radius = particle.radius_m;
  if (particle.kind != kSmokeKind) {
    const double pixel = frame.view.metres_per_pixel(frame.view.distance(particle.at.cast<double>()));
    radius = std::max(radius, static_cast<float>(kSmallestDrop * pixel));
    radius *= std::clamp((1.0F - age_of(particle)) / (1.0F - kVanishing), 0.0F, 1.0F);
  }
  const std::array<std::uint8_t, 4> rgba = tint_of(particle);
  for (std::size_t i = 0; i < 4; ++i) {
    const float u = i % 2 == 0 ? -1.0F : 1.0F;
    const float v = i / 2 == 0 ? -1.0F : 1.0F;
    const Eigen::Vector3f p = particle.at + radius * (u * R_WE.col(0) + v * R_WE.col(1));
    vertices.push_back({{p.x(), p.y(), p.z()}, {u, v}, rgba});
  }
}

}  // namespace

void ParticleDiscs::gather(const Frame& frame, const std::vector<TissueParticle>& particles) {
  for (std::vector<ParticleVertex>* discs : {&blood, &water, &smoke}) discs->clear();
  struct Far {
    double distance = 0;
    const TissueParticle* particle = nullptr;
  };
  std::vector<Far> visible;
  for (const TissueParticle& particle : std::span(particles).first(std::min(particles.size(), kMostParticles))) {
    if (!sensible_particle(particle)) continue;
    const Eigen::Vector3d at = particle.at.cast<double>();
    if (frame.view.sees(at, static_cast<double>(particle.radius_m)))
      visible.push_back({frame.view.distance(at), &particle});
  }
  std::ranges::stable_sort(visible, std::ranges::greater(), &Far::distance);
  for (const Far& far : visible) {
    const std::uint8_t kind = far.particle->kind;
    add_disc(frame, *far.particle, kind == kBloodKind ? blood : kind == kSmokeKind ? smoke : water);
  }
}

Eigen::AlignedBox3d bounds_of(const std::vector<TissueParticle>& particles) {
  Eigen::AlignedBox3d bounds;
  for (const TissueParticle& particle : std::span(particles).first(std::min(particles.size(), kMostParticles))) {
    if (!sensible_particle(particle)) continue;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(static_cast<double>(particle.radius_m));
    bounds.extend(particle.at.cast<double>() - reach);
    bounds.extend(particle.at.cast<double>() + reach);
  }
  return bounds;
}

ParticlePass::~ParticlePass() {
  if (array_ == 0) return;
  gl_.DeleteVertexArrays(1, &array_);
  gl_.DeleteBuffers(1, &vertices_);
  gl_.DeleteBuffers(1, &indices_);
}

Result<void> ParticlePass::build() {
  const std::string fragment = std::string(shaders::kWetLight) + std::string(shaders::kParticleFragment);
  Result<void> built = drops_.build(shaders::kParticleVertex, fragment);
  if (built) built = smoke_.build(shaders::kParticleVertex, fragment, {"SMOKE"});
  if (!built) return built;
  gl_.GenVertexArrays(1, &array_);
  gl_.BindVertexArray(array_);
  gl_.GenBuffers(1, &vertices_);
  gl_.GenBuffers(1, &indices_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  for (const GLuint attribute : {0U, 1U, 2U}) gl_.EnableVertexAttribArray(attribute);
  gl_.VertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(ParticleVertex), offset(0));
  gl_.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, sizeof(ParticleVertex), offset(offsetof(ParticleVertex, across)));
  gl_.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(ParticleVertex),
                          offset(offsetof(ParticleVertex, rgba)));
  return {};
}

void ParticlePass::index(std::size_t discs) {
  if (discs <= indexed_) return;
  std::vector<std::uint32_t> indices;
  indices.reserve(6 * discs);
  for (std::uint32_t first = 0; first < 4 * discs; first += 4) {
    for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) indices.push_back(first + corner);
  }
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)),
                 indices.data(), GL_STATIC_DRAW);
  indexed_ = discs;
}

void ParticlePass::draw(const Frame& frame, const ShaderProgram& program, const std::vector<ParticleVertex>& vertices) {
  if (vertices.empty()) return;
  const Eigen::Matrix4f clip_from_world = frame.view.clip_from_world().cast<float>();
  const Eigen::Matrix3f world_from_eye = frame.view.X_WE().linear().cast<float>();
  program.use();
  gl_.UniformMatrix4fv(program.uniform("clip_from_world"), 1, GL_FALSE, clip_from_world.data());
  gl_.UniformMatrix3fv(program.uniform("world_from_eye"), 1, GL_FALSE, world_from_eye.data());
  gl_.BindVertexArray(array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(ParticleVertex)), vertices.data(),
                 GL_STREAM_DRAW);
  index(vertices.size() / 4);
  gl_.Enable(GL_BLEND);
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(vertices.size() / 4 * 6), GL_UNSIGNED_INT, nullptr);
  gl_.Disable(GL_BLEND);
}

void ParticlePass::draw_opaque(const Frame& frame) {
  discs_.gather(frame, frame.scene.tissue->particles);
  draw(frame, drops_, discs_.blood);
}

void ParticlePass::draw_see_through(const Frame& frame) {
  gl_.DepthMask(GL_FALSE);
  draw(frame, drops_, discs_.water);
  draw(frame, smoke_, discs_.smoke);
  gl_.DepthMask(GL_TRUE);
}

}  // namespace cellmirror::display
