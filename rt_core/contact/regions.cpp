#include "rt_core/contact/regions.h"

#include "rt_core/tool/articulate.h"

namespace palpate {

namespace {

void sort_by_row(const Scratch& scratch, Clusters& out) PALPATE_RT {
  out.contacts = scratch.contact_count;
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // insertion sort; bound: kMaxContacts^2 / 2
    std::int32_t at = i;
    while (at > 0 && scratch.contact[out.order[at - 1]].row > scratch.contact[i].row) {
      out.order[at] = out.order[at - 1];
      at -= 1;
    }
    out.order[at] = i;
  }
}

// What tells contacts of an articulated tool apart: one part is one region however it touches, different fingers are
// different regions, and parts of one finger join as the distances in linked() say. Rigid tools go by distance alone,
// and so do tips on an elastic body, each of which is a region.
struct Kinship {
  std::int32_t piece[kMaxContacts];
  std::int32_t group[kMaxContacts];
  std::int32_t previous[kMaxContacts];  // the last contact before, of the same chain of groups; or -1
};
// Contacts are compared along their chain only: fifteen parts of five fingers compare 250 pairs instead of 1,300.
// Groups that share a chain are told apart when compared.
constexpr std::uint32_t kChains = 32;

void find_kinship(const Model& model, const Scratch& scratch, const Clusters& out, Kinship& kin) PALPATE_RT {
  if (!is_articulated(model)) {
    for (std::int32_t i = 0; i < out.contacts; ++i) {  // bound: kMaxContacts
      kin.piece[i] = -1 - i;
      kin.group[i] = 0;
      kin.previous[i] = i - 1;
    }
    return;
  }
  std::int32_t newest[kChains];
  for (std::int32_t& contact : newest) contact = -1;  // bound: kChains
  for (std::int32_t i = 0; i < out.contacts; ++i) {   // bound: kMaxContacts
    const std::int32_t piece = scratch.contact[out.order[i]].piece;
    kin.piece[i] = model.params.elastic_soft > 0 ? -1 - i : piece;
    kin.group[i] = model.piece[static_cast<std::size_t>(piece)].group;
    std::int32_t& last = newest[static_cast<std::uint32_t>(kin.group[i]) % kChains];
    kin.previous[i] = last;
    last = i;
  }
}

bool linked(const Model& model, const Contact& a, const Contact& b) PALPATE_RT {
  const double distance2 = squared_norm(a.position_w - b.position_w);
  const double near = model.params.cluster_distance_m;
  if (distance2 < near * near) return true;
  const double far = kSplitFactor * near;
  return a.previous >= 0 && a.previous == b.previous && distance2 <= far * far;
}

// Gives the contacts of two sets the lower of their labels. Bound: kMaxContacts.
void unite(std::int32_t* set, std::int32_t count, std::int32_t a, std::int32_t b) PALPATE_RT {
  const std::int32_t low = a < b ? a : b, high = a < b ? b : a;
  for (std::int32_t i = high; i < count; ++i) {
    if (set[i] == high) set[i] = low;
  }
}

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
  std::int32_t votes[kMaxContacts][kMaxRegions];  // rows of each cluster that were in each region
};

void count_votes(const Scratch& scratch, const Clusters& clusters, Assignment& work) PALPATE_RT {
  for (std::int32_t c = 0; c < clusters.count; ++c) {  // bound: kMaxContacts
    for (std::int32_t& vote : work.votes[c]) vote = 0;
  }
  for (std::int32_t i = 0; i < clusters.contacts; ++i) {  // bound: kMaxContacts
    const std::int32_t slot = scratch.contact[clusters.order[i]].previous;
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
    } else if (is_born_before(state.region[slot], state.region[holder])) {
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
std::int32_t remembered(const Scratch& scratch, Clusters& clusters, std::int32_t cluster, const State& state,
                        const Assignment& work) PALPATE_RT {
  std::int32_t found = kNone;
  double nearest = kRegionMemoryDistance_m * kRegionMemoryDistance_m;
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {  // bound: kMaxRegions
    const Region& region = state.region[slot];
    if (region.id == 0 || work.taken[slot]) continue;
    const double distance2 = distance2_to(scratch, clusters, cluster, region.centre_w);
    clusters.recalls += clusters.contacts;
    const bool tie = found != kNone && distance2 == nearest;
    if (tie ? is_born_before(region, state.region[found]) : distance2 <= nearest) {
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
        (region.lost_ticks == state.region[slot].lost_ticks && is_born_before(state.region[slot], region))) {
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

// Labels contacts and points with their region. Contacts of clusters that got no slot leave the list: they render no
// force, and everything after it may rely on contact.region being valid.
void label(const Model& model, State& state, Scratch& scratch, const Clusters& clusters) PALPATE_RT {
  for (std::int32_t i = 0; i < clusters.contacts; ++i) {  // bound: kMaxContacts
    scratch.contact[clusters.order[i]].region = clusters.cluster[clusters.of_rank[i]].slot;
  }
  const auto points = static_cast<std::int32_t>(model.tool_point.size());
  for (std::int32_t i = 0; i < points; ++i) state.point[i].region = -1;  // bound: kMaxToolPoints
  std::int32_t kept = 0;
  for (std::int32_t i = 0; i < clusters.contacts; ++i) {  // bound: kMaxContacts
    const Contact& contact = scratch.contact[i];
    if (contact.region < 0) continue;
    state.point[contact.point].region = contact.region;
    if (kept != i) scratch.contact[kept] = contact;
    kept += 1;
  }
  scratch.contact_count = kept;
}

void lose(const Model& model, State& state, Scratch& scratch, StillTouching still_touching, Region& region) PALPATE_RT {
  region.point_count = 0;
  region.area_m2 = 0;
  region.depth_max_m = 0;
  if (region.lost_ticks == 0) {
    region.lost_ticks = 1;
  } else if (region.lost_ticks > 1 || still_touching == nullptr || !still_touching(model, state, scratch, region)) {
    region.lost_ticks += 1;
    if (region.lost_ticks > region_memory_ticks(model.params)) region = Region{};
  }
}

}  // namespace

void find_clusters(const Model& model, const Scratch& scratch, Clusters& out) PALPATE_RT {
  out.pairs = out.recalls = 0;
  sort_by_row(scratch, out);
  Kinship kin;
  find_kinship(model, scratch, out, kin);
  std::int32_t set[kMaxContacts];  // rank of the lowest contact of each contact's set
  std::int32_t sets = 0;
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // bound: kMaxContacts
    set[i] = i;
    sets += 1;
    const Contact& contact = scratch.contact[out.order[i]];
    for (std::int32_t j = kin.previous[i]; j >= 0 && sets > 1; j = kin.previous[j]) {  // bound: kMaxContacts; j falls
      out.pairs += 1;
      if (set[i] == set[j] || kin.group[i] != kin.group[j]) continue;
      const bool same = kin.piece[i] == kin.piece[j];
      if (!same && !linked(model, contact, scratch.contact[out.order[j]])) continue;
      out.pairs += i + 1 - (set[i] < set[j] ? set[j] : set[i]);
      unite(set, i + 1, set[i], set[j]);
      sets -= 1;
    }
  }
  out.count = 0;
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // bound: kMaxContacts; the lowest of a set comes before the others
    const Contact& contact = scratch.contact[out.order[i]];
    if (set[i] == i) {
      out.of_rank[i] = out.count;
      out.cluster[out.count] = {contact.row, 0, 0.0, 0.0, -1};
      out.count += 1;
    }
    out.of_rank[i] = out.of_rank[set[i]];
    Cluster& cluster = out.cluster[out.of_rank[i]];
    cluster.count += 1;
    cluster.area_m2 += contact.area_m2;
    cluster.depth_max_m = max_of(cluster.depth_max_m, contact.depth_m);
  }
}

bool assign_slots(const Scratch& scratch, Clusters& clusters, State& state) PALPATE_RT {
  Assignment work;
  const bool all = choose_deepest(clusters, work.takes_part);
  if (!all) clusters.pairs += clusters.count * clusters.count;
  count_votes(scratch, clusters, work);
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

void group_points(const Model& model, State& state, Scratch& scratch, StillTouching still_touching) PALPATE_RT {
  Clusters clusters;
  find_clusters(model, scratch, clusters);
  if (!assign_slots(scratch, clusters, state)) scratch.status |= Status::kRegionsDropped;
  label(model, state, scratch, clusters);
  scratch.work.pairs += clusters.pairs;
  scratch.work.recalls += clusters.recalls;
  scratch.work.clusters += clusters.count;

  bool touched[kMaxRegions] = {};
  std::int32_t regions = 0;
  for (std::int32_t c = 0; c < clusters.count; ++c) {  // bound: kMaxContacts
    const Cluster& cluster = clusters.cluster[c];
    if (cluster.slot < 0) continue;
    Region& region = state.region[cluster.slot];
    region.lost_ticks = 0;
    region.point_count = cluster.count;
    region.area_m2 = cluster.area_m2;
    region.depth_max_m = cluster.depth_max_m;
    touched[cluster.slot] = true;
    regions += 1;
  }
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {  // bound: kMaxRegions
    if (state.region[slot].id != 0 && !touched[slot]) lose(model, state, scratch, still_touching, state.region[slot]);
  }
  if (regions > state.high_water.regions) state.high_water.regions = regions;
}

}  // namespace palpate
