// The loader's checks of whole tips, for every method that has them.
#pragma once

#include "rt_core/image.h"

namespace palpate {

// One point a piece: the room the steps have.
ImageResult check_tip_points(const Model& model) noexcept;
// Smooth normals, one law a piece, factor tables and the range of each law, so that the tick may index and divide.
ImageResult check_tip_laws(const Model& model) noexcept;

}  // namespace palpate
