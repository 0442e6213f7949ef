#include "drivers/display/internal/tissue/veil_pass.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/display/internal/tissue/tissue_shaders.hpp"

namespace cellmirror::display {

namespace {

float share_of(double value) { return std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : 0.0F; }

}  // namespace

Result<void> VeilPass::build() {
  if (Result<void> built = program_.build(shaders::kVeilVertex, shaders::kVeilFragment); !built) return built;
  gl_.GenVertexArrays(1, &array_);
  return {};
}

void VeilPass::draw(const Frame& frame, double fog, double haze) {
  const float on_lens = share_of(fog);
  const float in_air = share_of(haze);
  if (frame.camera == 0 || !(on_lens + in_air > 0)) return;
  program_.use();
  gl_.Uniform1f(program_.uniform("fog"), on_lens);
  gl_.Uniform1f(program_.uniform("haze"), in_air);
  gl_.BindVertexArray(array_);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Enable(GL_BLEND);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.Disable(GL_BLEND);
  gl_.Enable(GL_DEPTH_TEST);
}

}  // namespace cellmirror::display
