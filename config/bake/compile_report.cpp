#include <algorithm>
#include <cstdio>

#include "config/bake/compile.h"

namespace palpate {

namespace {

template <class... Values>
void line(std::string& text, const char* pattern, Values... values) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, pattern, values...);
  text += buffer;
  text += '\n';
}

const char* smoothing_text(bool smoothed, EncoderLaw law) {
  if (!smoothed) return "not smoothed";
  return law == EncoderLaw::kEdges ? "smoothed by its edges" : "smoothed";
}

void beam_lines(std::string& text, const CompileReport& r) {
  const BeamTableReport& b = r.beams;
  line(text, "beams      %.4g x %.4g mm in walls of at least %.4g mm, released over %.4g mm", 1e3 * b.width_m,
       1e3 * b.thickness_m, 1e3 * b.wall_m, 1e3 * b.release_length_m);
  line(text,
       "           %lld straight, %lld by the surface's curvature, %lld fitted, %lld in a turned plane, %lld dropped",
       static_cast<long long>(b.count[1] + b.count[2]), static_cast<long long>(b.count[3]),
       static_cast<long long>(b.count[4]), static_cast<long long>(b.count[5]), static_cast<long long>(b.count[0]));
  line(text, "           %lld of them both ways round", static_cast<long long>(b.two_ways));
  for (std::size_t a = 0; a < b.dropped_by_anchor.size(); ++a)
    if (b.dropped_by_anchor[a] > 0)
      line(text, "           anchor %d: dropped from %lld of %lld vertices", static_cast<int>(a),
           static_cast<long long>(b.dropped_by_anchor[a]), static_cast<long long>(r.vertices));
}

// Arrays from the largest down to one per cent of the image.
void size_lines(std::string& text, const CompileReport& r) {
  std::vector<ArrayBytes> array = r.array;
  std::stable_sort(array.begin(), array.end(), [](const auto& a, const auto& b) { return a.bytes > b.bytes; });
  std::string parts;
  for (const ArrayBytes& a : array) {
    if (100 * a.bytes < r.image_bytes) break;
    char part[96];
    std::snprintf(part, sizeof part, "%s%s %.3f MB", parts.empty() ? "" : ", ", a.name,
                  1e-6 * static_cast<double>(a.bytes));
    parts += part;
  }
  text += "image      " + parts + '\n';
}

void elastic_lines(std::string& text, const ElasticReport& e) {
  line(text,
       "elastic    %lld nodes, %lld tetrahedra; %d soft modes %s up to %.3g J, the softest %.4g N/m; %d linear; "
       "%d samples",
       static_cast<long long>(e.nodes), static_cast<long long>(e.elements), e.soft,
       e.check.empty() ? "trusted" : "checked", 0.5 * e.radius_rootJ * e.radius_rootJ, e.softest_N_per_m, e.linear,
       e.samples);
  if (e.add_c_mpN != 0)
    line(text, "           %.4g um/N added to the self terms by the check presses", 1e6 * e.add_c_mpN);
  for (const ElasticReport::Check& c : e.check) {
    const char* end = c.slides ? "; deeper, the body goes out from under it" : "";
    if (c.depth_m > 0)
      line(text,
           "check      ball of %.4g mm at (%.4g, %.4g, %.4g) mm: %.4g mm deep %.4g N, by elements %.4g N; worst %.1f "
           "%%%s",
           1e3 * c.radius_m, 1e3 * c.place_m.x, 1e3 * c.place_m.y, 1e3 * c.place_m.z, 1e3 * c.depth_m, c.force_N,
           c.reference_N, 100 * c.worst_error, end);
    else
      line(text, "check      ball of %.4g mm at (%.4g, %.4g, %.4g) mm: nothing to compare%s", 1e3 * c.radius_m,
           1e3 * c.place_m.x, 1e3 * c.place_m.y, 1e3 * c.place_m.z, end);
  }
}

}  // namespace

std::string report_text(const CompileReport& r) {
  std::string text;
  line(text, "scene      %s, image of %.3f MB", r.name.c_str(), 1e-6 * static_cast<double>(r.image_bytes));
  line(text, "surface    %lld vertices, %lld triangles, %.4g cm3, %.4g cm2, %.4g kg",
       static_cast<long long>(r.vertices), static_cast<long long>(r.triangles), 1e6 * r.volume_m3, 1e4 * r.surface_m2,
       r.mass_kg);
  line(text, "hierarchy  %d nodes, %d levels, traversal stack at most %d of %d", r.bvh_nodes, r.bvh_depth,
       r.traversal_stack, kMaxTraversalStack);
  if (r.elastic.nodes > 0) elastic_lines(text, r.elastic);
  if (r.fem_nodes > 0) {
    line(text, "elements   %lld nodes, %lld tetrahedra, %d strain gauges", static_cast<long long>(r.fem_nodes),
         static_cast<long long>(r.fem_elements), r.fem_gauges);
    line(text, "compliance %.2f MB in %s precision (rounding to single: %.1e of a press's force)",
         1e-6 * static_cast<double>(r.compliance_bytes), r.single_precision ? "single" : "double", r.precision_error);
  }
  line(text, "skeleton   %d anchors (%s), %d fixed, beam radius %.4g mm", r.anchors,
       r.exact_anchors ? "exact" : "from the mesh", r.fixed_anchors, 1e3 * r.section_radius_m);
  if (r.baked_beams) beam_lines(text, r);
  line(text, "contact    k1 = %.6g N/m, k3 = %.6g N/m3 (%s)", r.contact.k1_N_per_m, r.contact.k3_N_per_m3,
       r.contact.derivation.c_str());
  line(text, "           reference area %.4g mm2, cluster distance %.4g mm", 1e6 * r.reference_area_m2,
       1e3 * r.cluster_distance_m);
  for (const std::string& tip : r.response.tip) line(text, "response   %s", tip.c_str());
  if (r.response.curves > 0)
    line(text, "response   %lld curves of %lld knots, %.4g bytes per vertex", static_cast<long long>(r.response.curves),
         static_cast<long long>(r.response.knots), r.response.bytes_per_vertex);
  if (r.response.slack_m > 0)
    line(text, "           smooth surface up to %.4g um from its facets", 1e6 * r.response.slack_m);
  line(text, "friction   K = %.6g N^(1-beta), sliding coefficient %.4g", r.friction.k_N, r.friction.mu_dynamic);
  line(text, "coupling   %.5g N/m of %.5g admitted (%s); %.4g N m/rad of %.4g (%s)", r.coupling_N_per_m, r.bound.value,
       reason_of(r.bound), r.coupling_Nm_per_rad, r.rotational_bound.value, reason_of(r.rotational_bound));
  line(text, "encoder    %s, which asks for %.3g N of friction and has %.3g; angle %s, for %.3g N m and has %.3g",
       smoothing_text(r.smoothing.position, r.smoothing.of_position.law), r.smoothing.of_position.friction,
       r.smoothing.has_N, smoothing_text(r.smoothing.angle, r.smoothing.of_angle.law), r.smoothing.of_angle.friction,
       r.smoothing.has_Nm);
  line(text, "tool       %d points in %d pieces", r.tool_points, static_cast<int>(r.gap_m.size()));
  for (std::size_t i = 0; i < r.gap_m.size(); ++i)
    line(text, "           piece %d: surface at most %.2f mm from its points' spheres", static_cast<int>(i),
         1e3 * r.gap_m[i]);
  if (r.joints > 0) line(text, "joints     %d", r.joints);
  if (r.parts_touching > 0)
    line(text, "hand       %d parts touch when closed; open it clears the body by %.3g mm", r.parts_touching,
         1e3 * r.clearance_m);
  if (r.grip_N[0] > 0)
    line(text, "grip       thumb %.4g N against %.4g, %.4g, %.4g, %.4g N; %.3g N of their wrench is left for friction",
         r.grip_N[0], r.grip_N[1], r.grip_N[2], r.grip_N[3], r.grip_N[4], r.grip_left_N);
  if (r.cost.looks_max > 0)
    line(text, "surface    a tick looks at %d boxes and triangles at most; points beyond it wait", r.cost.looks_max);
  for (const std::string& model : r.model) line(text, "model      %s", model.c_str());
  line(text, "worst tick %.0f instructions found by an adversary, %.0f stated", r.cost.found, r.cost.instructions);
  size_lines(text, r);
  for (const std::string& warning : r.warnings) text += "warning    " + warning + '\n';
  return text;
}

}  // namespace palpate
