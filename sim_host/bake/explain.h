// What a scene makes the tick do: stages, method and laws, the image's arrays with their readers, memory and budget.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/model.h"
#include "sim_host/json_output.h"

namespace palpate {

// `budget_instructions`: the scene's own; 0: none is stated.
std::string explain(const Model& model, std::int32_t budget_instructions);
Json explain_json(const Model& model, std::int32_t budget_instructions);

}  // namespace palpate
