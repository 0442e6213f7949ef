// Draws ribbons. Private to this folder.
#pragma once

#include "drivers/display/internal/ribbons.hpp"
#include "drivers/display/internal/shader_program.hpp"

namespace cellmirror::display {

class RibbonPass {
 public:
  explicit RibbonPass(const GlApi& gl) : gl_(gl), program_(gl) {}
  ~RibbonPass();
  RibbonPass(const RibbonPass&) = delete;
  RibbonPass& operator=(const RibbonPass&) = delete;

  Result<void> build();
  // Blended over what is there; leaves depth alone, and is hidden by what is before it unless `on_top`.
  void draw(const Ribbons& ribbons, bool on_top);

 private:
  const GlApi& gl_;
  ShaderProgram program_;
  GLuint array_ = 0;
  GLuint vertices_ = 0;
  GLuint indices_ = 0;
};

}  // namespace cellmirror::display
