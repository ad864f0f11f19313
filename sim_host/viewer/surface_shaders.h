// GLSL 3.30 that evaluates an elastic body's surface (shader_surface.h): the formulas of
// sim_host/view/elastic_surface.cpp and deformed_surface.cpp.
#pragma once

namespace palpate::shaders {

// A vertex of the model: displacement by its modes, sum of shape times amplitude.
inline constexpr char kModes[] = R"(#version 330 core
uniform samplerBuffer shapes, amplitudes;
uniform int terms;
out vec4 displaced;
void main() {
  vec3 sum = vec3(0.0);
  for (int t = 0; t < terms; ++t)
    sum += texelFetch(amplitudes, t).r * texelFetch(shapes, gl_VertexID * terms + t).xyz;
  displaced = vec4(sum, 0.0);
})";

// A point of the refined surface: modes straight between the model's vertices, and every tip's dent (TipDent::at).
inline constexpr char kPoints[] = R"(#version 330 core
layout(location = 0) in vec3 rest;
layout(location = 1) in vec3 normal;
layout(location = 2) in uvec3 base;
layout(location = 3) in vec3 share;
uniform samplerBuffer carried, dent;
uniform int dents;
out vec4 placed;  // position, length of the displacement
out float pressure;
const float pi = 3.14159265358979;
float profile(float rho) {
  if (!(rho > 1.0)) return 1.0 - 0.5 * rho * rho;
  float root = sqrt((rho - 1.0) * (rho + 1.0)), s = 1.0 / (rho * rho);
  // Beyond, two large numbers are nearly the same: the series in 1 / rho instead, good to 5e-6 of itself.
  if (rho > 2.0) return (4.0 / 3.0 + s * (2.0 / 15.0 + s * (3.0 / 70.0 + s * (5.0 / 252.0 + s * 0.011048)))) / (pi * rho);
  return ((2.0 - rho * rho) * atan(1.0, root) + root) / pi;
}
float drawn_in(float rho) {
  if (rho > 1.0) return 1.0 / rho;
  float s = sqrt((1.0 - rho) * (1.0 + rho));
  return rho * (1.0 + s + s * s) / (1.0 + s);
}
float spread(float rho, float nu) {
  float back = 0.028 * (1.0 - 2.0 * nu);
  if (rho > 1.0) return (0.075 / (rho * rho) - 0.082 + back) / (rho * rho * rho);
  return rho * (0.146 - (0.153 - back) * rho * rho);
}
// How much higher a ball is at some distance from its lowest place.
float ball_sag(float ball, float from) {
  float within = min(from, 0.98 * ball);
  return within * within / (ball + sqrt((ball - within) * (ball + within)));
}
float fade_out(float way) {
  float s = clamp(way, 0.0, 1.0);
  return (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s);
}
// Beyond the edge, by ellipses with its foci (ContactEllipse::radii_outside).
float outside(float x2, float y2, float long2, float across2) {
  float b = x2 + y2 - long2 - across2, c = x2 * across2 + y2 * long2 - long2 * across2;
  float t = max(0.5 * (b + sqrt(max(b * b + 4.0 * c, 0.0))), 0.0);
  return sqrt(sqrt((1.0 + t / long2) * (1.0 + t / across2)));
}
void main() {
  vec3 u = share.x * texelFetch(carried, int(base.x)).xyz + share.y * texelFetch(carried, int(base.y)).xyz +
           share.z * texelFetch(carried, int(base.z)).xyz;
  pressure = 0.0;
  for (int i = 0; i < dents; ++i) {
    vec4 foot = texelFetch(dent, 7 * i);  // at rest; depth
    vec4 inward = texelFetch(dent, 7 * i + 1), along = texelFetch(dent, 7 * i + 2);  // at rest; half axes across, along
    vec4 more = texelFetch(dent, 7 * i + 3);  // mean, edge, far, drawn in
    vec4 last = texelFetch(dent, 7 * i + 4);  // spread, reach, ball, bend
    vec4 now = texelFetch(dent, 7 * i + 5);   // inward; out
    vec3 inward_now = now.xyz, along_now = texelFetch(dent, 7 * i + 6).xyz;
    float nu = texelFetch(dent, 7 * i + 6).w;
    vec3 from = rest - foot.xyz;
    float how = clamp(-2.0 * dot(normal, inward.xyz), 0.0, 1.0) * fade_out(2.0 * length(from) / last.y - 1.0);
    if (!(how > 0.0)) continue;
    float x = dot(from, along.xyz), y = length(from - x * along.xyz);
    float rho = length(vec2(x / along.w, y / inward.w)), deep, moved;
    if (rho < 1.0) {
      pressure += more.x * 1.5 * sqrt((1.0 - rho) * (1.0 + rho));
      moved = last.x * spread(rho, nu) - more.w * drawn_in(rho);
      float how_high = rho * rho;  // TipDent::sag_share
      if (last.z > 0.0) {
        float width = sqrt(inward.w * along.w);
        float edge = ball_sag(last.z, max(width + last.x * spread(1.0, nu) - more.w * drawn_in(1.0) + now.w, 0.0)) + last.w;
        float here = ball_sag(last.z, max(rho * width + moved + now.w * rho, 0.0)) + last.w * rho * rho;
        if (edge > 0.1 * foot.w) how_high = here / edge;
      }
      deep = foot.w - (foot.w - more.y) * how_high;
    } else {
      rho = outside(x * x, y * y, along.w * along.w, inward.w * inward.w);
      deep = profile(rho) * (more.z + (2.0 * more.y - more.z) / (rho * rho));
      moved = last.x * spread(rho, nu) - more.w * drawn_in(rho);
    }
    float narrow = inward.w / along.w;
    vec3 outward = narrow * narrow * x * along_now + dot(from, cross(inward.xyz, along.xyz)) * cross(inward_now, along_now);
    float far = length(outward);
    if (far > 0.0) outward /= far;
    u += how * (deep * inward_now + moved * outward);
  }
  placed = vec4(rest + u, length(u));
})";

// A drawn vertex: its normal at rest turned as the surface around it turns (RefinedBody::turn_normals). `of`: its
// point, where its ring of triangles begins, and of how many it is; below zero: the vertex lies on a crease, and turns
// with the one triangle of its side.
inline constexpr char kCorners[] = R"(#version 330 core
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 rest;  // normal at rest: of the point, or of the triangle
layout(location = 2) in ivec3 of;
uniform samplerBuffer placed, pressures;
uniform isamplerBuffer ring;
out vec3 position, normal;
out float displacement, pressure;
void main() {
  vec4 here = texelFetch(placed, of.x);
  vec3 sum = vec3(0.0), unit = vec3(0.0);
  for (int i = 0; i < abs(of.z); ++i) {
    ivec2 two = texelFetch(ring, of.y + i).xy;
    vec3 a = texelFetch(placed, two.x).xyz - here.xyz, b = texelFetch(placed, two.y).xyz - here.xyz, c = cross(a, b);
    float area = length(c);
    unit = area > 0.0 ? c / area : vec3(0.0);
    sum += atan(area, dot(a, b)) * unit;
  }
  if (of.z >= 0) {
    vec3 now = length(sum) > 0.0 ? normalize(sum) : vec3(0.0, 0.0, 1.0);
    vec3 turned = corner + now - rest;
    normal = length(turned) > 0.0 ? normalize(turned) : now;
  } else {
    vec3 axis = cross(rest, unit), once = cross(axis, corner);
    normal = corner + once + cross(axis, once) / max(1.0 + dot(rest, unit), 1e-6);
  }
  position = here.xyz;
  displacement = here.w;
  pressure = texelFetch(pressures, of.x).r;
})";

}  // namespace palpate::shaders
