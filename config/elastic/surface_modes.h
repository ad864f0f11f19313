// The softest shapes of a body as its surface sees them: K phi = lambda M_s phi, phi' M_s phi = 1, M_s = int N N dA.
// Every partial sum of phi phi' / lambda lies below the surface's compliance in the order of positive semi-definite
// matrices, so what is left out can only be a softer body, never an unstable one.
#pragma once

#include "config/elastic/rest_body.h"

namespace palpate::elastic {

struct SurfaceModes {
  Eigen::VectorXd lambda_Npm3;  // rising
  Eigen::MatrixXd phi_1pm;      // one column per mode; the coordinates q of u = phi q are in m^2
};

// The lowest `count` modes by block Lanczos on K^-1 M_s with full reorthogonalisation. Deterministic: fixed start,
// fixed order; a mode's largest component is positive. Throws ConfigError when the body has fewer.
template <int kDim>
SurfaceModes surface_modes(const RestBody<kDim>& body, int count);

// `wanted`, or one more or two where that would part modes of (nearly) equal lambda: symmetric pairs stay together.
int whole_families(const SurfaceModes& modes, int wanted);

}  // namespace palpate::elastic
