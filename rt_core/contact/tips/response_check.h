// The loader's checks of everything the response laws index, divide by or walk over.
#pragma once

#include "rt_core/image.h"

namespace palpate {

// Part of check_arrays: surface, tool and triangle arrays have passed.
ImageResult check_response(const Model& model) noexcept;

}  // namespace palpate
