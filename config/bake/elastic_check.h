// Check presses of an elastic body: a ball pressed into large-strain finite elements, refined where it touches, and
// the same ball pressed by ticks into the baked body. Without friction: what is checked is the body.
#pragma once

#include <string>
#include <vector>

#include "config/bake/image_writer.h"
#include "config/fem/tet_mesh.h"
#include "config/scene/progress.h"
#include "config/scene/scene.h"

namespace palpate {

// One press along the inward normal of the surface at rest.
struct CheckPress {
  Vec3 place_m, normal;
  double radius_m = 0;              // of the ball
  std::vector<double> depth_m;      // rising; as far as the elements came and the device can render
  bool slides = false;              // deeper, the body goes out from under the ball. The last depth before that is not
                                    // among them: near a limit point the force at a depth says little
  std::vector<double> reference_N;  // along the normal
};
struct CheckedPress {
  std::vector<double> force_N;  // of the baked body, at the press's depths
  double worst_error = 0;       // largest relative one
  double bias = 0;              // mean relative error
  double reach_rootJ = 0;       // longest amplitude of the soft modes on the way
};

// Places that a ball reaches from outside along their normals, spread over the surface: the first farthest from what
// is held, each next farthest from those before.
std::vector<CheckPress> check_places(const SceneDesc& scene, const ImageContents& image, const TetMesh& mesh,
                                     int count);
// Solves for the reference of one press, with elements as fine as the force in the baked `image` asks for. Throws
// ConfigError when the finer mesh cannot be made.
void press_elements(const SceneDesc& scene, const ImageContents& image, const TetMesh& mesh, CheckPress& press);

// `image`, complete, with a frictionless ball of the press's radius as its only tool.
ImageContents with_ball(const SceneDesc& scene, const ImageContents& image, double radius_m);
// Errors are zero where the press has no reference yet.
CheckedPress press_baked(const ImageContents& with_ball, const CheckPress& press);

}  // namespace palpate
