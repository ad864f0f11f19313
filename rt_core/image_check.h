// The last rungs of the loader ladder: cross-references and finite numbers of every array. Runs once, when an image is
// opened; after it the tick may index without checks.
#pragma once

#include "rt_core/image.h"

namespace palpate {

ImageResult check_arrays(const Model& model) noexcept;

}  // namespace palpate
