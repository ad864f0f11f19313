// Below two scenes beside one another: their forces and depths over each other, and how far they are apart.
#pragma once

#include <imgui.h>

#include <array>

#include "sim_host/view/comparison.h"
#include "sim_host/viewer/theme.h"

namespace palpate {

inline constexpr std::array<Colour, Comparison::kRuns> kRunColour{theme::kRunA, theme::kRunB};
inline constexpr std::array<const char*, Comparison::kRuns> kRunLetter{"A", "B"};

// `now_s`: common time.
void comparison_panel(ImVec2 low, ImVec2 size, const Comparison& comparison, double now_s);

}  // namespace palpate
