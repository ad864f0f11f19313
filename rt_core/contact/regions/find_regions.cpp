// Stage regions: clusters of contacts with lasting identities. Reads scratch.contact, state.point, state.region; writes
// the identity part of state.region, state.point.region, contact.region. Status: kRegionsDropped, kOverlapInconclusive.
//
// A region without contact renders no force but remembers its identity and friction for kRegionMemoryTicks. Its
// lost_ticks stays at 1, so that the memory does not run out, for as long as the exact piece still overlaps the surface
// triangle it last touched: tool points only sample the piece, so a flat face can touch between them. An inconclusive
// overlap test holds as well: "could not decide" must never be read as "no contact". A whole tip has no between.
#include "rt_core/contact/nodes/nodal.h"
#include "rt_core/contact/regions/identity.h"
#include "rt_core/stages.h"
#include "rt_core/surface/overlap.h"
#include "rt_core/tool/carrier.h"

namespace palpate {

namespace {

// Labels contacts and points with their region. Contacts of clusters that got no slot leave the list: they render no
// force, and everything after this stage may rely on contact.region being valid.
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

// Tool point whose last surface point is nearest to where the region was, within the memory distance; or -1.
std::int32_t point_at(const Model& model, const State& state, const Region& region) PALPATE_RT {
  std::int32_t nearest = -1;
  double distance2 = kRegionMemoryDistance_m * kRegionMemoryDistance_m;
  const auto points = static_cast<std::int32_t>(model.tool_point.size());
  for (std::int32_t i = 0; i < points; ++i) {  // bound: kMaxToolPoints
    if (state.point[i].triangle < 0) continue;
    const double d2 = squared_norm(state.point[i].closest_w - region.centre_w);
    if (d2 < distance2 || (nearest < 0 && d2 == distance2)) {
      nearest = i;
      distance2 = d2;
    }
  }
  return nearest;
}

// Whether the piece last at this region may still touch the surface there.
bool still_touching(const Model& model, State& state, Scratch& scratch, const Region& region) PALPATE_RT {
  const std::int32_t point = point_at(model, state, region);
  if (point < 0) return false;
  // A whole tip touches where its one point does; the overlap of a flat punch lying on a flat face costs 20,000.
  if (static_cast<ResponseLaw>(model.params.response_law) != ResponseLaw::kPoints) return false;
  const Triangle& triangle = model.triangle[static_cast<std::size_t>(state.point[point].triangle)];
  Vec3 corner[3];
  for (int k = 0; k < 3; ++k) corner[k] = model.vertex_m[static_cast<std::size_t>(triangle.vertex[k])];  // bound: 3
  const std::int32_t piece = model.tool_point[static_cast<std::size_t>(point)].piece;
  const OverlapResult result = overlap_piece_triangle(model, model.piece[static_cast<std::size_t>(piece)],
                                                      carrier_w(model, state, piece), corner);
  if (result.support_calls > state.high_water.gjk_support_calls) {
    state.high_water.gjk_support_calls = result.support_calls;
  }
  if (result.overlap == Overlap::kInconclusive) scratch.status |= Status::kOverlapInconclusive;
  return result.overlap != Overlap::kMiss;
}

void lose(const Model& model, State& state, Scratch& scratch, Region& region) PALPATE_RT {
  region.point_count = 0;
  region.area_m2 = 0;
  region.depth_max_m = 0;
  if (region.lost_ticks == 0) {
    region.lost_ticks = 1;
  } else if (region.lost_ticks > 1 || !still_touching(model, state, scratch, region)) {
    region.lost_ticks += 1;
    if (region.lost_ticks > kRegionMemoryTicks) region = Region{};
  }
}

}  // namespace

void find_regions(const Model& model, State& state, Scratch& scratch) PALPATE_RT {
  if (is_nodal(model)) return;  // once the pushes are known
  Clusters clusters;
  find_clusters(model, state, scratch, clusters);
  if (!assign_slots(scratch, clusters, state)) scratch.status |= Status::kRegionsDropped;
  label(model, state, scratch, clusters);

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
    if (state.region[slot].id != 0 && !touched[slot]) lose(model, state, scratch, state.region[slot]);
  }
  if (regions > state.high_water.regions) state.high_water.regions = regions;
}

}  // namespace palpate
