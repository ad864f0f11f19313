// Reads the histogram text of cyclictest (-h N, or --histfile), to draw it with our own.
#pragma once

#include <string>

#include "sim_host/latency/histogram.h"

namespace palpate {

// All threads of one run together.
struct CyclictestHistogram {
  Histogram latency;  // values at the lower edge of cyclictest's 1 µs bins; beyond them only overflow and max_ns count
  int threads = 0;
};

// `text`: output of cyclictest, with or without the lines it prints before "# Histogram"; `name` for messages. Throws
// std::runtime_error naming the line: no histogram, a row that is not numbers or has another number of columns, rows
// out of order, totals that are not the sum of their column (a cut file).
CyclictestHistogram parse_cyclictest(const std::string& text, const std::string& name);
// The same from a file.
CyclictestHistogram read_cyclictest(const std::string& path);

}  // namespace palpate
