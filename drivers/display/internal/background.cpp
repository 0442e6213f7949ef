#include "drivers/display/internal/background.hpp"

#include <array>

#include "drivers/display/internal/shaders.hpp"

namespace cellmirror::display {

Result<void> Background::build() {
  if (Result<void> built = program_.build(shaders::kBackgroundVertex, shaders::kBackgroundFragment); !built)
    return built;
  constexpr std::array<float, 3> kUpper = {0.965F, 0.973F, 0.984F};
  constexpr std::array<float, 3> kLower = {0.800F, 0.824F, 0.855F};
  program_.use();
  gl_.Uniform3fv(program_.uniform("upper"), 1, kUpper.data());
  gl_.Uniform3fv(program_.uniform("lower"), 1, kLower.data());
  gl_.GenVertexArrays(1, &array_);
  return {};
}

void Background::draw() {
  program_.use();
  gl_.BindVertexArray(array_);
  gl_.DepthMask(GL_FALSE);
  gl_.DepthFunc(GL_LEQUAL);
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.DepthFunc(GL_LESS);
  gl_.DepthMask(GL_TRUE);
}

}  // namespace cellmirror::display
