// Groups the contacts of one tick by surface distance.
#pragma once

#include <cstdint>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

// Two contacts of one region part only beyond this multiple of the cluster distance; contacts of different regions join
// below the cluster distance itself. The gap between the two keeps a finger at the limit from flickering.
inline constexpr double kSplitFactor = 1.5;

// One group of contacts. Members are listed by tool point, so nothing here depends on the order contacts came in.
// No default values: only the entries in use are written.
struct Cluster {
  std::int32_t first_point;  // lowest tool point among its members: its canonical name
  std::int32_t count;
  double area_m2;
  double depth_max_m;
  std::int32_t slot;  // in State::region, or -1 until it has an identity
};

struct Clusters {
  std::int32_t order[kMaxContacts];    // contact indices sorted by tool point
  std::int32_t of_rank[kMaxContacts];  // cluster of contact order[i]
  Cluster cluster[kMaxContacts];       // sorted by first_point
  std::int32_t contacts;
  std::int32_t count;
};

// Single-linkage clustering. Two contacts are linked when their surface points are nearer than
// cluster_distance_m, or nearer than kSplitFactor times that and both belonged to one region last tick
// (state.point.region). Bound: kMaxContacts^2 / 2 distances.
void find_clusters(const Model& model, const State& state, const Scratch& scratch, Clusters& out) PALPATE_RT;

}  // namespace palpate
