#include "tests/articulate/round_cones.h"

#include <cmath>
#include <vector>

#include "rt_core/vec.h"

namespace palpate::test {

double left_in_round_cones_N(const Grasp& grasp, double scale) {
  struct Unknown {
    Vec3 arm, push;
    double most_N, mu;  // finger: friction; palm: mu > 0
    Vec3 force, ahead;
  };
  std::vector<Unknown> all;
  const auto arm = [&](Vec3 at) { return (1 / grasp.length_m) * (at - grasp.centre_w); };
  Vec3 fixed_N = grasp.weight_N, fixed_turn;
  double steep = 0;
  for (const GraspContact& f : grasp.finger) {
    all.push_back({arm(f.position_w), f.push_w, scale * f.friction_N, 0, {}, {}});
    fixed_N += f.normal_N * f.push_w;
    fixed_turn += cross(all.back().arm, f.normal_N * f.push_w);
  }
  for (const GraspContact& p : grasp.palm)
    all.push_back({arm(p.position_w), p.push_w, 0, scale * p.friction_N + 1e-12, {}, {}});
  for (const Unknown& u : all) steep += 1 + squared_norm(u.arm);
  const auto nearest = [](const Unknown& u, Vec3 f) {
    const double n = dot(f, u.push);
    const Vec3 t = tangential_part(f, u.push);
    const double size = norm(t);
    if (u.most_N > 0) return size > u.most_N ? (u.most_N / size) * t : t;
    if (size <= u.mu * n) return f;
    const double on = (n + u.mu * size) / (1 + u.mu * u.mu);  // along the cone's side
    return on > 0 ? on * (u.push + (u.mu / size) * t) : Vec3{};
  };
  double momentum = 1, left = 0;
  for (int i = 0; i < 30000; ++i) {
    Vec3 n = fixed_N, m = fixed_turn;
    for (const Unknown& u : all) n += u.ahead, m += cross(u.arm, u.ahead);
    left = std::sqrt(squared_norm(n) + squared_norm(m));
    const double next = 0.5 * (1 + std::sqrt(1 + 4 * momentum * momentum));
    for (Unknown& u : all) {
      const Vec3 to = nearest(u, u.ahead - (1 / steep) * (n + cross(m, u.arm)));
      u.ahead = to + ((momentum - 1) / next) * (to - u.force);
      u.force = to;
    }
    momentum = next;
  }
  return left;
}

}  // namespace palpate::test
