// Closing by force (hand.closing = "balanced"): where the joints must end for each finger to press with a stated force
// and the thumb to oppose them.
#pragma once

#include <string>
#include <vector>

#include "config/bake/image_writer.h"
#include "config/scene/scene.h"

namespace palpate {

struct BalancedClosing {
  std::vector<double> closed;  // of each joint
  FingerNumbers normal_N{};    // what each finger then presses with: the sum over its parts
  // What the palm's push leaves of the fingers' normal forces on the body, moments over half the body's length:
  // friction must hold it.
  double left_N = 0;
  int rounds = 0;
  std::string warning;  // what could not be had; empty: nothing
};

// Solves for the closed positions on the tick itself: the hand at hand.grasp_mm closes from open in the scene's own
// contact law, and Gauss and Newton's method turns the joints until each finger presses with its force, its parts
// evenly where the joints' limits allow it. The thumb's parts press with what leaves least of the wrench of all for
// friction, the palm pushing as it likes: non-negative least squares. None of them with less than half of the other
// fingers' mean part, and a newton of theirs counts a tenth of one that is left, or the last thousandths would be had
// by squeezing. `image` is one that may be ticked, with the preshape's joints (preshape.h): a part that they do not
// bring to the body stays where it is, its finger's other parts share its load. Deterministic.
BalancedClosing close_balanced(const ImageContents& image, const HandDesc& hand);

}  // namespace palpate
