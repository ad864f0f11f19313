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
  const bool temporal = model.params.coupling_law == CouplingLaw::kTemporalPaper;
  if (stage == "articulate")
    return is_articulated(model) ? fmt::format("{} joints", model.joint.size()) : "nothing: the tool is rigid";
  if ((stage == "force" || stage == "solve") && temporal)
    return fmt::format("a skeleton of {} beams per region: coupling is temporal", model.anchor.size());
  return "";
}

// What a declared reader reads besides, a tick of this scene reads too: triangles where tool points are measured on
// them, beams and anchors where coupling asks for skeletons.
bool is_read_by_tick(const Model& model, std::string_view name) {
  if (name == "triangle") return method_of(model) != Method::kNodes;
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

std::string array_row(const Model& model, const char* name, std::size_t elements, std::size_t bytes,
                      const char* meaning) {
  if (elements == 0) return "";
  return fmt::format("  {:<16}{:>10}{:>12}  {:<42}{}\n", name, elements, bytes, readers_of(model, name), meaning);
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
std::string law_row(const char* name, T value, const char* unit, double highest, const char* meaning) {
  constexpr double kMostChoices = 8;
  if constexpr (std::is_same_v<T, double>) return "";
  if (std::strcmp(unit, "-") != 0 || highest > kMostChoices) return "";
  return fmt::format("  {:<18}{:<26}{}\n", name, value_text(value), meaning);
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
  const unsigned own = bit_of(method_of(model));
#define PALPATE_ROW(type, field, unit, lowest, highest, meaning) \
  text += law_row(#field, model.params.field, unit, static_cast<double>(highest), meaning);
#define PALPATE_GROUP(title, PARAMS, methods) \
  if (((methods)&own) != 0) {                 \
    PARAMS(PALPATE_ROW)                       \
  }
  PALPATE_PARAM_GROUPS(PALPATE_GROUP)
#undef PALPATE_GROUP
#undef PALPATE_ROW
  std::size_t bytes = 0;
  text += "\narrays            elements       bytes  read by                                   meaning\n";
#define PALPATE_ROW(type, field, count, frame, meaning)                                    \
  text += array_row(model, #field, model.field.size(), model.field.size_bytes(), meaning); \
  bytes += model.field.size_bytes();
  PALPATE_MODEL_ARRAYS(PALPATE_ROW)
#undef PALPATE_ROW
  fmt::format_to(out, "\nmemory  arrays {} bytes, State {} bytes, Scratch {} bytes\n", bytes, state_bytes(model),
                 scratch_bytes(model));
  if (budget_instructions > 0)
    fmt::format_to(out, "budget  {} instructions for the worst tick (budget_instructions)\n", budget_instructions);
  else
    text += "budget  none stated: the scene's .toml holds it (budget_instructions)\n";
  return text;
}

}  // namespace palpate
