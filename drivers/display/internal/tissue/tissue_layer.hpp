// All that is drawn of living tissue: surfaces, clips, network, particles, fluid, fog. Private to this folder.
#pragma once

#include <vector>

#include "drivers/display/internal/body_pass.hpp"
#include "drivers/display/internal/clips.hpp"
#include "drivers/display/internal/tissue/network_pass.hpp"
#include "drivers/display/internal/tissue/particle_pass.hpp"
#include "drivers/display/internal/tissue/pool_pass.hpp"
#include "drivers/display/internal/tissue/tissue_pass.hpp"
#include "drivers/display/internal/tissue/veil_pass.hpp"

namespace cellmirror::display {

class TissueLayer {
 public:
  TissueLayer(const GlApi& gl, TextureStore& textures)
      : surfaces_(gl, textures), network_(gl), particles_(gl), pool_(gl), veil_(gl) {}
  Result<void> build();

  // Uploads what has changed; adds what is drawn as bodies.
  void prepare(const Scene& scene, MeshStore& meshes, std::vector<DrawnBody>& bodies);
  // Of the last prepare(): bounds of all but the bodies, W; may be empty.
  [[nodiscard]] Eigen::AlignedBox3d bounds() const;
  [[nodiscard]] std::span<const CastingSurface> casting() const { return surfaces_.casting(); }
  [[nodiscard]] std::uint64_t topology_uploads() const { return surfaces_.topology_uploads(); }

  // In this order, for each pane: with the opaque bodies; after all that is opaque; over all, before lines and words.
  void draw_opaque(const Frame& frame);
  void draw_see_through(const Frame& frame);
  void draw_veil(const Frame& frame);

 private:
  TissuePass surfaces_;
  NetworkPass network_;
  ParticlePass particles_;
  PoolPass pool_;
  VeilPass veil_;
  Clips clips_;
  Eigen::AlignedBox3d particle_bounds_;
};

}  // namespace cellmirror::display
