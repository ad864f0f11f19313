#include "sim_host/bake/explain.h"

#include <fmt/format.h>

#include <cstring>
#include <iterator>
#include <string_view>

#include "rt_core/contact/contact.h"
#include "rt_core/stage_cost.h"
#include "rt_core/state.h"
#include "rt_core/tool/articulate.h"
#include "sim_host/bake/data_readers.h"
#include "sim_host/status_text.h"

namespace palpate {

namespace {

const char* method_text(const Model& model) {
  if (model.params.backend == Backend::kNodal)
    return "nodes of a finite-element body, forces and the tool's place in one problem";
  if (model.params.backend == Backend::kElastic) return "whole tips on the carried surface of an elastic body";
  switch (model.params.response_law) {
    case ResponseLaw::kPoints:
      return "tool points with springs";
    case ResponseLaw::kTip:
      return "whole tips, each with its own law";
    default:
      return "whole tips, their laws tabulated over the surface";
  }
}

// What a stage has to do in this scene beyond its usual work.
std::string stage_note(const Model& model, std::string_view stage) {
  const CouplingLaw coupling = model.params.coupling_law;
  if (stage == "articulate")
    return is_articulated(model) ? fmt::format("{} joints", model.joint.size()) : "nothing: the tool is rigid";
  if (stage == "sense" && (model.params.encoder_step_m > 0 || model.params.encoder_step_rad > 0))
    return fmt::format("the handle is smoothed within steps of {:.4g} mm (by {}), {:.4g} rad (by {})",
                       1e3 * model.params.encoder_step_m, word_of(model.params.encoder_law_m),
                       model.params.encoder_step_rad, word_of(model.params.encoder_law_rad));
  if ((stage == "force" || stage == "solve") && carries_over(coupling))
    return fmt::format("a skeleton of {} beams per region{}", model.anchor.size(),
                       coupling == CouplingLaw::kTemporalPaper ? ": coupling is temporal"
                                                               : ", and one to every other: coupling is mutual");
  return "";
}

// What a declared reader reads besides, a tick of this scene reads too: triangles where tool points are measured on
// them, beams and anchors where coupling asks for skeletons.
bool is_read_by_tick(const Model& model, std::string_view name) {
  if (name == "triangle") return method_of(model) != Method::kNodes;
  if (model.params.coupling_law == CouplingLaw::kMutualPaper) return name == "anchor";
  const bool of_skeleton = name == "anchor" || name == "rbf_inverse" || name.starts_with("beam_");
  return of_skeleton && model.params.coupling_law == CouplingLaw::kTemporalPaper;
}

// Who reads an array: the tick, unless the table of readers names another.
std::string readers_of(const Model& model, const char* name) {
  for (const DataReader& r : kDataReaders)
    if (std::strcmp(r.name, name) == 0)
      return fmt::format("{}{}", is_read_by_tick(model, name) ? "tick, " : "host: ", r.reader);
  return "tick";
}

// A choice by its word, where it has words.
template <class T>
std::string value_text(T value) {
  if constexpr (requires { word_of(value); })
    return word_of(value);
  else
    return fmt::format("{}", value);
}

// Parameters that choose: numbers without a unit from a short list.
template <class T>
bool is_law(const char* unit, double highest) {
  constexpr double kMostChoices = 8;
  return !std::is_same_v<T, double> && std::strcmp(unit, "-") == 0 && highest <= kMostChoices;
}

// Calls each(name, word, meaning) for what chooses the laws of the model's own method.
template <class Each>
void for_each_choice(const Model& model, Each each) {
  const unsigned own = bit_of(method_of(model));
#define PALPATE_ROW(type, field, unit, lowest, highest, meaning)                \
  if (is_law<decltype(model.params.field)>(unit, static_cast<double>(highest))) \
    each(#field, value_text(model.params.field), meaning);
#define PALPATE_GROUP(title, PARAMS, methods) \
  if (((methods)&own) != 0) {                 \
    PARAMS(PALPATE_ROW)                       \
  }
  PALPATE_PARAM_GROUPS(PALPATE_GROUP)
#undef PALPATE_GROUP
#undef PALPATE_ROW
}

// Calls each(name, elements, bytes, meaning) for the model's arrays that are not empty.
template <class Each>
void for_each_array(const Model& model, Each each) {
#define PALPATE_ROW(type, field, count, frame, meaning) \
  if (!model.field.empty()) each(#field, model.field.size(), model.field.size_bytes(), meaning);
  PALPATE_MODEL_ARRAYS(PALPATE_ROW)
#undef PALPATE_ROW
}

}  // namespace

std::string explain(const Model& model, std::int32_t budget_instructions) {
  std::string text = fmt::format(
      "scene   {}: {} triangles, {} pieces with {} points, {} anchors\nmethod  {}\n\nstages\n", model.name,
      model.triangle.size(), model.piece.size(), model.tool_point.size(), model.anchor.size(), method_text(model));
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "  {:<12}{:>12}{:>12}\n", "", "at most", "capacity");
  double capacity = 0;
  for (std::int32_t i = 0; i < kStageCount; ++i) {
    const char* name = stage_name(static_cast<Stage>(i));
    const double most = most_stage_cost(model, static_cast<Stage>(i));
    capacity += most;
    fmt::format_to(out, "  {:<12}{:>12.0f}{:>12.0f}  {}\n", name,
                   model.stage_cost[static_cast<std::size_t>(i)].instructions, most, stage_note(model, name));
  }
  fmt::format_to(out, "  {:<12}{:>12.0f}{:>12.0f}  instructions: {}\n", "tick", worst_tick_instructions(model),
                 capacity,
                 "what an adversary found and a reserve, to which the controller holds it; every capacity met at once");
  text += "\nlaws and choices\n";
  for_each_choice(model, [&](const char* name, const std::string& word, const char* meaning) {
    fmt::format_to(out, "  {:<18}{:<26}{}\n", name, word, meaning);
  });
  std::size_t bytes = 0;
  text += "\narrays            elements       bytes  read by                                   meaning\n";
  for_each_array(model, [&](const char* name, std::size_t elements, std::size_t size, const char* meaning) {
    fmt::format_to(out, "  {:<16}{:>10}{:>12}  {:<42}{}\n", name, elements, size, readers_of(model, name), meaning);
    bytes += size;
  });
  fmt::format_to(out, "\nmemory  arrays {} bytes, State {} bytes, Scratch {} bytes\n", bytes, state_bytes(model),
                 scratch_bytes(model));
  if (budget_instructions > 0)
    fmt::format_to(out, "budget  {} instructions for the worst tick (budget_instructions)\n", budget_instructions);
  else
    text += "budget  none stated: the scene's .toml holds it (budget_instructions)\n";
  return text;
}

Json explain_json(const Model& model, std::int32_t budget_instructions) {
  Json json = {{"name", model.name}, {"method", method_text(model)}};
  for (std::int32_t i = 0; i < kStageCount; ++i) {
    const char* name = stage_name(static_cast<Stage>(i));
    json["stages"].push_back({{"stage", name},
                              {"most_instructions", model.stage_cost[static_cast<std::size_t>(i)].instructions},
                              {"capacity_instructions", most_stage_cost(model, static_cast<Stage>(i))},
                              {"note", stage_note(model, name)}});
  }
  json["tick_instructions"] = worst_tick_instructions(model);
  json["budget_instructions"] = budget_instructions > 0 ? Json(budget_instructions) : Json(nullptr);
  for_each_choice(model, [&](const char* name, const std::string& word, const char*) { json["choices"][name] = word; });
  for_each_array(model, [&](const char* name, std::size_t elements, std::size_t bytes, const char* meaning) {
    json["arrays"].push_back({{"name", name},
                              {"elements", elements},
                              {"bytes", bytes},
                              {"read_by", readers_of(model, name)},
                              {"meaning", meaning}});
  });
  json["state_bytes"] = state_bytes(model);
  json["scratch_bytes"] = scratch_bytes(model);
  return json;
}

}  // namespace palpate
