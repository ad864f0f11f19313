// Force curves from the tables that people and this project's programs have.
#pragma once

#include <string>

#include "sim_host/report/csv_table.h"
#include "sim_host/report/curve_error.h"

namespace palpate {

// What two curves are compared over. kAny: the first of these that both tables have.
enum class Abscissa { kAny, kDepth, kTime, kRow };

// The abscissa that both tables have. Throws std::runtime_error when it is asked for and one has none.
Abscissa common_abscissa(const CsvTable& a, const CsvTable& b, Abscissa wanted);
// Depths in metres; of a press or a recording those are its penetrations while they rise to the deepest. Forces from
// fx_N, fy_N, fz_N, or as one number from force_N or f_N. Rows without a number are left out.
// `vectors`: as directions too; otherwise only how large it is, in x.
ForcePath path_of(const CsvTable& table, Abscissa over, bool vectors);

}  // namespace palpate
