// The background: a pale sky, so that bodies of any colour stand out. Private to this folder.
#pragma once

#include "drivers/display/internal/shader_program.hpp"

namespace cellmirror::display {

class Background {
 public:
  explicit Background(const GlApi& gl) : gl_(gl), program_(gl) {}
  ~Background() {
    if (array_ != 0) gl_.DeleteVertexArrays(1, &array_);
  }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  Result<void> build();
  // Where nothing has been drawn in the viewport yet: after what is opaque, so that little has to be filled.
  void draw();

 private:
  const GlApi& gl_;
  ShaderProgram program_;
  GLuint array_ = 0;  // without attributes: OpenGL wants one bound
};

}  // namespace cellmirror::display
