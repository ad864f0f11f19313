// The law of one tip at its place on an elastic body.
#pragma once

#include "rt_core/contact/elastic/elastic_row.h"
#include "rt_core/contact/tips/travel.h"

namespace palpate {

// What a place does to a tip's law there, and how that changes along the surface: c of the place where it is negative
// and beta of it (config/elastic/width_law.h), its curvature, and its modulus.
struct PlacedLaw {
  Real scale = 1, scale_by_curvature = 0, scale_by_c = 0, scale_by_modulus = 0;  // of the tip's law
  PlaceTerms terms, by_c, by_beta, by_scale;
  // Of a capsule, instead of the tip's law.
  bool is_line = false;
  LineLaw line;
  // Of a plate, likewise: Hertz' on the body's crest until the contact is as wide as the flat tip, then its tangent.
  bool is_plate = false;
  TipLaw plate;
};
void place_law(const TipLaw& law, const ElasticRow& row, PlacedLaw& out) PALPATE_RT;

}  // namespace palpate
