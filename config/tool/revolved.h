// What the cards of bodies of revolution share: surface samples of a rounded profile, rings of tool points.
#pragma once

#include "config/tool/piece_card.h"

namespace palpate {

// Samples of the rounded profile swept about z, only of the end that touches.
std::vector<SurfaceSample> revolved_samples(const PieceCore& core, const CoreProfile& profile);

void add_ring(std::vector<Vec3>& point, double radius, double z, std::int32_t count, double phase);
// Spreads points over an end face and, where all of it touches, both ends (`pointed`: the upper end is an apex) and the
// rings between them that leave the smallest gap.
std::vector<Vec3> revolved_points(const PieceCore& core, std::int32_t count, bool pointed);

// Tip rule of shapes that press with either end.
Refusal needs_one_end(const PieceDesc& piece);

}  // namespace palpate
