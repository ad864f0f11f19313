// The scene compiler: a checked scene description in, the bytes of an image and a report out.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "config/bake/contact_fit.h"
#include "config/bake/elastic_check.h"
#include "config/bake/image_writer.h"
#include "config/bake/time_params.h"
#include "config/bake/worst_tick.h"
#include "config/beams/beam_table_build.h"
#include "config/response/tip_bake.h"
#include "config/scene/progress.h"
#include "config/scene/scene.h"

namespace palpate {

// An elastic body, in short.
struct ElasticReport {
  std::int64_t nodes = 0, elements = 0;  // 0: none
  std::int32_t soft = 0, linear = 0, samples = 0;
  double radius_rootJ = 0;
  double softest_N_per_m = 0;  // stiffness of the softest mode against its largest motion
  // A ball pressed into large-strain elements and into the baked body.
  struct Check {
    Vec3 place_m;
    double radius_m = 0, depth_m = 0;  // depth 0: nothing to compare
    bool slides = false;               // deeper, the body goes out from under it
    double reference_N = 0, force_N = 0;
    double worst_error = 0;  // relative, on the way to the depth
  };
  std::vector<Check> check;
  std::vector<CheckPress> press;      // the same with all depths
  std::vector<CheckedPlace> checked;  // what the image keeps of them
  double add_c_mpN = 0;               // to every self term, by the presses
};

struct CompileReport {
  std::string name;
  std::size_t image_bytes = 0;
  std::int64_t vertices = 0, triangles = 0;
  std::int64_t fem_nodes = 0, fem_elements = 0;  // 0: no finite elements
  std::int32_t fem_gauges = 0;
  std::size_t compliance_bytes = 0;
  bool single_precision = false;
  ElasticReport elastic;
  double precision_error = 0;  // relative, of a press's force, by rounding the table to single precision
  double volume_m3 = 0, surface_m2 = 0, mass_kg = 0;
  std::int32_t bvh_nodes = 0, bvh_depth = 0, traversal_stack = 0;
  bool exact_anchors = false;
  std::int32_t anchors = 0, fixed_anchors = 0;
  double section_radius_m = 0;
  ContactCoefficients contact;
  double reference_area_m2 = 0, cluster_distance_m = 0;
  FrictionCoefficients friction;
  ResponseReport response;
  StiffnessBound bound, rotational_bound;  // N/m, N m/rad
  double coupling_N_per_m = 0, coupling_Nm_per_rad = 0;
  Smoothing smoothing;  // of the handle, and the friction it asks for
  std::int32_t tool_points = 0;
  std::vector<double> gap_m;  // per piece: largest distance from its touching surface to the nearest tool sphere
  bool baked_beams = false;   // beams holds something
  BeamTableReport beams;
  std::vector<ArrayBytes> array;                // of the image, in its order
  std::int32_t joints = 0, parts_touching = 0;  // of a hand: parts in contact when closed
  double clearance_m = 0;                       // of the open hand on its way in
  FingerNumbers grip_N{};                       // hand.closing = "balanced": normal force of each finger
  double grip_left_N = 0;                       // and what of their wrench is left for friction (balanced_closing.h)
  TickCost cost;
  std::vector<std::string>
      model;  // which model was taken for one left open, and with error_target which were tried; a line each
  std::vector<std::string> warnings;
};
// The report as lines for a terminal.
std::string report_text(const CompileReport& report);

struct CompileResult {
  std::vector<std::byte> bytes;
  CompileReport report;
};
// How a bake goes about it; nothing of that is in the bytes.
struct BakeRun {
  Progress progress;
  unsigned jobs = 0;  // threads for what can go side by side; 0: as many as there are processors
};
// Same scene, same bytes: nothing of paths, time or addresses goes into them. Throws ConfigError.
// A scene with an error_target gets the model that meets it (model_choice.h).
CompileResult compile_scene(const SceneDesc& scene, const BakeRun& run = {});
// The image alone, of the model that the scene states.
CompileResult compile_image(const SceneDesc& scene, const BakeRun& run);
// The same with a certificate of its check presses, or of `checked` where that is not empty.
CompileResult compile_stated(const SceneDesc& scene, const BakeRun& run, const std::vector<CheckedPlace>& checked);

}  // namespace palpate
