#include "drivers/display/internal/shader_program.hpp"

#include <array>

namespace cellmirror::display {

namespace {

constexpr GLsizei kLongestLog = 1024;

Result<GLuint> compile(const GlApi& gl, GLenum stage, const std::string& head, std::string_view body) {
  const GLuint shader = gl.CreateShader(stage);
  const std::array<const char*, 2> sources = {head.data(), body.data()};
  const std::array<GLint, 2> lengths = {static_cast<GLint>(head.size()), static_cast<GLint>(body.size())};
  gl.ShaderSource(shader, 2, sources.data(), lengths.data());
  gl.CompileShader(shader);
  GLint done = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done != 0) return shader;
  std::array<char, kLongestLog> log{};
  gl.GetShaderInfoLog(shader, kLongestLog, nullptr, log.data());
  gl.DeleteShader(shader);
  return fail(std::string("the graphics driver refuses a shader: ") + log.data(), "use another driver of OpenGL 3.3");
}

}  // namespace

Result<void> ShaderProgram::build(std::string_view vertex, std::string_view fragment,
                                  std::initializer_list<std::string_view> defines) {
  std::string head = "#version 330 core\n";
  for (const std::string_view name : defines) head += "#define " + std::string(name) + "\n";
  const Result<GLuint> first = compile(gl_, GL_VERTEX_SHADER, head, vertex);
  if (!first) return std::unexpected(first.error());
  const Result<GLuint> second = compile(gl_, GL_FRAGMENT_SHADER, head, fragment);
  if (!second) {
    gl_.DeleteShader(*first);
    return std::unexpected(second.error());
  }
  program_ = gl_.CreateProgram();
  gl_.AttachShader(program_, *first);
  gl_.AttachShader(program_, *second);
  gl_.LinkProgram(program_);
  gl_.DeleteShader(*first);
  gl_.DeleteShader(*second);
  GLint done = 0;
  gl_.GetProgramiv(program_, GL_LINK_STATUS, &done);
  if (done != 0) return {};
  std::array<char, kLongestLog> log{};
  gl_.GetProgramInfoLog(program_, kLongestLog, nullptr, log.data());
  return fail(std::string("the graphics driver refuses a program: ") + log.data(), "use another driver of OpenGL 3.3");
}

}  // namespace cellmirror::display
