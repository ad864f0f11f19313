// GLSL 3.30 of the viewer. The light is the still pictures' (sim_host/view/picture.cpp): a key light from the viewer's
// upper left, a weak fill from the right, light from the sky, a highlight.
#pragma once

namespace palpate::shaders {

inline constexpr char kMesh[] = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 value;  // displacement, pressure
uniform mat4 projection, place;
uniform float pressed;  // 1: the pressure is shown
// Where a triangle covers a pixel in part, within that part: beyond its edge a normal at a rim is none.
centroid out vec3 at_w, normal_w;
out float shown;
void main() {
  vec4 world = place * vec4(position, 1.0);
  at_w = world.xyz;
  normal_w = mat3(place) * normal;
  shown = mix(value.x, value.y, pressed);
  gl_Position = projection * world;
})";

#define PALPATE_LIGHT                                                                                   \
  "uniform vec3 eye, right, up, back;\n"                                                                \
  "vec3 facing(vec3 n, vec3 view) { n = normalize(n); return dot(n, view) < 0.0 ? -n : n; }\n"          \
  "vec3 lit(vec3 base, vec3 n, vec3 view, float gloss) {\n"                                             \
  "  vec3 key = normalize(-0.55 * right + 0.75 * up + 0.55 * back);\n"                                  \
  "  vec3 fill = normalize(0.8 * right + 0.1 * up + 0.5 * back);\n"                                     \
  "  float light = 0.42 + 0.45 * max(0.0, dot(n, key)) + 0.14 * max(0.0, dot(n, fill)) + 0.10 * n.y;\n" \
  "  float shine = pow(max(0.0, dot(n, normalize(key + view))), 40.0);\n"                               \
  "  return base * light + gloss * shine;\n"                                                            \
  "}\n"

inline constexpr char kBody[] = "#version 330 core\n" PALPATE_LIGHT R"(
centroid in vec3 at_w, normal_w;
in float shown;
uniform sampler2D colours;
uniform float top, tick[12];
uniform int ticks;
uniform vec4 bare;  // paint instead of colours, where its last number is 1
out vec4 colour;
void main() {
  vec3 view = normalize(eye - at_w);
  vec3 base = mix(texture(colours, vec2(clamp(shown / top, 0.0, 1.0), 0.5)).rgb, bare.rgb, bare.a);
  vec3 c = lit(base, facing(normal_w, view), view, 0.10);
  float across = max(fwidth(shown), 1e-9), line = 0.0;
  for (int i = 1; i < ticks; ++i) line = max(line, 1.0 - smoothstep(0.4, 1.3, abs(shown - tick[i]) / across));
  // Where a tick's value is spread over many pixels there is no line to draw.
  if (across < 1e-4 * top || bare.a > 0.5) line = 0.0;
  colour = vec4(mix(c, vec3(0.122, 0.161, 0.2), 0.32 * line), 1.0);
})";

inline constexpr char kSolid[] = "#version 330 core\n" PALPATE_LIGHT R"(
centroid in vec3 at_w, normal_w;
in float shown;
uniform vec4 paint;      // colour and opacity
uniform float gloss, rim, plain;  // rim: opacity added where seen edge-on, like glass; plain: share without shading
out vec4 colour;
void main() {
  vec3 view = normalize(eye - at_w);
  vec3 n = facing(normal_w, view);
  float grazing = 1.0 - abs(dot(n, view));
  colour = vec4(mix(lit(paint.rgb, n, view, gloss), paint.rgb, plain), clamp(paint.a + rim * grazing * grazing, 0.0, 1.0));
})";

// Coverage alone: the rest shape's mask and the shadow.
inline constexpr char kCover[] = R"(#version 330 core
out vec4 colour;
void main() { colour = vec4(1.0); })";

inline constexpr char kWhole[] = R"(#version 330 core
out vec2 place;
void main() {
  place = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(place, 0.0, 1.0);
})";

// Paper, and the floor with a faint grid and the soft shadow of what stands over it.
inline constexpr char kBackground[] = R"(#version 330 core
in vec2 place;
uniform vec3 eye, right, up, back, centre;
uniform float slope, aspect, floor_y, half_size, grid;
uniform sampler2D shadow;
out vec4 colour;
float lines(vec2 at) {
  vec2 across = fwidth(at), from = abs(fract(at - 0.5) - 0.5) / max(across, vec2(1e-6));
  vec2 seen = (1.0 - smoothstep(0.3, 1.2, from)) * (1.0 - smoothstep(0.15, 0.45, across));
  return max(seen.x, seen.y);
}
void main() {
  float down = 0.5 - 0.5 * place.y;
  vec3 c = mix(vec3(0.992, 0.992, 0.996), vec3(0.89, 0.91, 0.933), down * down);
  vec3 ray = -back + slope * (aspect * place.x * right + place.y * up);
  float t = (floor_y - eye.y) / ray.y;
  vec2 at = eye.xz + t * ray.xz;
  vec2 from = (at - centre.xz) / half_size;
  float net = lines(at / grid);
  if (t > 0.0 && ray.y < 0.0) {
    float fade = 1.0 - smoothstep(0.55, 1.9, length(from));
    c = mix(c, vec3(0.45, 0.5, 0.56), 0.20 * net * fade);
    // What stands beyond the shadow's picture is cut off there: it fades before that.
    float edge = 1.0 - smoothstep(0.7, 0.97, max(abs(from.x), abs(from.y)));
    c = mix(c, vec3(0.169, 0.204, 0.251), 0.42 * edge * texture(shadow, 0.5 + 0.5 * clamp(from, -0.99, 0.99)).r);
  }
  colour = vec4(c, 1.0);
})";

// The shadow, softened: small, so that the floor costs one look per pixel.
inline constexpr char kBlur[] = R"(#version 330 core
in vec2 place;
uniform sampler2D shadow;
out vec4 colour;
void main() {
  float sum = 0.0, all = 0.0;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      float w = exp(-0.12 * float(i * i + j * j));
      sum += w * textureLod(shadow, 0.5 + 0.5 * place + vec2(i, j) * 0.012, 2.0).r;
      all += w;
    }
  colour = vec4(sum / all);
})";

// Where the rest shape's mask ends, dashed: drawn once for each new view, then laid over every picture.
inline constexpr char kOutline[] = R"(#version 330 core
in vec2 place;
uniform sampler2D mask;
uniform float thick;
out vec4 colour;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float low = 1.0, high = 0.0;
  int reach = int(thick);
  for (int i = -reach; i <= reach; ++i)
    for (int j = -reach; j <= reach; ++j) {
      float m = texelFetch(mask, clamp(at + ivec2(i, j), ivec2(0), textureSize(mask, 0) - 1), 0).r;
      low = min(low, m);
      high = max(high, m);
    }
  // Dashes along the edge: counted across where it runs across, and upward where it runs upward.
  vec2 slope = vec2(0.0);
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j)
      slope += vec2(i, j) * texelFetch(mask, clamp(at + ivec2(i, j), ivec2(0), textureSize(mask, 0) - 1), 0).r;
  float along = abs(slope.x) > abs(slope.y) ? gl_FragCoord.y : gl_FragCoord.x;
  float dash = mod(along, 10.0 * thick) < 6.0 * thick ? 1.0 : 0.0;
  colour = vec4(dash * (high - low));
})";

inline constexpr char kLay[] = R"(#version 330 core
uniform sampler2D outline;
out vec4 colour;
void main() {
  float there = texelFetch(outline, ivec2(gl_FragCoord.xy), 0).r;
  if (there == 0.0) discard;
  colour = vec4(0.357, 0.4, 0.447, 0.75 * there);
})";

#undef PALPATE_LIGHT

}  // namespace palpate::shaders
