// The contact problem of a tick, one formulation for all methods: a mixed complementarity problem in the forces of its
// rows (Signorini's conditions; with a smooth law e, a penalty method on a god-object proxy).
//
// A row is a place where the tool may push the body: gap or depth D, unit normal, arm about the tool's origin. Its
// force f >= 0 presses the surface in by the local law e(f); all forces together move it by the compliance H between
// rows (the Delassus operator of the body), and the tool, held by the spring K of the virtual coupling, gives way:
//   D - e(f) - H f - G K^-1 G^T f = 0   where f > 0,   <= 0 where f = 0,        G: normals and arms of the rows
//            points                   tips                        nodes
//   e(f)     inverse of a cubic law   a tip's law or its table    0: hard
//   H        far field by region      far field of tip and pair   the body's compliance, node by node
//   K        outside the problem: the tool is held while it is solved, and one Newton step  |  inside it
//            with the tangent stiffness of the rows moves it (tool/virtual_coupling.h)      |
//   solver   Newton's method by region, contact/region_solve.h    principal pivoting, contact/nodes/pivoting.h
// Warm start: points and tips keep each point's nearest triangle, nodes their pushes and with them the active set.
#pragma once

#include <cstdint>

#include "rt_core/limits.h"
#include "rt_core/vec.h"

namespace palpate {

// One row in contact. Found and solved by the method; what follows reads it without asking which.
struct Contact {
  std::int32_t row = 0;        // the method's own number of it: tool point (points, tips), node of the problem (nodes)
  std::int32_t point = -1;     // tool point; -1: it has none (nodes)
  std::int32_t piece = 0;      // of the tool
  std::int32_t region = -1;    // slot in State::region; -1: none yet
  std::int32_t previous = -1;  // region of the last tick, or -1
  std::int32_t hand = 0;       // 1: of the second of two tools
  Vec3 position_w;             // where the force acts: the surface point
  Vec3 normal_w;
  double depth_m = 0;  // on the rest surface, > 0
  double weight = 0;   // of the contact law
  double area_m2 = 0;  // of the surface it stands for
  double force_N = 0;  // normal force on the tool
};

// The rows of one region: `contact[index[k]]`, k < count. Sorting indices instead of contacts copies nothing.
// Every row named must hold finite numbers, a unit normal and a non-negative weight.
struct RegionRows {
  Contact* contact = nullptr;
  const std::int32_t* index = nullptr;
  std::int32_t count = 0;
  bool geometric = false;  // their centre is that of their weights, not of their forces

  Contact& operator[](std::int32_t k) const PALPATE_RT { return contact[index[k]]; }
};

// The tick's rows by region, regions in the order they were born.
struct RowsByRegion {
  std::int32_t regions = 0;
  std::int32_t slot[kMaxRegions];       // in State::region, by born_tick, then id
  std::int32_t first[kMaxRegions + 1];  // rows of region r: index[first[r]] to index[first[r + 1]]
  std::int32_t index[kMaxContacts];     // in Scratch::contact
  bool geometric = false;               // EquivalentPoint::kPaper
};

// Working memory of the region solver (contact/region_solve.h). Matrices are row-major n x n, n = number of regions.
struct RegionSystem {
  double compliance_m_per_N[kMaxRegions * kMaxRegions];     // C: far field of one region at another
  double second_order_m_per_N2[kMaxRegions * kMaxRegions];  // h, tips only
  double factor[kMaxRegions * kMaxRegions];
  double shift_m[kMaxRegions];  // out: how far the surface under each region is moved inward
  double force_N[kMaxRegions];  // out: of each region's local laws at that shift
  double root_tangent[kMaxRegions];
  double residual_m[kMaxRegions];
  double step_m[kMaxRegions];
  double trial_m[kMaxRegions];
};

}  // namespace palpate
