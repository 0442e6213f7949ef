// The shaders that lay a picture of volumes over a pane, GLSL 3.30. Private to this folder.
#pragma once

#include <string_view>

namespace cellmirror::display::shaders {

inline constexpr std::string_view kVolumeVertex = R"(
uniform vec4 part;  // of the texture that the pane shows: width, height
out vec2 at;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 2.0 : 0.0, gl_VertexID == 2 ? 2.0 : 0.0);
  at = corner * part.xy;
  gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
}
)";

inline constexpr std::string_view kVolumeFragment = R"(
in vec2 at;
uniform sampler2D picture;
layout(location = 0) out vec4 colour;
void main() {
#ifdef DEPTH
  float depth = texture(picture, at).r;
  if (depth >= 1.0) discard;
  gl_FragDepth = depth;
  colour = vec4(0.0);
#else
  colour = texture(picture, at);
#endif
}
)";

}  // namespace cellmirror::display::shaders
