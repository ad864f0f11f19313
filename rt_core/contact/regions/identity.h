// Carries region identities from the last tick to this tick's clusters.
#pragma once

#include "rt_core/contact/regions/clusters.h"

namespace palpate {

// a was in contact earlier than b (ties by id): merges keep it.
inline bool older(const Region& a, const Region& b) PALPATE_RT {
  return a.born_tick != b.born_tick ? a.born_tick < b.born_tick : a.id < b.id;
}

// Gives clusters their slots, in three passes that depend on nothing but membership, age and place:
//  1. heirs: each region of the last tick passes to the cluster that holds most of its points (ties: lowest tool
//  point);
//     a cluster with several claims keeps the oldest region, the others have merged into it and end;
//  2. return: a cluster without a region takes up the nearest lost one within kRegionMemoryDistance_m;
//  3. birth: the rest get new ids, in order of their lowest tool point.
// Only the kMaxRegions deepest clusters take part (ties: lowest tool point); false when some were left out. When no
// slot is empty a birth takes the slot of the region lost longest. Reads the membership of the last tick in
// state.point.region. Regions that no cluster took are left as they were.
bool assign_slots(const Scratch& scratch, Clusters& clusters, State& state) PALPATE_RT;

}  // namespace palpate
