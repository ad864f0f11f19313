#include "rt_core/regions/clusters.h"

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

// Root of the union-find tree; roots are the lowest rank of their set, so paths only lead downward and end.
std::int32_t root_of(const std::int32_t* parent, std::int32_t i) PALPATE_RT {
  while (parent[i] != i) i = parent[i];  // bound: kMaxContacts
  return i;
}

bool linked(const Model& model, const State& state, const Contact& a, const Contact& b) PALPATE_RT {
  const double distance2 = squared_norm(a.position_w - b.position_w);
  const double near = model.params.cluster_distance_m;
  if (distance2 < near * near) return true;
  const std::int32_t region = state.point[a.point].region;
  const double far = kSplitFactor * near;
  return region >= 0 && region == state.point[b.point].region && distance2 <= far * far;
}

}  // namespace

void find_clusters(const Model& model, const State& state, const Scratch& scratch, Clusters& out) PALPATE_RT {
  sort_by_point(scratch, out);
  std::int32_t parent[kMaxContacts];
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // bound: kMaxContacts
    parent[i] = i;
    for (std::int32_t j = 0; j < i; ++j) {  // bound: kMaxContacts
      const std::int32_t a = root_of(parent, i), b = root_of(parent, j);
      if (a == b || !linked(model, state, scratch.contact[out.order[i]], scratch.contact[out.order[j]])) continue;
      parent[a > b ? a : b] = a < b ? a : b;
    }
  }
  out.count = 0;
  for (std::int32_t i = 0; i < out.contacts; ++i) {  // bound: kMaxContacts; a root comes before its members
    const Contact& contact = scratch.contact[out.order[i]];
    const std::int32_t root = root_of(parent, i);
    if (root == i) {
      out.of_rank[i] = out.count;
      out.cluster[out.count] = Cluster{};
      out.cluster[out.count].first_point = contact.point;
      out.count += 1;
    }
    out.of_rank[i] = out.of_rank[root];
    Cluster& cluster = out.cluster[out.of_rank[i]];
    cluster.count += 1;
    cluster.area_m2 += model.tool_point[static_cast<std::size_t>(contact.point)].area_m2;
    cluster.depth_max_m = max_of(cluster.depth_max_m, contact.depth_m);
  }
}

}  // namespace palpate
