// How many modes an elastic body gets, by its check presses.
#pragma once

#include "config/bake/compile.h"

namespace palpate {

// Writes the elastic arrays and parameters of `image`, which is complete otherwise: with the modes the scene states, or
// with the fewest soft ones that meet elastic.check_error at the check presses, or those that miss it least, with a
// warning. The ball of amplitudes in which V is trusted becomes the one that was checked. Throws ConfigError.
ElasticReport bake_elastic_body(const SceneDesc& scene, ImageContents& image, std::vector<std::string>& warnings,
                                const BakeRun& run);

}  // namespace palpate
