// How the force on a tool changes with its pose while the body's modes give way: contacts are springs between tool and
// modes, and the modes are eliminated. With j = [what the modes make of a spring's length; its direction; its turn],
//   J = diag(H, 0) + sum k j j^T,     K = J_tt - J_tm J_mm^-1 J_mt,
// over the normals, with the stiffness of the places alone, and friction's two axes. Taken one by one, each in series
// with what the modes give under it alone, contacts that share modes are neither as soft together nor as stiff against
// one another as they are: between two fingers a soft body sways, and its sway is no part of what a squeeze moves; an
// arm that gives along one direction is as stiff as the place in every other. K is no less than zero, as H is.
#pragma once

#include <type_traits>
#include <utility>

#include "rt_core/contact/contact_stiffness.h"
#include "rt_core/lanes.h"
#include "rt_core/limits.h"
#include "rt_core/tool/two_tools.h"

namespace palpate {

// Modes, then the twist of each hand's tool. Size: of both, known to the compiler where the modes' number is.
struct ToolTangent {
  static constexpr std::int32_t kTwist = 6, kMost = whole_lanes(kMaxSoftModes + 2 * kTwist, 4);

  // A spring's slope in all of them.
  struct Spring {
    Real slope[kMost];
  };

  // No spring yet; `modes`: H, soft x soft, of which the lower triangle is read.
  template <class Size, class Count>
  void begin(Size size, Count soft, const Real* modes) PALPATE_RT {
    for (std::int32_t i = 0; i < size; ++i) {  // bound: kMost^2 / 8
      for (std::int32_t b = i / 4 * 4; b < size; b += 4) store(joint[i] + b, Double4{});
    }
    for (std::int32_t i = 0; i < soft; ++i) {  // bound: soft^2 / 2
      for (std::int32_t j = 0; j <= i; ++j) joint[j][i] = modes[i * soft + j];
    }
  }
  // The springs that `other` has, before it is eliminated.
  template <class Size>
  void begin_as(Size size, const ToolTangent& other) PALPATE_RT {
    for (std::int32_t i = 0; i < size; ++i) {  // bound: kMost^2 / 8
      for (std::int32_t b = i / 4 * 4; b < size; b += 4) store(joint[i] + b, load4(other.joint[i] + b));
    }
  }
  // Adds k j j^T; k may be negative.
  template <class Size>
  void add(Size size, Real k_N_per_m, const Spring& spring) PALPATE_RT {
    for (std::int32_t i = 0; i < size; ++i) add_row(size, i, k_N_per_m, spring);  // bound: kMost^2 / 8
  }
  // Once all springs are there: lets the modes go, rank by rank, as springs that are taken away. H is positive and
  // springs add to it: no pivot vanishes but by what is not finite.
  template <class Size, class Count>
  void eliminate(Size size, Count soft) PALPATE_RT {
    if constexpr (std::is_same_v<Count, std::int32_t>) {
      for (std::int32_t m = 0; m < soft; ++m) let_go(size, m);  // bound: soft kMost^2 / 8
    } else {
      each(std::make_integer_sequence<std::int32_t, Count::value>{}, [&](auto m) PALPATE_RT { let_go(size, m); });
    }
  }
  // Afterwards: what the modes give under a newton of a further spring.
  Real yield_m_per_N(std::int32_t soft, const Spring& spring) const PALPATE_RT;
  // And the stiffness against the tool whose twist begins there, the other's held.
  ContactStiffness from(std::int32_t twist) const PALPATE_RT;

  Real joint[kMost][kMost];  // J on and above the diagonal; of modes that have gone the rows of their factor
  Real inverse[kMaxSoftModes];

 private:
  // Of a few modes, written out: counting was half of it.
  template <std::int32_t... kIndex, class Use>
  static void each(std::integer_sequence<std::int32_t, kIndex...>, const Use& use) PALPATE_RT {
    (use(std::integral_constant<std::int32_t, kIndex>{}), ...);
  }
  template <class Size, class Index>
  void let_go(Size size, Index m) PALPATE_RT {
    const Real pivot = joint[m][m];
    inverse[m] = pivot > 0 && pivot < kHuge * kHuge ? 1.0 / square_root(pivot) : 0.0;
    Spring column;
    for (std::int32_t b = m / 4 * 4; b < size; b += 4) {
      store(column.slope + b, splat4(inverse[m]) * load4(joint[m] + b));
      store(joint[m] + b, load4(column.slope + b));
    }
    for (std::int32_t i = m + 1; i < size; ++i) add_row(size, i, -1.0, column);
  }
  template <class Size>
  void add_row(Size size, std::int32_t i, Real k_N_per_m, const Spring& spring) PALPATE_RT {
    const Double4 share = splat4(k_N_per_m * spring.slope[i]);
    for (std::int32_t b = i / 4 * 4; b < size; b += 4)
      store(joint[i] + b, load4(joint[i] + b) + share * load4(spring.slope + b));
  }
};

// A spring along `direction` at `arm` from the origin of the tool whose twist begins at `twist`; modes_slope(a): what
// the surface goes along it by each amplitude, which takes from its length.
template <class Size, class Count, class Slope>
void aim(Size size, Count soft, std::int32_t twist, Vec3 direction, Vec3 arm, const Slope& modes_slope,
         ToolTangent::Spring& out) PALPATE_RT {
  for (std::int32_t b = 0; b < size; b += 4) store(out.slope + b, Double4{});  // bound: kMost / 4
  for (std::int32_t a = 0; a < soft; ++a) out.slope[a] = -modes_slope(a);      // bound: soft
  const Vec3 turn = cross(arm, direction);
  Real* to = out.slope + twist;
  to[0] = direction.x;
  to[1] = direction.y;
  to[2] = direction.z;
  to[3] = turn.x;
  to[4] = turn.y;
  to[5] = turn.z;
}

// use(size)
template <class Count, class Use>
void with_tangent_size(const Model& model, Count soft, const Use& use) PALPATE_RT {
  const std::int32_t hands = has_two_tools(model) ? 2 : 1;
  if constexpr (std::is_same_v<Count, std::int32_t>) {
    use(soft + hands * ToolTangent::kTwist);
  } else {
    if (hands > 1) return use(std::int32_t{soft + hands * ToolTangent::kTwist});
    use(std::integral_constant<std::int32_t, Count::value + ToolTangent::kTwist>{});
  }
}

}  // namespace palpate
