// What a layer takes off a half space's give, wave by wave.
#pragma once

#include "config/response/layer_contact.h"

namespace palpate {

// 1 - L(w) of layer_contact.h, w the wave number times the thickness.
double layer_loss(const ElasticLayer& layer, double w);

}  // namespace palpate
