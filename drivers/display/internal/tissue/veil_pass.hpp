// Fog on the lens of a camera, and smoke in the air before it. Private to this folder.
#pragma once

#include "drivers/display/internal/frame.hpp"
#include "drivers/display/internal/shader_program.hpp"

namespace cellmirror::display {

class VeilPass {
 public:
  explicit VeilPass(const GlApi& gl) : gl_(gl), program_(gl) {}
  ~VeilPass() {
    if (array_ != 0) gl_.DeleteVertexArrays(1, &array_);
  }
  VeilPass(const VeilPass&) = delete;
  VeilPass& operator=(const VeilPass&) = delete;

  Result<void> build();
  // Over the whole pane, 0 to 1 each. Draws nothing where both are 0 or not finite, or where the pane shows no camera.
  void draw(const Frame& frame, double fog, double haze);

 private:
  const GlApi& gl_;
  ShaderProgram program_;
  GLuint array_ = 0;  // without attributes: OpenGL wants one bound
};

}  // namespace cellmirror::display
