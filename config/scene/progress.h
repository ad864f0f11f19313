// How far long work has come, for a bar on the terminal.
#pragma once

#include <cstdio>
#include <functional>

namespace palpate {

// `what` is a short noun phrase, `fraction` runs from 0 to 1 for each `what`. May be empty: nobody listens.
using Progress = std::function<void(const char* what, double fraction)>;

// Draws one line per `what` on `out`, redrawn when a percent is added and ended at 1.
Progress progress_bar(std::FILE* out);

}  // namespace palpate
