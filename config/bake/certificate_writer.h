// Writes the certificate behind an image (rt_core/certificate.h).
#pragma once

#include <cstddef>
#include <vector>

#include "rt_core/certificate.h"

namespace palpate {

// In place of any that `image` already has; with neither places nor a tick there is none.
void append_certificate(std::vector<std::byte>& image, std::span<const CheckedPlace> place,
                        const TickCertificate* tick);

}  // namespace palpate
