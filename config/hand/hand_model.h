// The human hand as a tool: 21 joints, 15 finger parts that touch and a palm that supports (Cui & Xiao 2008).
// Tool frame: origin in the palm's middle, x towards the fingertips, y towards the thumb's side (of a left hand: away
// from it), z out of the back of the hand. Lengths in metres, angles in radians.
#pragma once

#include <array>
#include <vector>

#include "config/bake/tool_points.h"
#include "config/scene/scene.h"
#include "rt_core/model.h"

namespace palpate {

inline constexpr std::int32_t kHandParts = 15;
inline constexpr std::int32_t kPalmPart = 16;  // ToolPiece::part of the palm; fingers have 1 to 15

// One row of Table I of Cui & Xiao 2008. Rows run from the tip of a finger to its root; rows 13 to 15 are the thumb (in
// print the fingers' labels have slipped by one).
struct HandPart {
  const char* name;
  double width_m, length_m;
  double neighbourhood_radius_m;  // of the local dent
};
const std::array<HandPart, kHandParts>& hand_parts();

struct HandTool {
  std::vector<PieceDesc> piece;            // 15 capsules, thumb first, roots before tips; then the palm
  std::vector<std::int32_t> piece_joint;   // -1: the palm
  std::vector<std::int32_t> piece_finger;  // 0 thumb, 1 index ... 4 little, 5 palm
  std::vector<Joint> joint;                // 5 of the thumb, then 4 of each finger; open = closed = stretched out
};

// The thumb's root lies on the side of -y. Of a baked hand.
bool is_left_hand(const Model& model);

// Joints of finger f (0 thumb) are joint[first] ... joint[first + count - 1]. `flexion` lists those that close it, root
// first: one for each of its three parts.
struct FingerJoints {
  std::int32_t first, count;
  std::array<std::int32_t, 3> flexion;
};
FingerJoints finger_joints(std::int32_t finger);
// Thumb to little finger.
const char* finger_name(std::int32_t finger);

// Fingers that take part in a grasp.
bool takes_part(GraspFingers grasp, std::int32_t finger);

// `points` tool points along the core of each part.
HandTool make_hand(const HandDesc& hand);

// Where the parts' points are (hand.contact) and for how much surface each stands. A finger part touches with a strip
// of its palm's side, not all around: as long as the capsule's core and a rounding, and about as wide as its radius (at
// a third of the radius deep the exact width is 1.5 radii, at the first touch 0).
void shape_hand_points(const HandDesc& hand, Tool& tool);
// Where the palm can push: params.palm_radius_m and palm_face_m.
void set_palm(const HandTool& hand, ModelParams& params);

// One finger alone, with its base frame at `base_tool`: for tests of the kinematics. Lengths from root to tip.
std::vector<Joint> finger_chain(const Pose& base_tool, const std::array<double, 3>& length_m,
                                std::int32_t parent_offset, std::int32_t finger, double speed_rad_per_s);
std::vector<Joint> thumb_chain(const Pose& base_tool, const std::array<double, 3>& length_m, double speed_rad_per_s);
// Fills zero_inverse of all joints.
void set_zero_poses(std::vector<Joint>& joints);

}  // namespace palpate
