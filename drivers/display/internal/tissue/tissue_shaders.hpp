// The shaders of deforming surfaces, fluids, particles and networks, GLSL 3.30. Unlike bodies, they are lit a pixel:
// the highlights of wet surfaces are smaller than their triangles. Private to this folder.
#pragma once

#include <string_view>

namespace cellmirror::display::shaders {

// Goes before the fragment shaders that use it. Colours are linear: the square of sRGB.
inline constexpr std::string_view kWetLight = R"(
const vec3 key_from = vec3(-0.3778, -0.4498, 0.8096);

// As that of bodies: sky and ground, the key light, a little light from the eye.
vec3 diffuse(vec3 n, vec3 to_eye) {
  vec3 around = mix(vec3(0.27, 0.26, 0.26), vec3(0.60, 0.64, 0.70), 0.5 * n.z + 0.5);
  float key = max(dot(n, key_from), 0.0);
  float fill = max(dot(n, to_eye), 0.0);
  return around + key * vec3(0.50, 0.48, 0.44) + fill * vec3(0.20, 0.20, 0.21);
}

float power_of_64(float x) {
  x *= x;
  x *= x;
  x *= x;
  x *= x;
  x *= x;
  return x * x;
}

// Reflectance of water at this angle, by Schlick's approximation.
float fresnel(float facing) {
  float grazing = 1.0 - facing;
  float squared = grazing * grazing;
  return 0.02 + 0.98 * squared * squared * grazing;
}

// What a film of water reflects, v is towards the eye: the key light, the light at the eye (Blinn and Phong), and the
// surroundings at grazing angles.
vec3 film(vec3 n, vec3 v) {
  float facing = clamp(dot(n, v), 0.0, 1.0);
  vec3 mirrored = 2.0 * facing * n - v;
  vec3 around = mix(vec3(0.20, 0.17, 0.17), vec3(0.80, 0.85, 0.92), smoothstep(-0.3, 0.6, mirrored.z));
  float lit = step(0.0, dot(n, key_from));
  float key = lit * power_of_64(max(dot(n, normalize(key_from + v)), 0.0));
  return key * key * vec3(1.00, 0.98, 0.95) + 0.22 * power_of_64(facing) + 0.55 * fresnel(facing) * around;
}
)";

// World coordinates. The normal's fourth part is half of the burn. The film of water on a wet surface is uneven: its
// normal is tilted by some degrees, otherwise at each vertex, so that highlights are broken as on an organ and not
// round as on a ball.
inline constexpr std::string_view kTissueVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec4 normal_and_burn;
layout(location = 2) in vec2 place;
layout(location = 3) in vec4 skin_in;
uniform mat4 clip_from_world;
out vec3 at;
out vec3 normal;
out float burn;
out vec3 skin;
out vec3 tilt;
#ifdef TEXTURED
out vec2 in_picture;
#endif

// Wang's hash.
uint scrambled(uint value) {
  value = (value ^ 61u) ^ (value >> 16u);
  value *= 9u;
  value ^= value >> 4u;
  value *= 668265261u;
  return value ^ (value >> 15u);
}

void main() {
  uint dice = scrambled(uint(gl_VertexID));
  tilt = 0.16 * (vec3(uvec3(dice, dice >> 10u, dice >> 20u) & 1023u) / 1023.0 - 0.5);
  at = position;
  normal = normal_and_burn.xyz;
  burn = 2.0 * normal_and_burn.w;
  skin = skin_in.rgb;
#ifdef TEXTURED
  in_picture = place;
#endif
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

// FLAT: each triangle has its own normal. PLAIN: without light, as the lines of wireframes are. Both sides are lit.
inline constexpr std::string_view kTissueFragment = R"(
in vec3 at;
in vec3 normal;
in float burn;
in vec3 skin;
in vec3 tilt;
uniform vec4 eye;     // a point (w = 1) or, of parallel views, the direction to it
uniform vec3 to_eye;  // the eye's axis
uniform float wet;
uniform float raw;    // 1: a face that was cut
uniform float alpha;
#ifdef TEXTURED
in vec2 in_picture;
uniform sampler2D picture;
uniform vec3 material;
#endif
layout(location = 0) out vec4 colour;

void main() {
  vec3 surface = skin;
#ifdef TEXTURED
  vec4 texel = texture(picture, in_picture);
  surface = texel.rgb * material + (1.0 - texel.a) * skin;
#endif
  surface = mix(surface, vec3(0.47, 0.05, 0.06), 0.85 * raw);
  float coagulated = clamp(burn, 0.0, 1.0);
  surface = mix(surface, vec3(0.36, 0.22, 0.12), 0.85 * coagulated);
  surface = mix(surface, vec3(0.05, 0.045, 0.04), 0.96 * clamp(burn - 1.0, 0.0, 1.0));
#ifdef PLAIN
  colour = vec4(0.55 * surface, alpha);
#else
  vec3 v = normalize(eye.xyz - eye.w * at);
#ifdef FLAT
  vec3 n = normalize(cross(dFdx(at), dFdy(at)));
  if (dot(n, v) < 0.0) n = -n;
#else
  vec3 n = normalize(normal);
  if (!gl_FrontFacing) n = -n;
#endif
  vec3 light = surface * surface * diffuse(n, to_eye);
  vec3 gloss = film(normalize(n + tilt), v) * wet * (1.0 - 0.95 * coagulated) * (1.0 - 0.5 * raw);
  colour = vec4(sqrt(light + gloss), max(alpha, gloss.g));
#endif
}
)";

// The surface of a fluid, world coordinates: see-through, but not where it reflects.
inline constexpr std::string_view kPoolVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_in;
uniform mat4 clip_from_world;
out vec3 at;
out vec3 normal;
void main() {
  at = position;
  normal = normal_in;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

inline constexpr std::string_view kPoolFragment = R"(
in vec3 at;
in vec3 normal;
uniform vec4 eye;
uniform vec3 to_eye;
uniform vec4 rgba;
layout(location = 0) out vec4 colour;
void main() {
  vec3 v = normalize(eye.xyz - eye.w * at);
  vec3 n = normalize(normal);
  if (dot(n, v) < 0.0) n = -n;
  float sky = smoothstep(0.1, 1.0, reflect(-v, n).z);  // more than water has, so that ripples are seen from above, too
  vec3 gloss = film(n, v) + 0.10 * sky;
  vec3 light = rgba.rgb * rgba.rgb * diffuse(n, to_eye) + gloss;
  colour = vec4(sqrt(light), clamp(rgba.a + gloss.g, 0.0, 1.0));
}
)";

// Discs that face the eye. SMOKE: soft; else lit as spheres.
inline constexpr std::string_view kParticleVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 across_in;
layout(location = 2) in vec4 rgba;
uniform mat4 clip_from_world;
out vec2 across;
out vec4 tint;
void main() {
  across = across_in;
  tint = rgba;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

inline constexpr std::string_view kParticleFragment = R"(
in vec2 across;
in vec4 tint;
uniform mat3 world_from_eye;
layout(location = 0) out vec4 colour;
void main() {
  float beside = dot(across, across);
  if (beside > 1.0) discard;
#ifdef SMOKE
  float dense = (1.0 - beside) * (1.0 - beside);
  colour = vec4(tint.rgb, tint.a * dense);
#else
  vec3 v = world_from_eye[2];
  vec3 n = world_from_eye * vec3(across, sqrt(1.0 - beside));
  vec3 gloss = film(n, v);
  colour = vec4(sqrt(tint.rgb * tint.rgb * diffuse(n, v) + gloss), max(tint.a, tint.a * gloss.g));
#endif
}
)";

// Nodes of a network: the corners of a tetrahedron about each; LINKS: lines between the nodes themselves.
inline constexpr std::string_view kNetworkVertex = R"(
layout(location = 0) in vec4 node;  // and how large it is, 1: as usual
layout(location = 1) in vec4 rgba;
uniform mat4 clip_from_world;
uniform vec3 to_eye;
uniform float radius_m;
uniform float smallest;  // m at a distance of 1 m: so that it can be seen
out vec4 tint;

const vec3 corners[4] = vec3[4](vec3(0.577, 0.577, 0.577), vec3(-0.577, -0.577, 0.577), vec3(-0.577, 0.577, -0.577),
                                vec3(0.577, -0.577, -0.577));

void main() {
#ifdef LINKS
  tint = vec4(0.42, 0.42, 0.48, 1.0);
  gl_Position = clip_from_world * vec4(node.xyz, 1.0);
#else
  vec4 centre = clip_from_world * vec4(node.xyz, 1.0);
  vec3 corner = corners[gl_VertexID % 4];
  float radius = node.w * max(radius_m, smallest * centre.w);
  float light = 0.55 + 0.25 * corner.z + 0.30 * max(dot(corner, to_eye), 0.0);
  tint = vec4(rgba.rgb * sqrt(light), 1.0);
  gl_Position = clip_from_world * vec4(node.xyz + radius * corner, 1.0);
#endif
}
)";

inline constexpr std::string_view kNetworkFragment = R"(
in vec4 tint;
layout(location = 0) out vec4 colour;
void main() { colour = tint; }
)";

// Before the lens: fog is denser towards the edge of the picture, haze is even.
inline constexpr std::string_view kVeilVertex = R"(
out vec2 across;
void main() {
  across = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(across, 0.0, 1.0);
}
)";

inline constexpr std::string_view kVeilFragment = R"(
in vec2 across;
uniform float fog;
uniform float haze;
layout(location = 0) out vec4 colour;
void main() {
  float on_lens = fog * mix(0.72, 0.95, min(0.5 * dot(across, across), 1.0));
  float in_air = 0.45 * haze;
  float left = (1.0 - on_lens) * (1.0 - in_air);
  vec3 mixed = mix(vec3(0.58, 0.58, 0.60), vec3(0.82, 0.84, 0.86), on_lens / max(on_lens + in_air, 1e-4));
  colour = vec4(mixed, 1.0 - left);
}
)";

}  // namespace cellmirror::display::shaders
