// Indices in images and meshes are 32 bits with a sign, those of the standard library's containers std::size_t.
#pragma once

#include <cstddef>
#include <cstdint>

namespace palpate {

// i >= 0
constexpr std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace palpate
