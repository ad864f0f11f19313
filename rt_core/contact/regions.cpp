#include "rt_core/contact/regions.h"

#include "rt_core/lanes.h"
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

// What tells contacts apart, by rank and four at a time. Of an articulated tool one part is one region however it
// touches, different fingers are different regions, and parts of one finger join as the distances say. Rigid tools go
// by distance alone, and so do tips on an elastic body, each of which is a region. Whole numbers, exact as doubles.
struct Kinship {
  static constexpr std::int32_t kRanks = whole_lanes(kMaxContacts, 4);
  double x[kRanks], y[kRanks], z[kRanks];
  double piece[kRanks];
  double group[kRanks];
  double previous[kRanks];           // region of the last tick; of none a number of its own
  std::int32_t begin[kMaxContacts];  // the first contact that may be of the same group
  std::int32_t run[kMaxContacts];    // the first of those up to it that are of its part
};
// Contacts are compared with those of their chain alone: fifteen parts of five fingers have 115 fours of them instead
// of 350. Groups that share a chain are told apart when compared.
constexpr std::uint32_t kChains = 32;

void find_kinship(const Model& model, const Scratch& scratch, const Clusters& out, Kinship& kin) PALPATE_RT {
  const bool articulated = is_articulated(model), by_piece = articulated && !(model.params.elastic_soft > 0);
  std::int32_t first[kChains];
  for (std::int32_t& contact : first) contact = -1;                              // bound: kChains
  for (std::int32_t i = 0; i < whole_lanes(out.contacts, 4); ++i) {              // bound: kMaxContacts
    const std::int32_t at = out.order[i < out.contacts ? i : out.contacts - 1];  // none reads what fills the last four
    const Contact& contact = scratch.contact[at];
    const std::int32_t group = articulated ? model.piece[static_cast<std::size_t>(contact.piece)].group : 0;
    kin.x[i] = contact.position_w.x;
    kin.y[i] = contact.position_w.y;
    kin.z[i] = contact.position_w.z;
    kin.piece[i] = by_piece ? contact.piece : -1 - i;
    kin.group[i] = group;
    kin.previous[i] = contact.previous >= 0 ? contact.previous : -1 - i;
    if (i >= out.contacts) continue;
    std::int32_t& chain = first[static_cast<std::uint32_t>(group) % kChains];
    if (chain < 0) chain = i;
    kin.begin[i] = chain;
    kin.run[i] = i > 0 && kin.piece[i] == kin.piece[i - 1] ? kin.run[i - 1] : i;
  }
}

// Of the four contacts from `j` on, those before `i` that are linked with it, as bits.
std::uint32_t linked(const Kinship& kin, std::int32_t i, std::int32_t j, double near2, double far2) PALPATE_RT {
  const Vec3x4 off =
      Vec3x4{load4(kin.x + j), load4(kin.y + j), load4(kin.z + j)} - splat4(Vec3{kin.x[i], kin.y[i], kin.z[i]});
  const Double4 distance2 = dot(off, off);
  const Mask4 same = load4(kin.piece + j) == splat4(kin.piece[i]);
  const Mask4 stays = (load4(kin.previous + j) == splat4(kin.previous[i])) & (distance2 <= splat4(far2));
  const Mask4 kin_of = load4(kin.group + j) == splat4(kin.group[i]);
  const std::uint32_t before = i - j < 4 ? (1u << (i - j)) - 1u : 15u;
  return bits_of(kin_of & (same | stays | (distance2 < splat4(near2)))) & before;
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
  std::int32_t heir[kMaxRegions];
};

// Each region's heir: the cluster that holds most of its rows (ties: the lowest).
void count_votes(const Scratch& scratch, const Clusters& clusters, Assignment& work) PALPATE_RT {
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) work.heir[slot] = kNone;  // bound: kMaxRegions
  for (std::int32_t c = 0; c < clusters.count; ++c) {                               // bound: kMaxContacts
    for (std::int32_t& vote : work.votes[c]) vote = 0;
  }
  for (std::int32_t i = 0; i < clusters.contacts; ++i) {  // bound: kMaxContacts
    const std::int32_t slot = scratch.contact[clusters.order[i]].previous, c = clusters.of_rank[i];
    if (slot < 0 || slot >= kMaxRegions) continue;
    const std::int32_t votes = work.votes[c][slot] += 1;
    if (!work.takes_part[c]) continue;
    std::int32_t& heir = work.heir[slot];
    const std::int32_t most = heir == kNone ? 0 : work.votes[heir][slot];
    if (votes > most || (votes == most && c < heir)) heir = c;
  }
}

// Pass 1: heirs and merges.
void inherit(Clusters& clusters, State& state, Assignment& work) PALPATE_RT {
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {  // bound: kMaxRegions
    if (state.region[slot].id == 0) continue;
    const std::int32_t heir = work.heir[slot];
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
  const double near = model.params.cluster_distance_m, far = kSplitFactor * near;
  std::int32_t set[kMaxContacts];  // rank of the lowest contact of each contact's set
  std::int32_t sets = 0;
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // bound: kMaxContacts
    const std::int32_t run = kin.run[i];
    set[i] = run == i ? i : set[run];
    sets += run == i ? 1 : 0;
    for (std::int32_t j = kin.begin[i] & ~3; j < run && sets > 1; j += 4) {  // bound: kMaxContacts / 4
      out.pairs += 4;
      for (std::uint32_t bits = linked(kin, i, j, near * near, far * far); bits != 0; bits &= bits - 1) {  // bound: 4
        const std::int32_t other = set[j + __builtin_ctz(bits)];
        if (set[i] == other) continue;
        out.pairs += i + 1 - (set[i] < other ? other : set[i]);
        unite(set, i + 1, set[i], other);
        sets -= 1;
      }
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
