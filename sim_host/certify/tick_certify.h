// `palpate certify`: the dearest tick of a scene that a search finds, what it touches, and what it takes here.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rt_core/certificate.h"
#include "sim_host/certify/tick_search.h"
#include "sim_host/press/pose_csv.h"

namespace palpate {

// Of the dearest tick, on this machine beside whatever else it does; the least of many repeats.
struct TickTimes {
  double warm_us = 0;  // its memory in the caches
  double cold_us = 0;  // after they were filled with something else
};

struct Certified {
  TickSearch search;
  TickCertificate certificate{};  // what an image keeps of it
  TickTimes times;
};

Certified certify_ticks(std::span<const std::byte> image, std::span<const TimedPose> path, double hand_N_per_m,
                        const TickSearchOptions& options);

// The image with the certificate; what it says of its force stays.
std::vector<std::byte> with_certificate(std::span<const std::byte> image, const TickCertificate& certificate);

std::string certified_text(const Model& model, const Certified& certified);

}  // namespace palpate
