// At the foot of a still picture: where the axes point, how long a length is, how long a force.
#pragma once

#include "sim_host/view/mesh_raster.h"
#include "sim_host/view/view_scales.h"

namespace palpate {

// `m_per_pixel`: where the body stands; `projection` of the canvas's own size.
void draw_foot(Canvas& canvas, const Projection& projection, double m_per_pixel, const ForceScale& forces);

}  // namespace palpate
