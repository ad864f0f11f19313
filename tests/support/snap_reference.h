// The clip of Duriez, Andriot & Kheddar (2003, section 5) pushed over a rigid tube: a large-strain finite-element
// solution in plane stress (E = 2000 MPa, nu = 0.35, element size 0.7 mm, uncertain by 1.5 %), which nu = 0 is in
// space.
#pragma once

namespace palpate::test {

inline constexpr double kFirstContact_m = 0.01414133;  // height of the tube's middle; seated at 0

struct SnapSample {
  double insertion_mm, force_N;
};
inline constexpr SnapSample kSnapReference[] = {{0.5, 2.589},   {1, 4.361},   {2, 6.170},   {3, 6.534},  {4, 5.965},
                                                {5, 4.630},     {6, 2.899},   {7, 0.795},   {8, -1.467}, {10, -5.719},
                                                {11.5, -7.351}, {12, -7.232}, {13, -5.505}, {14, -0.944}};

}  // namespace palpate::test
