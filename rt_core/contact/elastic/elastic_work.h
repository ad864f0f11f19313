// What the elastic method keeps between its steps within a tick.
#pragma once

#include "rt_core/contact/elastic/body_rub.h"
#include "rt_core/contact/elastic/part_search.h"
#include "rt_core/contact/elastic/tool_tangent.h"

namespace palpate {

// A row and the seeds of every tool point follow it in its block.
struct alignas(ElasticRow) ElasticWork {
  SoftEnergy energy;                        // at the amplitudes that the rows were placed with
  Real y[elastic_layout::kMaxTerms];        // products of the amplitudes: those the rows were placed with, then the new
  Real y_begun[elastic_layout::kMaxTerms];  // as the tick found it
  Real reach_m[elastic_layout::kMaxTerms];  // largest displacement of each shape; written when the Scratch is made
  Real linear_reach_m;                      // and of all linear modes together, m/J^1/2; likewise
  BodyRub rub[kMaxRegions];                 // by region of the tick
  ToolTangent tangent;                      // of the normals' springs, then of all
  std::int32_t points;                      // of the tool; written when the Scratch is made

  ElasticRow& row_of(std::int32_t point) PALPATE_RT { return reinterpret_cast<ElasticRow*>(this + 1)[point]; }
  // Of the part that the point touches; written when the Scratch is made.
  PartSeeds& seeds_of(std::int32_t point) PALPATE_RT { return reinterpret_cast<PartSeeds*>(&row_of(points))[point]; }
};
static_assert(sizeof(ElasticWork) % alignof(ElasticRow) == 0 && alignof(PartSeeds) <= alignof(ElasticRow));

// In the block of a Scratch made for the method.
inline ElasticWork& work_of(Scratch& scratch) PALPATE_RT { return *reinterpret_cast<ElasticWork*>(scratch.own.data()); }

}  // namespace palpate
