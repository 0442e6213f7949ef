// A linked vertex and fragment shader. Private to this folder.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "drivers/display/internal/gl_api.hpp"

namespace cellmirror::display {

class ShaderProgram {
 public:
  explicit ShaderProgram(const GlApi& gl) : gl_(gl) {}
  ~ShaderProgram() {
    if (program_ != 0) gl_.DeleteProgram(program_);
  }
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;

  // `defines` are names for #ifdef in the shaders. The shaders set the locations of attributes.
  Result<void> build(std::string_view vertex, std::string_view fragment,
                     std::initializer_list<std::string_view> defines = {});
  void use() const { gl_.UseProgram(program_); }
  // A name that the linked program has no use for answers -1, which OpenGL ignores.
  [[nodiscard]] GLint uniform(const char* name) const { return gl_.GetUniformLocation(program_, name); }

 private:
  const GlApi& gl_;
  GLuint program_ = 0;
};

}  // namespace cellmirror::display
