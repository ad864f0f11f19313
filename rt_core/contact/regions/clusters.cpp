#include "rt_core/contact/regions/clusters.h"

#include "rt_core/tool/carrier.h"

namespace palpate {

namespace {

void sort_by_point(const Scratch& scratch, Clusters& out) PALPATE_RT {
  out.contacts = scratch.contact_count;
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // insertion sort; bound: kMaxContacts^2 / 2
    std::int32_t at = i;
    while (at > 0 && scratch.contact[out.order[at - 1]].point > scratch.contact[i].point) {
      out.order[at] = out.order[at - 1];
      at -= 1;
    }
    out.order[at] = i;
  }
}

// What tells contacts of an articulated tool apart: one part is one region however it touches, different fingers are
// different regions, and parts of one finger join as the distances in linked() say. Rigid tools go by distance alone.
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
    kin.piece[i] = piece_of(model, scratch.contact[out.order[i]]);
    kin.group[i] = model.piece[static_cast<std::size_t>(kin.piece[i])].group;
    std::int32_t& last = newest[static_cast<std::uint32_t>(kin.group[i]) % kChains];
    kin.previous[i] = last;
    last = i;
  }
}

bool linked(const Model& model, const State& state, const Contact& a, const Contact& b) PALPATE_RT {
  const double distance2 = squared_norm(a.position_w - b.position_w);
  const double near = model.params.cluster_distance_m;
  if (distance2 < near * near) return true;
  const std::int32_t region = state.point[a.point].region;
  const double far = kSplitFactor * near;
  return region >= 0 && region == state.point[b.point].region && distance2 <= far * far;
}

// Gives the contacts of two sets the lower of their labels. Bound: kMaxContacts.
void unite(std::int32_t* set, std::int32_t count, std::int32_t a, std::int32_t b) PALPATE_RT {
  const std::int32_t low = a < b ? a : b, high = a < b ? b : a;
  for (std::int32_t i = high; i < count; ++i) {
    if (set[i] == high) set[i] = low;
  }
}

}  // namespace

void find_clusters(const Model& model, const State& state, const Scratch& scratch, Clusters& out) PALPATE_RT {
  sort_by_point(scratch, out);
  Kinship kin;
  find_kinship(model, scratch, out, kin);
  std::int32_t set[kMaxContacts];  // rank of the lowest contact of each contact's set
  std::int32_t sets = 0;
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // bound: kMaxContacts
    set[i] = i;
    sets += 1;
    const Contact& contact = scratch.contact[out.order[i]];
    for (std::int32_t j = kin.previous[i]; j >= 0 && sets > 1; j = kin.previous[j]) {  // bound: kMaxContacts; j falls
      if (set[i] == set[j] || kin.group[i] != kin.group[j]) continue;
      const bool same = kin.piece[i] == kin.piece[j];
      if (!same && !linked(model, state, contact, scratch.contact[out.order[j]])) continue;
      unite(set, i + 1, set[i], set[j]);
      sets -= 1;
    }
  }
  out.count = 0;
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // bound: kMaxContacts; the lowest of a set comes before the others
    const Contact& contact = scratch.contact[out.order[i]];
    if (set[i] == i) {
      out.of_rank[i] = out.count;
      out.cluster[out.count] = {contact.point, 0, 0.0, 0.0, -1};
      out.count += 1;
    }
    out.of_rank[i] = out.of_rank[set[i]];
    Cluster& cluster = out.cluster[out.of_rank[i]];
    cluster.count += 1;
    cluster.area_m2 += contact.area_m2;
    cluster.depth_max_m = max_of(cluster.depth_max_m, contact.depth_m);
  }
}

}  // namespace palpate
