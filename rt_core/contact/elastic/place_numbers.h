// The numbers of a place between the vertices that hold them: c, c1, the mean curvature, beta, and the modulus.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"

namespace palpate {

// At the row's foot, with their gradients as the tip's centre moves.
void show_place_numbers(const Model& model, ElasticRow& row) PALPATE_RT;

}  // namespace palpate
