// Contact regions: groups of rows that are near one another (single-linkage clustering), with identities and an order
// that last from tick to tick.
#pragma once

#include <cstdint>

#include "rt_core/model.h"
#include "rt_core/state.h"

namespace palpate {

inline bool is_in_contact(const Region& region) PALPATE_RT { return region.id != 0 && region.lost_ticks == 0; }

// kRegionMemory_s in ticks of the scene's period, one at least.
inline std::int32_t region_memory_ticks(const ModelParams& params) PALPATE_RT {
  return static_cast<std::int32_t>(max_of(1, kRegionMemory_s / params.period_s + 0.5));
}

// a was in contact earlier than b (ties by id): merges keep it.
inline bool is_born_before(const Region& a, const Region& b) PALPATE_RT {
  return a.born_tick != b.born_tick ? a.born_tick < b.born_tick : a.id < b.id;
}

// Slots of the regions in contact, first born first. Returns how many. Bound: kMaxRegions^2 / 2 comparisons.
inline std::int32_t contact_order(const State& state, std::int32_t (&order)[kMaxRegions]) PALPATE_RT {
  std::int32_t count = 0;
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {
    if (!is_in_contact(state.region[slot])) continue;
    std::int32_t at = count++;
    for (; at > 0 && is_born_before(state.region[slot], state.region[order[at - 1]]); --at) order[at] = order[at - 1];
    order[at] = slot;
  }
  return count;
}

// Two contacts of one region part only beyond this multiple of the cluster distance; contacts of different regions join
// below the cluster distance itself. The gap between the two keeps a finger at the limit from flickering.
inline constexpr double kSplitFactor = 1.5;

// One group of contacts, which are listed by row. No default values: only the entries in use are written.
struct Cluster {
  std::int32_t first_row;  // lowest row among its members: its canonical name
  std::int32_t count;
  double area_m2;
  double depth_max_m;
  std::int32_t slot;  // in State::region, or -1 until it has an identity
};

struct Clusters {
  std::int32_t of_contact[kMaxContacts];
  Cluster cluster[kMaxContacts];  // sorted by first_row
  std::int32_t contacts;
  std::int32_t count;
  std::int32_t pairs;    // of contacts compared, and labels changed
  std::int32_t recalls;  // contacts compared with lost regions
};

// Single-linkage clustering of contacts in the order of their rows. Two contacts are linked when their surface points
// are nearer than cluster_distance_m, or nearer than kSplitFactor times that and both belonged to one region last tick
// (Contact::previous). On an elastic body every contact is a cluster. Bound: kMaxContacts^2 / 2 distances.
void find_clusters(const Model& model, const Scratch& scratch, Clusters& out) PALPATE_RT;

// Gives clusters their slots, in three passes that depend on nothing but membership, age and place:
//  1. heirs: each region of the last tick passes to the cluster that holds most of its rows (ties: lowest row);
//     a cluster with several claims keeps the oldest region, the others have merged into it and end;
//  2. return: a cluster without a region takes up the nearest lost one within kRegionMemoryDistance_m;
//  3. birth: the rest get new ids, in order of their lowest row.
// Only the kMaxRegions deepest clusters take part (ties: lowest row); false when some were left out. When no
// slot is empty a birth takes the slot of the region lost longest. Reads the membership of the last tick in
// Contact::previous. Regions that no cluster took are left as they were.
bool assign_slots(const Scratch& scratch, Clusters& clusters, State& state) PALPATE_RT;

// Whether the tool may still touch the body where a region was.
using StillTouching = bool (*)(const Model& model, State& state, Scratch& scratch, const Region& region) PALPATE_RT;
// Groups the contacts of tool points, keeps identities, and ages the regions that lost theirs: a region lost in this
// tick is held while `still_touching` says so; nullptr: never. Contacts of clusters that got no slot leave the list.
// Writes state.region (identity part), state.point.region, contact.region. Status: kRegionsDropped.
void group_points(const Model& model, State& state, Scratch& scratch, StillTouching still_touching) PALPATE_RT;

// A place for a new contact in the list, which is in the order of rows. There is room. Bound: kMaxContacts.
inline Contact& place_in_order(Scratch& scratch, std::int32_t row) PALPATE_RT {
  Contact* const contact = scratch.contact.data();
  std::int32_t at = scratch.contact_count++;
  for (; at > 0 && contact[at - 1].row > row; --at) contact[at] = contact[at - 1];
  return contact[at];
}

// Rows of points and tips: tool points on the rest surface, as a god-object's proxies (touch.cpp).

// A point whose gap is below this is measured every tick, so that its first contact starts warm; a point farther off is
// measured again only once it can have come this close.
inline constexpr double kSearchMargin_m = 0.5e-3;
// Closest rest-surface point of every tool point that can have reached it. Writes state.point (but region),
// scratch.contact, contact_count, foot. Bound: n_tool_point hierarchy queries. Status: kContactsDropped,
// kTraversalTruncated, kFootHeld.
void collide(const Model& model, State& state, Scratch& scratch) PALPATE_RT;

// Whether the piece last at this region may still touch the surface there: tool points only sample the piece, so a flat
// face can touch between them. An overlap test of the piece against the surface triangle it last touched; inconclusive
// counts as touching, since "could not decide" must never be read as "no contact". Status: kTouchesBetween,
// kOverlapInconclusive.
bool still_touching(const Model& model, State& state, Scratch& scratch, const Region& region) PALPATE_RT;

}  // namespace palpate
