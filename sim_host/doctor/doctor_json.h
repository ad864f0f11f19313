// Items of a check list as JSON (docs/json.md).
#pragma once

#include <vector>

#include "sim_host/doctor/doctor.h"
#include "sim_host/json_output.h"

namespace palpate {

Json items_json(const std::vector<DoctorItem>& items);

}  // namespace palpate
