// What an image's file says of the scene: how far its force is from finite elements where it was pressed, and what the
// dearest tick takes that a search found.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "sim_host/json_output.h"

namespace palpate {

struct TickCertificate;

// Of a whole file that was opened.
bool is_certified(std::span<const std::byte> file);
std::string certificate_text(std::span<const std::byte> file);
// Keys "force" and "tick", null where nothing is certified.
Json certificate_json(std::span<const std::byte> file);
Json tick_json(const TickCertificate& tick);

}  // namespace palpate
