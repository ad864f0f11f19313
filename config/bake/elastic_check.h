// Check presses of an elastic body: a ball pressed into large-strain finite elements, refined where it touches, and
// the same ball pressed by ticks into the baked body. Without friction: what is checked is the body.
#pragma once

#include <string>
#include <vector>

#include "config/bake/image_writer.h"
#include "config/elastic/moved_places.h"
#include "config/fem/tet_mesh.h"
#include "config/scene/progress.h"
#include "config/scene/scene.h"
#include "rt_core/certificate.h"

namespace palpate {

// One press along the inward normal of the surface at rest.
struct CheckPress {
  Vec3 place_m, normal;
  double radius_m = 0;               // of the ball
  std::vector<double> depth_m;       // rising; as far as the elements came and the device can render
  bool slides = false;               // deeper, the body goes out from under the ball. The last depth before that is not
                                     // among them: near a limit point the force at a depth says little
  std::vector<double> reference_N;   // along the normal
  std::vector<Vec3> force_w_N = {};  // of the elements on the ball, at the same depths
};
struct CheckedPress {
  std::vector<double> force_N;  // of the baked body, at the press's depths
  double worst_error = 0;       // largest relative one
  double bias = 0;              // mean relative error
  double reach_rootJ = 0;       // longest amplitude of the soft modes on the way
};

// Places that a ball reaches from outside along their normals, spread over the surface: the first farthest from what
// is held, each next farthest from those before. As deep as the scene says, and as 0.45 of what lies between a place
// and its support.
std::vector<CheckPress> check_places(const SceneDesc& scene, const ImageContents& image, const TetMesh& mesh,
                                     int count);
// Check presses that a baker makes of itself where a factor of the body takes so many multiplications: all that are
// `wanted`, or as many as are done in some ten minutes of one processor; none where one takes longer.
int affordable_presses(int wanted, double factor_multiplications);
// What one of them takes of a processor, about, s. A cup of 50,458 nodes (a factor of 2.7e10): 175 and 117 s
// beside other work (2026-11-28).
inline double press_seconds(double factor_multiplications) { return 5e-9 * factor_multiplications; }

// Edges of the elements under the ball, of the contact's radius at the deepest. 0.3 instead changes the forces on a
// ring by 0.0 to 0.7 % (2026-11-22).
inline constexpr double kCheckEdgeShare = 0.45;
// Solves for the reference of one press, with elements as fine as the force in the baked `image` asks for. Returns how
// many nodes they have. Throws ConfigError when the finer mesh cannot be made. `surface`: if not null, where the
// middles of the elements' outer facets are at the deepest of the press's depths.
int press_elements(const SceneDesc& scene, const ImageContents& image, const TetMesh& mesh, CheckPress& press,
                   double edge_share = kCheckEdgeShare, std::vector<elastic::MovedPlace>* surface = nullptr);

// `image`, complete, with a frictionless ball of the press's radius as its only tool.
ImageContents with_ball(const SceneDesc& scene, const ImageContents& image, double radius_m);
// Errors are zero where the press has no reference yet.
CheckedPress press_baked(const ImageContents& with_ball, const CheckPress& press);
// The same of any model whose only tool is the press's ball.
CheckedPress press_model(Model model, const CheckPress& press);
// What an image keeps of a press that has a reference.
CheckedPlace checked_place(const CheckPress& press, const CheckedPress& checked);

}  // namespace palpate
