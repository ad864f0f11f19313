// What a scene's method of contact asks of the tool and its friction: rules between arrays and parameters, stated here
// alone. The loader applies them to the image, and the baker to the compiled pieces before it starts long computations.
#pragma once

#include "rt_core/image.h"

namespace palpate {

// Friction among the method's laws; nodes: pieces whose gap has a closed form; tips: one point a piece, the room the
// stages have. Fields of the answer: friction_law, piece.nodal_shape, piece.tip_points.
ImageResult check_method(const Model& model) noexcept;

}  // namespace palpate
