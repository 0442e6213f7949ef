// Draws drops of blood and water as small spheres, and smoke as soft discs. Private to this folder.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/shader_program.hpp"
#include "rt_core/ports/tissue_state.hpp"

namespace cellmirror::display {

struct ParticleVertex {
  std::array<float, 3> position;  // W
  std::array<float, 2> across;    // -1 to 1, from the centre to the right and up as the eye sees it
  std::array<std::uint8_t, 4> rgba;
};
static_assert(sizeof(ParticleVertex) == 24);

// What is drawn of a view's particles from one eye: four vertices a disc. Bounded in number; what is not finite, of no
// or too great a size, or of an unknown kind is left out.
struct ParticleDiscs {
  std::vector<ParticleVertex> blood;
  std::vector<ParticleVertex> water;  // the farthest first, as smoke
  std::vector<ParticleVertex> smoke;

  void gather(const Frame& frame, const std::vector<TissueParticle>& particles);
};

// Of those that can be drawn, W; may be empty.
[[nodiscard]] Eigen::AlignedBox3d bounds_of(const std::vector<TissueParticle>& particles);

class ParticlePass {
 public:
  explicit ParticlePass(const GlApi& gl) : gl_(gl), drops_(gl), smoke_(gl) {}
  ~ParticlePass();
  ParticlePass(const ParticlePass&) = delete;
  ParticlePass& operator=(const ParticlePass&) = delete;

  Result<void> build();
  // Blood, which hides what is behind it; before draw_see_through().
  void draw_opaque(const Frame& frame);
  // Water, then smoke; leaves depth alone.
  void draw_see_through(const Frame& frame);

 private:
  void draw(const Frame& frame, const ShaderProgram& program, const std::vector<ParticleVertex>& vertices);
  void index(std::size_t discs);

  const GlApi& gl_;
  ShaderProgram drops_;
  ShaderProgram smoke_;
  ParticleDiscs discs_;
  GLuint array_ = 0;
  GLuint vertices_ = 0;
  GLuint indices_ = 0;
  std::size_t indexed_ = 0;  // discs with indices
};

}  // namespace cellmirror::display
