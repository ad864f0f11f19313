// One physical case solved by one model of the product: its force along a press, its error and what it costs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim_host/report/curve_error.h"
#include "sim_host/report/model_variants.h"
#include "sim_host/report/reference_curve.h"
#include "sim_host/report/tick_count.h"

namespace palpate {

struct ModelRun {
  std::string name, family, meaning;
  std::string refused;              // why this model cannot take the case; the rest is then empty
  ForcePath path;                   // over depth
  std::optional<CurveError> error;  // against the reference, where there is one
  SurfaceError surface;             // at the deepest; all 0 where the reference has no surface
  double step_N = 0;                // largest step per tick beyond the trend, sliding at half the depth
  double slide_force_N = 0;         // mean there
  int unconverged = 0, beyond_range = 0, ticks = 0;
  TickCount count;
  double p50_us = 0, p999_us = 0, max_us = 0;  // of ticks in contact, each the least of its repeats
  double bake_s = 0;                           // of processor time
  std::size_t image_bytes = 0, state_bytes = 0, scratch_bytes = 0;
  std::uint64_t hash = 0;  // of the state after the path
};

struct ModelRunOptions {
  bool count = true;  // instructions, by valgrind
  int repeats = 5;    // of the timed path
};

// How far a tick's motion goes. A hand at 20 mm/s and 1 kHz.
inline constexpr double kReportStep_m = 2e-5;

ModelRun run_model(const ModelVariant& variant, const SceneDesc& stated, const PressPlace& press,
                   const ReferenceCurve* reference, const ModelRunOptions& options);

}  // namespace palpate
