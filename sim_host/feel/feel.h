// One scene under one manoeuvre: set up from the scene's device and hand, played, measured; and what is made of that.
#pragma once

#include <string>
#include <vector>

#include "sim_host/feel/feel_meters.h"
#include "sim_host/feel/manoeuvre.h"

namespace palpate {

struct FeelOptions {
  std::string hand;                 // of hand_models(); empty: the scene's
  std::vector<std::string> device;  // NAME=VALUE: the real device differs from what the scene takes it for
};

struct FeelRun {
  std::string scene, manoeuvre;
  FeelFigures figures;
};

// The scene's device and hand. Throws std::runtime_error for an unknown hand or property.
FeelSetup feel_setup(const SceneDesc& scene, const Model& model, const FeelOptions& options);
// `listen` may be null.
FeelRun run_feel(const Model& model, const SceneDesc& scene, const TouchPlace& place, Manoeuvre manoeuvre,
                 const FeelOptions& options, const FeelListener& listen);

// Why these figures fail, as "what (figure, allowed)", or "". The allowed ones are those of docs/stability.md.
std::string feel_failure(const FeelRun& run);

std::string feel_table(const std::vector<FeelRun>& runs);     // for people
std::string feel_markdown(const std::vector<FeelRun>& runs);  // of docs/stability.md
std::string feel_json(const std::vector<FeelRun>& runs);
std::string feel_csv_header();
std::string feel_csv_row(const FeelTick& tick);

}  // namespace palpate
