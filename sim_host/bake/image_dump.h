// A scene image in words, generated from the tables that define it.
#pragma once

#include <string>

#include "rt_core/image.h"
#include "sim_host/json_output.h"

namespace palpate {

// Header, sizes, parameters with units, and for each array its number of elements, bytes and the range of its values.
std::string image_dump(const ImageHeader& header, const Model& model);
Json image_json(const ImageHeader& header, const Model& model);

}  // namespace palpate
