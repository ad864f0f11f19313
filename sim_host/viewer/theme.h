// Colours of the viewer, those of the still pictures where they show the same thing.
#pragma once

#include "sim_host/view/raster.h"

namespace palpate::theme {

inline constexpr Colour kInk = colour(0x1f2933), kGrey = colour(0x5b6672), kFaint = colour(0x9aa5b1);
inline constexpr Colour kPaper = colour(0xfbfcfd), kLine = colour(0xd9dfe6), kWell = colour(0xf1f4f7);
inline constexpr Colour kForce = colour(0x1b74c4), kFriction = colour(0xd9822b), kFelt = colour(0x2f9e76);
inline constexpr Colour kDepth = colour(0x8a4fbf), kFault = colour(0xc0392b), kWarning = colour(0xc77d0a);
inline constexpr Colour kTool = colour(0x6d8fae), kSkin = colour(0xd8a488), kGhost = colour(0x2f9e76);
inline constexpr Colour kAnchor = colour(0x2f6f8f), kFixed = colour(0x3c434b);
inline constexpr Colour kRunA = colour(0x3b4a5a), kRunB = colour(0xd1495b);  // two runs against one another

}  // namespace palpate::theme
