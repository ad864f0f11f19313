#include "rt_core/contact/regions.h"

#include "rt_core/lanes.h"
#include "rt_core/tool/articulate.h"
#include "rt_core/unwritten.h"

namespace palpate {

namespace {

// Contacts that follow one another and are one region however far apart: of an articulated tool those of one part. All
// others are runs of one contact. Different fingers are different regions, and parts of one finger join as the
// distances say. Rigid tools go by distance alone, and so do tips on an elastic body, each of which is a region.
struct Run {
  Double4 lower, upper;  // corners of their box: x, y, z and what comes after them
  std::int32_t begin, end;
  std::int32_t piece, group;
  std::int32_t before;  // the run before it in its chain, or -1
};
// Runs are compared with those of their chain alone. Groups that share a chain are told apart when compared.
constexpr std::uint32_t kChains = 32;

static_assert(sizeof(Contact::position_w) == 24 && offsetof(Contact, position_w) + 32 <= sizeof(Contact));

std::int32_t find_runs(const Model& model, const Scratch& scratch, Run* run) PALPATE_RT {
  const bool articulated = is_articulated(model), by_piece = articulated && !(model.params.elastic_soft > 0);
  const Contact* const contacts = scratch.contact.data();
  std::int32_t last[kChains], count = 0;
  for (std::int32_t& of_chain : last) of_chain = -1;          // bound: kChains
  for (std::int32_t i = 0; i < scratch.contact_count; ++i) {  // bound: kMaxContacts
    const Contact& contact = contacts[i];
    const Double4 place = load4(&contact.position_w.x);
    if (by_piece && count > 0 && run[count - 1].piece == contact.piece) {
      Run& of = run[count - 1];
      of.lower = place < of.lower ? place : of.lower;
      of.upper = place > of.upper ? place : of.upper;
      of.end = i + 1;
      continue;
    }
    const std::int32_t group = articulated ? model.piece[static_cast<std::size_t>(contact.piece)].group : 0;
    std::int32_t& of_chain = last[static_cast<std::uint32_t>(group) % kChains];
    run[count] = {place, place, i, i + 1, contact.piece, group, of_chain};
    of_chain = count++;
  }
  return count;
}

// Squared distance of their boxes, at most that of any two of their contacts, and as rounded: every step is monotonic.
double apart2(const Run& a, const Run& b) PALPATE_RT {
  const Double4 under = a.lower - b.upper, over = b.lower - a.upper, most = under > over ? under : over;
  const Double4 gap = most > 0 ? most : Double4{}, gap2 = gap * gap;
  return gap2[0] + gap2[1] + gap2[2];
}

// Whether some contact of one is linked with one of the other.
bool are_linked(const Scratch& scratch, const Run& a, const Run& b, double near2, double far2) PALPATE_RT {
  const Contact* const contact = scratch.contact.data();
  for (std::int32_t i = a.begin; i < a.end; ++i) {  // bound: kMaxContacts^2
    const Contact& one = contact[i];
    for (std::int32_t j = b.begin; j < b.end; ++j) {
      const Contact& other = contact[j];
      const double distance2 = squared_norm(one.position_w - other.position_w);
      const bool stays = one.previous >= 0 && one.previous == other.previous && distance2 <= far2;
      if (stays || distance2 < near2) return true;
    }
  }
  return false;
}

// Gives the runs of two sets the lower of their labels. Bound: kMaxContacts.
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
  const Contact* const contact = scratch.contact.data();
  for (std::int32_t i = 0; i < clusters.contacts;) {  // bound: kMaxContacts; those that vote alike follow one another
    const std::int32_t slot = contact[i].previous, c = clusters.of_contact[i], first = i;
    for (++i; i < clusters.contacts && contact[i].previous == slot && clusters.of_contact[i] == c;) ++i;
    if (slot < 0 || slot >= kMaxRegions) continue;
    const std::int32_t votes = work.votes[c][slot] += i - first;
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

// Places of a cluster's contacts, gathered once for all lost regions: asked region by region whose each contact is, ten
// clusters and seven lost regions took 40,000 instructions (2026-11-28).
struct Places {
  Unwritten<Vec3, kMaxContacts> at_w;
  std::int32_t count = 0;

  double distance2_to(Vec3 place_w) const PALPATE_RT {
    double nearest = kHuge;
    for (std::int32_t i = 0; i < count; ++i)  // bound: kMaxContacts
      nearest = min_of(nearest, squared_norm(at_w[i] - place_w));
    return nearest;
  }
};

void gather(const Scratch& scratch, const Clusters& clusters, std::int32_t cluster, Places& places) PALPATE_RT {
  for (std::int32_t i = 0; i < clusters.contacts; ++i)  // bound: kMaxContacts
    if (clusters.of_contact[i] == cluster) places.at_w[places.count++] = scratch.contact[i].position_w;
}

// Pass 2: the nearest lost region close enough, or kNone.
std::int32_t remembered(const Scratch& scratch, Clusters& clusters, std::int32_t cluster, const State& state,
                        const Assignment& work) PALPATE_RT {
  std::int32_t found = kNone;
  double nearest = kRegionMemoryDistance_m * kRegionMemoryDistance_m;
  Places places;
  for (std::int32_t slot = 0; slot < kMaxRegions; ++slot) {  // bound: kMaxRegions
    const Region& region = state.region[slot];
    if (region.id == 0 || work.taken[slot]) continue;
    if (places.count == 0) {
      gather(scratch, clusters, cluster, places);
      clusters.recalls += clusters.contacts;
    }
    const double distance2 = places.distance2_to(region.centre_w);
    clusters.recalls += places.count;
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
  Contact* const contacts = scratch.contact.data();
  PointState* const point = state.point.data();
  const auto points = static_cast<std::int32_t>(model.tool_point.size());
  for (std::int32_t i = 0; i < points; ++i) point[i].region = -1;  // bound: kMaxToolPoints
  std::int32_t kept = 0;
  for (std::int32_t i = 0; i < clusters.contacts; ++i) {  // bound: kMaxContacts
    const std::int32_t slot = clusters.cluster[clusters.of_contact[i]].slot;
    if (slot < 0) continue;
    if (kept != i) contacts[kept] = contacts[i];
    point[contacts[kept].point].region = contacts[kept].region = slot;
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
  out.contacts = scratch.contact_count;
  Run run[kMaxContacts];
  const std::int32_t runs = find_runs(model, scratch, run);
  // Every tip on an elastic body is a region, wherever it touches: so are a solid's edges that meet at a corner.
  const bool each = model.params.elastic_soft > 0;
  const double near = model.params.cluster_distance_m, far = kSplitFactor * near;
  std::int32_t set[kMaxContacts];  // lowest run of each run's set
  std::int32_t sets = 0;
  for (std::int32_t r = 0; r < runs; ++r) {  // bound: kMaxContacts
    set[r] = r;
    sets += 1;
    for (std::int32_t q = each ? kNone : run[r].before; q >= 0 && sets > 1; q = run[q].before) {  // bound: kMaxContacts
      out.pairs += 1;
      if (set[q] == set[r] || run[q].group != run[r].group || apart2(run[q], run[r]) > far * far) continue;
      out.pairs += (run[q].end - run[q].begin) * (run[r].end - run[r].begin);
      if (!are_linked(scratch, run[q], run[r], near * near, far * far)) continue;
      out.pairs += r + 1 - (set[r] < set[q] ? set[q] : set[r]);
      unite(set, r + 1, set[r], set[q]);
      sets -= 1;
    }
  }
  out.count = 0;
  const Contact* const contacts = scratch.contact.data();
  std::int32_t cluster_of[kMaxContacts];     // by run
  for (std::int32_t r = 0; r < runs; ++r) {  // bound: kMaxContacts; the lowest of a set comes before the others
    if (set[r] == r) {
      out.cluster[out.count] = {contacts[run[r].begin].row, 0, 0.0, 0.0, -1};
      cluster_of[r] = out.count++;
    }
    cluster_of[r] = cluster_of[set[r]];
    Cluster& cluster = out.cluster[cluster_of[r]];
    cluster.count += run[r].end - run[r].begin;
    double area_m2 = cluster.area_m2, deepest_m = cluster.depth_max_m;
    for (std::int32_t i = run[r].begin; i < run[r].end; ++i) {
      out.of_contact[i] = cluster_of[r];
      area_m2 += contacts[i].area_m2;
      deepest_m = max_of(deepest_m, contacts[i].depth_m);
    }
    cluster.area_m2 = area_m2;
    cluster.depth_max_m = deepest_m;
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
