// Whether a compliance table may be stored in single precision.
#pragma once

#include "config/fem/condense.h"

namespace palpate {

// Flat frictionless presses of patches of 10 and 40 neighbouring vertices, all over the surface: contact forces from
// the table as it is and from the table rounded to single precision.
struct PrecisionReport {
  double total_error = 0;   // largest relative error of a press's total force
  double node_error = 0;    // largest error of one vertex's force, relative to the press's largest
  bool is_definite = true;  // false: a rounded contact problem was no longer positive definite
};
PrecisionReport single_precision_error(const CondensedBody& body);

// A force error that no finger feels (a just noticeable difference is 7 %) and that is far below the mesh's own error.
inline constexpr double kSinglePrecisionTolerance = 1e-4;
inline bool single_precision_suffices(const PrecisionReport& report) {
  return report.is_definite && report.total_error <= kSinglePrecisionTolerance;
}

}  // namespace palpate
