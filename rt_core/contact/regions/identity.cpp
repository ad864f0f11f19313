#include "rt_core/contact/regions/identity.h"

namespace palpate {

namespace {

constexpr std::int32_t kNone = -1;

// Ranks clusters by depth when there are more than slots. takes_part[c] for the kMaxRegions deepest.
bool choose_deepest(const Clusters& clusters, bool (&takes_part)[kMaxContacts]) PALPATE_RT {
  for (std::int32_t c = 0; c < clusters.count; ++c) {  // bound: kMaxContacts
    std::int32_t deeper = 0;
    if (clusters.count > kMaxRegions) {
      for (std::int32_t o = 0; o < clusters.count; ++o) {  // bound: kMaxContacts
        const double a = clusters.cluster[o].depth_max_m, b = clusters.cluster[c].depth_max_m;
        deeper += a > b || (a == b && o < c) ? 1 : 0;
      }
    }
    takes_part[c] = deeper < kMaxRegions;
  }
  return clusters.count <= kMaxRegions;
}

// Working memory of one assignment.
struct Assignment {
  bool takes_part[kMaxContacts];
  bool taken[kMaxRegions] = {};
  std::int32_t votes[kMaxContacts][kMaxRegions];  // points of each cluster that were in each region
};

void count_votes(const Scratch& scratch, const Clusters& clusters, const State& state, Assignment& work) PALPATE_RT {
  for (std::int32_t c = 0; c < clusters.count; ++c) {  // bound: kMaxContacts
    for (std::int32_t& vote : work.votes[c]) vote = 0;
  }
  for (std::int32_t i = 0; i < clusters.contacts; ++i) {  // bound: kMaxContacts
    const std::int32_t slot = state.point[scratch.contact[clusters.order[i]].point].region;
    if (slot >= 0 && slot < kMaxRegions) work.votes[clusters.of_rank[i]][slot] += 1;
  }
}

std::int32_t heir_of(const Clusters& clusters, const Assignment& work, std::int32_t slot) PALPATE_RT {
  std::int32_t heir = kNone, most = 0;
  for (std::int32_t c = 0; c < clusters.count; ++c) {  // bound: kMaxContacts
    if (!work.takes_part[c] || work.votes[c][slot] <= most) continue;
    heir = c;
    most = work.votes[c][slot];
  }
  return heir;
}

// Pass 1: heirs and merges.
void inherit(Clusters& clusters, State& state, Assignment& work) PALPATE_RT {
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {  // bound: kMaxRegions
    if (state.region[slot].id == 0) continue;
    const std::int32_t heir = heir_of(clusters, work, slot);
    if (heir == kNone) continue;
    std::int32_t& holder = clusters.cluster[heir].slot;
    std::int32_t ended = kNone;
    if (holder == kNone) {
      holder = slot;
    } else if (older(state.region[slot], state.region[holder])) {
      ended = holder;
      holder = slot;
    } else {
      ended = slot;
    }
    if (ended != kNone) {
      state.region[ended] = Region{};
      work.taken[ended] = false;
    }
    work.taken[holder] = true;
  }
}

double distance2_to(const Scratch& scratch, const Clusters& clusters, std::int32_t cluster, Vec3 place) PALPATE_RT {
  double nearest = kHuge;
  for (std::int32_t i = 0; i < clusters.contacts; ++i) {  // bound: kMaxContacts
    if (clusters.of_rank[i] != cluster) continue;
    nearest = min_of(nearest, squared_norm(scratch.contact[clusters.order[i]].position_w - place));
  }
  return nearest;
}

// Pass 2: the nearest lost region close enough, or kNone.
std::int32_t remembered(const Scratch& scratch, const Clusters& clusters, std::int32_t cluster, const State& state,
                        const Assignment& work) PALPATE_RT {
  std::int32_t found = kNone;
  double nearest = kRegionMemoryDistance_m * kRegionMemoryDistance_m;
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {  // bound: kMaxRegions
    const Region& region = state.region[slot];
    if (region.id == 0 || work.taken[slot]) continue;
    const double distance2 = distance2_to(scratch, clusters, cluster, region.centre_w);
    const bool tie = found != kNone && distance2 == nearest;
    if (tie ? older(region, state.region[found]) : distance2 <= nearest) {
      found = slot;
      nearest = distance2;
    }
  }
  return found;
}

// Pass 3: an empty slot, else that of the region lost longest (ties: the youngest). There is always one, because at
// most kMaxRegions clusters take part.
std::int32_t vacate(const State& state, const Assignment& work) PALPATE_RT {
  std::int32_t slot = kNone;
  for (std::int32_t s = 0; s < kMaxRegions; ++s) {  // bound: kMaxRegions
    const Region& region = state.region[s];
    if (work.taken[s]) continue;
    if (region.id == 0) return s;
    if (slot == kNone || region.lost_ticks > state.region[slot].lost_ticks ||
        (region.lost_ticks == state.region[slot].lost_ticks && older(state.region[slot], region))) {
      slot = s;
    }
  }
  return slot;
}

void give_birth(State& state, std::int32_t slot) PALPATE_RT {
  Region& region = state.region[slot];
  region = Region{};
  if (state.next_region_id == 0) state.next_region_id = 1;  // 0 means empty, also after wrapping
  region.id = state.next_region_id++;
  region.born_tick = static_cast<std::uint32_t>(state.tick);
}

}  // namespace

bool assign_slots(const Scratch& scratch, Clusters& clusters, State& state) PALPATE_RT {
  Assignment work;
  const bool all = choose_deepest(clusters, work.takes_part);
  count_votes(scratch, clusters, state, work);
  inherit(clusters, state, work);
  for (std::int32_t c = 0; c < clusters.count; ++c) {  // bound: kMaxContacts
    std::int32_t& slot = clusters.cluster[c].slot;
    if (!work.takes_part[c] || slot != kNone) continue;
    slot = remembered(scratch, clusters, c, state, work);
    if (slot != kNone) work.taken[slot] = true;
  }
  for (std::int32_t c = 0; c < clusters.count; ++c) {  // bound: kMaxContacts; after every return, so none is evicted
    std::int32_t& slot = clusters.cluster[c].slot;
    if (!work.takes_part[c] || slot != kNone) continue;
    slot = vacate(state, work);
    if (slot == kNone) continue;
    give_birth(state, slot);
    work.taken[slot] = true;
  }
  return all;
}

}  // namespace palpate
