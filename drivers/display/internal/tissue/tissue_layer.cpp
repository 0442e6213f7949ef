#include "drivers/display/internal/tissue/tissue_layer.hpp"

namespace cellmirror::display {

Result<void> TissueLayer::build() {
  Result<void> built = surfaces_.build();
  if (built) built = network_.build();
  if (built) built = particles_.build();
  if (built) built = pool_.build();
  if (built) built = veil_.build();
  return built;
}

void TissueLayer::prepare(const Scene& scene, MeshStore& meshes, std::vector<DrawnBody>& bodies) {
  surfaces_.prepare(scene);
  network_.prepare(scene.tissue);
  pool_.prepare(scene.tissue);
  particle_bounds_.setEmpty();
  if (scene.tissue == nullptr) return;
  particle_bounds_ = bounds_of(scene.tissue->particles);
  add_drawn(clips_.bodies(*scene.tissue), false, meshes, bodies);
}

Eigen::AlignedBox3d TissueLayer::bounds() const {
  Eigen::AlignedBox3d bounds = surfaces_.bounds();
  bounds.extend(network_.bounds());
  bounds.extend(pool_.bounds());
  bounds.extend(particle_bounds_);
  return bounds;
}

void TissueLayer::draw_opaque(const Frame& frame) {
  if (frame.scene.tissue == nullptr) return;
  surfaces_.draw_opaque(frame);
  network_.draw(frame);
}

void TissueLayer::draw_see_through(const Frame& frame) {
  if (frame.scene.tissue == nullptr) return;
  particles_.draw_opaque(frame);
  surfaces_.draw_see_through(frame);
  pool_.draw(frame);
  particles_.draw_see_through(frame);
}

void TissueLayer::draw_veil(const Frame& frame) {
  if (frame.scene.tissue == nullptr) return;
  veil_.draw(frame, frame.scene.tissue->lens_fog, frame.scene.tissue->smoke);
}

}  // namespace cellmirror::display
