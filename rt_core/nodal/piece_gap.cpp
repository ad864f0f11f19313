#include "rt_core/nodal/piece_gap.h"

namespace palpate {

namespace {

Real with_sign(Real magnitude, Real sign) PALPATE_RT { return sign < 0 ? -magnitude : magnitude; }

// From the nearest point of the core, `offset` away and outside it.
[[gnu::always_inline]] inline PieceGap outside(Vec3 offset, Real margin) PALPATE_RT {
  const Real distance = norm(offset);
  return {distance - margin, unit_or(offset, {0, 0, 1})};
}

// Signed distance in the half plane (rho, z) of a body of revolution, as (distance, normal there).
struct Flat {
  Real distance, rho, z;
};

Flat cylinder_flat(Real radius, Real half, Real rho, Real z) PALPATE_RT {
  const Real side = rho - radius, end = abs_of(z) - half;
  if (side > 0 && end > 0) {
    const Real distance = square_root(side * side + end * end);
    return {distance, side / distance, with_sign(end / distance, z)};
  }
  return side > end ? Flat{side, 1, 0} : Flat{end, 0, with_sign(1, z)};
}

// Cone with its base (radius r) at z = -h and its apex at +h.
Flat cone_flat(Real r, Real h, Real rho, Real z) PALPATE_RT {
  const Real length = square_root(r * r + 4 * h * h);
  const Real n_rho = 2 * h / length, n_z = r / length;  // outward normal of the side
  const Real side = (rho - r) * n_rho + (z + h) * n_z, base = -(z + h);
  if (side <= 0 && base <= 0) return side > base ? Flat{side, n_rho, n_z} : Flat{base, 0, -1};
  // Along the side from the rim to the apex; along the base from the axis to the rim.
  const Real along = clamp_to(((z + h) * n_rho - (rho - r) * n_z) / length, 0, 1);
  const Real side_rho = rho - r * (1 - along), side_z = z + h - 2 * h * along;
  const Real base_rho = max_of(rho - r, 0), base_z = z + h;
  const Real side2 = side_rho * side_rho + side_z * side_z, base2 = base_rho * base_rho + base_z * base_z;
  const bool to_base = base > 0 && base2 < side2;
  const Real distance = square_root(to_base ? base2 : side2);
  if (!(distance > 0)) return {0, n_rho, n_z};
  return to_base ? Flat{distance, base_rho / distance, base_z / distance}
                 : Flat{distance, side_rho / distance, side_z / distance};
}

PieceGap revolved(const Flat& flat, Vec3 p, Real rho, Real margin) PALPATE_RT {
  const Real scale = rho > 0 ? flat.rho / rho : 0;
  const Vec3 normal = rho > 0 ? Vec3{scale * p.x, scale * p.y, flat.z} : Vec3{flat.rho, 0, flat.z};
  return {flat.distance - margin, normal};
}

PieceGap box_gap(const Real (&half)[3], Vec3 p, Real margin) PALPATE_RT {
  const Vec3 q{abs_of(p.x) - half[0], abs_of(p.y) - half[1], abs_of(p.z) - half[2]};
  if (q.x > 0 || q.y > 0 || q.z > 0) {
    return outside({with_sign(max_of(q.x, 0), p.x), with_sign(max_of(q.y, 0), p.y), with_sign(max_of(q.z, 0), p.z)},
                   margin);
  }
  if (q.x >= q.y && q.x >= q.z) return {q.x - margin, {with_sign(1, p.x), 0, 0}};
  if (q.y >= q.z) return {q.y - margin, {0, with_sign(1, p.y), 0}};
  return {q.z - margin, {0, 0, with_sign(1, p.z)}};
}

}  // namespace

PieceGap piece_gap(const ToolPiece& piece, Vec3 p) PALPATE_RT {
  const Real(&half)[3] = piece.half_extent_m;
  switch (static_cast<PieceShape>(piece.shape)) {
    case PieceShape::kSphere:
      return outside(p, piece.margin_m);
    case PieceShape::kCapsule:
      return outside({p.x, p.y, p.z - clamp_to(p.z, -half[2], half[2])}, piece.margin_m);
    case PieceShape::kCylinder: {
      const Real rho = square_root(p.x * p.x + p.y * p.y);
      return revolved(cylinder_flat(half[0], half[2], rho, p.z), p, rho, piece.margin_m);
    }
    case PieceShape::kCone: {
      const Real rho = square_root(p.x * p.x + p.y * p.y);
      return revolved(cone_flat(half[0], half[2], rho, p.z), p, rho, piece.margin_m);
    }
    case PieceShape::kBox:
      return box_gap(half, p, piece.margin_m);
    case PieceShape::kHull:
      break;  // the baker refuses hulls with this back-end
  }
  return {};
}

}  // namespace palpate
