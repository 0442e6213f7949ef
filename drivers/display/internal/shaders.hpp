// The shaders, GLSL 3.30. Attribute 0 is the position, 1 the normal, 2 the place in a picture, 3 a colour. Private to
// this folder.
#pragma once

#include <string_view>

namespace cellmirror::display::shaders {

// Light is reckoned a vertex and in linear light, where sRGB is taken for a square: close enough, and cheap in
// software. PLAIN: without light. TWO_SIDED: back faces are lit as if they were front faces. TEXTURED: rgb is white.
inline constexpr std::string_view kBodyVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 clip_from_mesh;
uniform mat3 world_from_normal;
uniform vec3 rgb;
uniform float alpha;
uniform vec3 to_eye;
out vec4 front;
#ifdef TWO_SIDED
out vec4 back;
#endif
#ifdef TEXTURED
layout(location = 2) in vec2 place;
layout(location = 3) in vec4 tint_in;
out vec2 at;
out vec3 tint;
#endif

// Sky and ground, a key light from above that is also the one of the shadows, and a little light from the eye.
vec3 light(vec3 n) {
  vec3 around = mix(vec3(0.27, 0.26, 0.26), vec3(0.60, 0.64, 0.70), 0.5 * n.z + 0.5);
  float key = max(dot(n, vec3(-0.3778, -0.4498, 0.8096)), 0.0);
  float fill = max(dot(n, to_eye), 0.0);
  return around + key * vec3(0.50, 0.48, 0.44) + fill * vec3(0.20, 0.20, 0.21);
}

void main() {
  gl_Position = clip_from_mesh * vec4(position, 1.0);
#ifdef TEXTURED
  at = place;
  tint = tint_in.rgb;
#endif
#ifdef PLAIN
  front = vec4(rgb, alpha);
#else
  vec3 n = normalize(world_from_normal * normal);
  vec3 linear = rgb * rgb;
  front = vec4(sqrt(linear * light(n)), alpha);
#ifdef TWO_SIDED
  back = vec4(sqrt(linear * light(-n)), alpha);
#endif
#endif
}
)";

// STRIPES: a second sign beside the colour. TEXTURED: roots of light and colour are multiplied, since both are sRGB;
// the picture's colour is multiplied by its alpha already, and a mark covers it as it covers any other colour.
inline constexpr std::string_view kBodyFragment = R"(
in vec4 front;
#ifdef TWO_SIDED
in vec4 back;
#endif
#ifdef TEXTURED
in vec2 at;
in vec3 tint;
uniform sampler2D picture;
uniform vec3 material;
uniform vec3 own;
uniform vec4 over;
#endif
layout(location = 0) out vec4 colour;

void main() {
#ifdef TWO_SIDED
  colour = gl_FrontFacing ? front : back;
#else
  colour = front;
#endif
#ifdef TEXTURED
  vec4 texel = texture(picture, at);
  vec3 surface = texel.rgb * material * tint + (1.0 - texel.a) * own;
  colour.rgb *= mix(surface, over.rgb, over.a);
#endif
#ifdef STRIPES
  float across = fract((gl_FragCoord.x + gl_FragCoord.y) / 14.0);
  colour.rgb = mix(colour.rgb, vec3(0.24, 0.04, 0.02), 0.55 * (1.0 - smoothstep(0.22, 0.30, abs(across - 0.5))));
#endif
}
)";

inline constexpr std::string_view kObjectFragment = R"(
uniform uint object;
layout(location = 0) out uint number;
void main() { number = object; }
)";

// One triangle over the whole pane, paler at its top.
inline constexpr std::string_view kBackgroundVertex = R"(
out float down;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  down = 0.5 * corner.y + 0.5;
  gl_Position = vec4(corner, 1.0, 1.0);
}
)";

inline constexpr std::string_view kBackgroundFragment = R"(
in float down;
uniform vec3 upper;
uniform vec3 lower;
layout(location = 0) out vec4 colour;
void main() { colour = vec4(mix(upper, lower, down), 1.0); }
)";

// Ribbons: attribute 1 is the colour, 2 the shape (ribbons.hpp).
inline constexpr std::string_view kRibbonVertex = R"(
layout(location = 0) in vec3 place;
layout(location = 1) in vec4 rgba;
layout(location = 2) in vec4 shape_in;
out vec4 tint;
out vec4 shape;
void main() {
  tint = rgba;
  shape = shape_in;
  gl_Position = vec4(place, 1.0);
}
)";

inline constexpr std::string_view kRibbonFragment = R"(
in vec4 tint;
in vec4 shape;
layout(location = 0) out vec4 colour;
void main() {
  float a;
  if (shape.y < 0.0) {
    a = max(0.0, 1.0 - dot(shape.xz, shape.xz));
    a *= a;
  } else {
    a = clamp(shape.y + 0.5 - abs(shape.x), 0.0, 1.0);
    if (shape.w > 0.0 && fract(shape.z / shape.w) > 0.58) a = 0.0;
  }
  colour = vec4(tint.rgb, tint.a * a);
}
)";

// The floor is at a height in W; its colour fades out to its edge. ALONE: nothing but the shadow.
inline constexpr std::string_view kFloorVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in float alpha_in;
uniform mat4 clip_from_world;
uniform vec4 shadow_part;  // x, y of a corner in W, and 1 / its edges
out float alpha;
out vec2 shadow_at;
out vec2 metres;
void main() {
  alpha = alpha_in;
  shadow_at = (position.xy - shadow_part.xy) * shadow_part.zw;
  metres = position.xy;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

inline constexpr std::string_view kFloorFragment = R"(
in float alpha;
in vec2 shadow_at;
in vec2 metres;
uniform vec3 rgb;
uniform sampler2D shadow;
uniform sampler2D tiles;
layout(location = 0) out vec4 colour;
void main() {
  vec3 ground = rgb;
#ifdef TEXTURED
  ground *= texture(tiles, 0.5 * metres).r + 0.125;
#endif
#ifdef ALONE  // darkens what is there
  float dark = texture(shadow, shadow_at).r * 0.72;
  colour = vec4(0.03, 0.04, 0.06, dark);
  return;
#elif defined(SHADOW)
  ground *= 1.0 - texture(shadow, shadow_at).r * vec3(0.80, 0.78, 0.74);
#endif
  colour = vec4(ground, alpha);
}
)";

// Where bodies keep the light from the floor: in red what is low and casts sharp shadows, in green all.
inline constexpr std::string_view kShadowVertex = R"(
layout(location = 0) in vec3 position;
uniform mat4 shadow_from_mesh;
uniform vec4 height_of_mesh;
out float height;
void main() {
  height = dot(height_of_mesh, vec4(position, 1.0));
  gl_Position = shadow_from_mesh * vec4(position, 1.0);
}
)";

inline constexpr std::string_view kShadowFragment = R"(
in float height;
uniform float low;
layout(location = 0) out vec2 covered;
void main() {
  if (height < -0.005) discard;
  covered = vec2(clamp(1.0 - height / low, 0.0, 1.0), 1.0);
}
)";

}  // namespace cellmirror::display::shaders
