// What an image's file says of the scene: how far its force is from finite elements where it was pressed, and what the
// dearest tick takes that a search found.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace palpate {

// Of a whole file that was opened.
bool is_certified(std::span<const std::byte> file);
std::string certificate_text(std::span<const std::byte> file);

}  // namespace palpate
