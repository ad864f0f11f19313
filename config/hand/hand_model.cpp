#include "config/hand/hand_model.h"

#include "config/hand/hand_surface.h"
#include "rt_core/math.h"
#include "rt_core/tool/articulate.h"

namespace palpate {

namespace {

constexpr double kDegree = kPi / 180;

Quat turn_x(double angle) { return rotation_of({angle, 0, 0}); }

// A standard Denavit-Hartenberg row: sign q about z, then a along x and alpha about x.
Joint row(double sign, double a_m, double alpha, double lowest_deg, double highest_deg, std::int32_t parent,
          std::int32_t finger, double speed) {
  Joint joint{};
  joint.after = {{a_m, 0, 0}, turn_x(alpha)};
  joint.lowest = lowest_deg * kDegree;
  joint.highest = highest_deg * kDegree;
  joint.speed_max = speed;
  joint.sign = sign;
  joint.parent = parent;
  joint.kind = JointKind::kTurn;
  joint.finger = finger;
  return joint;
}

// Where each finger is rooted in the palm. Free data: the paper gives no palm. Metacarpal heads lie in a shallow arch
// (the little finger's 4 mm nearer the palm's surface), spaced by the fingers' widths. The thumb's root is where its
// three parts can wrap a bar held against the palm; at rest it points out of the palm and 25 degrees to its side.
constexpr double kThumbSpread = 25 * kDegree;
Pose root_of(std::int32_t finger) {
  switch (finger) {
    case 0: {
      // Columns: x out of the palm (-z), y = -y, z = -x, then turned about its own z to the side.
      const Quat out{0, 0.70710678118654752, 0, -0.70710678118654752};
      return {{-0.003, 0.034, -0.010}, normalised(out * rotation_of({0, 0, -kThumbSpread}))};
    }
    case 1:
      return {{0.040, 0.021, 0}, {}};
    case 2:
      return {{0.041, 0.0055, 0}, {}};
    case 3:
      return {{0.039, -0.010, 0}, {}};
    default:
      return {{0.035, -0.022, -0.004}, {}};
  }
}

// Row of Table I (from 0) of a finger's part, 0 at the root.
std::size_t table_row(std::int32_t finger, std::int32_t part) {
  constexpr std::int32_t kRoot[] = {14, 2, 5, 8, 11};
  return static_cast<std::size_t>(kRoot[finger] - part);
}

// The part's capsule in the tool frame with all joints at zero: every finger is then straight along its root's x. The
// core leaves a fifth of the part free at each joint, where the skin folds; a fingertip ends at its full length.
PieceDesc part_piece(std::int32_t finger, std::int32_t part, const Pose& root, double start_m, std::int32_t points) {
  const HandPart& row = hand_parts()[table_row(finger, part)];
  const double radius = 0.5 * row.width_m;
  const double begin = 0.2 * row.length_m, end = part == 2 ? row.length_m - radius : 0.8 * row.length_m;
  PieceDesc piece;
  piece.shape = PieceShape::kCapsule;
  piece.radius_m = radius;
  piece.length_m = end - begin + 2 * radius;
  piece.position_m = transform(root, {start_m + 0.5 * (begin + end), 0, 0});
  const Quat along_x = rotation_between({0, 0, 1}, {1, 0, 0});
  const Quat q = root.orientation * along_x;
  const Vec3 axis{q.x, q.y, q.z};
  const double sine = norm(axis);
  const double angle = 2 * math::atan2(sine, q.w);
  piece.rotation_rad = sine > 1e-12 ? (angle / sine) * axis : Vec3{};
  piece.points = points;
  piece.part = static_cast<std::int32_t>(table_row(finger, part)) + 1;
  return piece;
}

PieceDesc palm_piece() {
  PieceDesc palm;
  palm.shape = PieceShape::kBox;
  palm.position_m = {-0.004, 0, 0};
  palm.size_m = {0.080, 0.066, 0.016};
  palm.margin_m = 0.006;
  palm.points = 0;
  palm.part = kPalmPart;
  return palm;
}

std::array<double, 3> lengths_of(std::int32_t finger) {
  std::array<double, 3> length;
  for (std::int32_t part = 0; part < 3; ++part)
    length[static_cast<std::size_t>(part)] = hand_parts()[table_row(finger, part)].length_m;
  return length;
}

// The mirror image in the tool's plane y = 0, of places and of turns. A turn by q about a mirrored axis is one by -q.
Vec3 mirrored(Vec3 p) { return {p.x, -p.y, p.z}; }
Pose mirrored(const Pose& pose) {
  const Quat q = pose.orientation;
  return {mirrored(pose.position_m), {q.w, -q.x, q.y, -q.z}};
}
void mirror(HandTool& tool) {
  for (PieceDesc& piece : tool.piece) {
    piece.position_m = mirrored(piece.position_m);
    piece.rotation_rad = -mirrored(piece.rotation_rad);
  }
  for (Joint& joint : tool.joint) {
    joint.before = mirrored(joint.before);
    joint.after = mirrored(joint.after);
    joint.sign = -joint.sign;
  }
}

}  // namespace

const std::array<HandPart, kHandParts>& hand_parts() {
  static constexpr std::array<HandPart, kHandParts> kParts{{
      {"index distal", 0.012, 0.0251, 0.010},
      {"index middle", 0.012, 0.0215, 0.010},
      {"index proximal", 0.012, 0.0269, 0.010},
      {"middle distal", 0.015, 0.0272, 0.012},
      {"middle middle", 0.016, 0.0243, 0.013},
      {"middle proximal", 0.017, 0.0303, 0.014},
      {"ring distal", 0.012, 0.0252, 0.010},
      {"ring middle", 0.012, 0.0209, 0.010},
      {"ring proximal", 0.012, 0.0272, 0.010},
      {"little distal", 0.008, 0.0189, 0.007},
      {"little middle", 0.009, 0.0156, 0.007},
      {"little proximal", 0.010, 0.0168, 0.008},
      {"thumb distal", 0.015, 0.0269, 0.018},
      {"thumb proximal", 0.014, 0.0335, 0.013},
      {"thumb metacarpal", 0.014, 0.0389, 0.010},
  }};
  return kParts;
}

bool is_left_hand(const Model& model) { return !model.joint.empty() && model.joint[0].before.position_m.y < 0; }

FingerJoints finger_joints(std::int32_t finger) {
  if (finger == 0) return {0, 5, {1, 3, 4}};
  const std::int32_t first = 5 + 4 * (finger - 1);
  return {first, 4, {first + 1, first + 2, first + 3}};
}

const char* finger_name(std::int32_t finger) {
  static constexpr const char* kNames[kMaxFingers] = {"thumb", "index", "middle", "ring", "little"};
  return kNames[finger];
}

bool takes_part(GraspFingers grasp, std::int32_t finger) {
  switch (grasp) {
    case GraspFingers::kTwo:
      return finger <= 1;
    case GraspFingers::kThree:
      return finger <= 2;
    case GraspFingers::kFive:
      return true;
  }
  return false;
}

// Limits: clinical ranges of motion. psi, the spread of a finger, then its three flexions, towards the palm.
std::vector<Joint> finger_chain(const Pose& base_tool, const std::array<double, 3>& length_m,
                                std::int32_t parent_offset, std::int32_t finger, double speed) {
  std::vector<Joint> chain{row(1, 0, 0.5 * kPi, -15, 15, -1, finger, speed),
                           row(-1, length_m[0], 0, -20, 90, parent_offset, finger, speed),
                           row(-1, length_m[1], 0, 0, 105, parent_offset + 1, finger, speed),
                           row(-1, length_m[2], 0, 0, 80, parent_offset + 2, finger, speed)};
  chain[0].before = base_tool;
  return chain;
}

// Root joint spread and flexion, metacarpophalangeal spread and flexion, interphalangeal flexion.
std::vector<Joint> thumb_chain(const Pose& base_tool, const std::array<double, 3>& length_m, double speed) {
  std::vector<Joint> chain{row(1, 0, 0.5 * kPi, 0, 60, -1, 0, speed),
                           row(-1, length_m[0], -0.5 * kPi, -20, 35, 0, 0, speed),
                           row(1, 0, 0.5 * kPi, -10, 10, 1, 0, speed), row(-1, length_m[1], 0, -10, 55, 2, 0, speed),
                           row(-1, length_m[2], 0, -15, 80, 3, 0, speed)};
  chain[0].before = base_tool;
  return chain;
}

void set_zero_poses(std::vector<Joint>& joints) {
  Model model;
  model.joint = joints;
  const double zero[kMaxJoints] = {};
  Pose link[kMaxJoints];
  place_links(model, zero, link, nullptr, nullptr);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Quat back = conjugate(link[j].orientation);
    joints[j].zero_inverse = {-rotate(back, link[j].position_m), back};
  }
}

HandTool make_hand(const HandDesc& hand) {
  HandTool tool;
  const double speed = hand.joint_speed_rad_per_s;
  const std::int32_t points =
      hand.contact == HandContact::kMesh ? surface_point_count(hand.points_per_part) : hand.points_per_part;
  for (std::int32_t finger = 0; finger < kMaxFingers; ++finger) {
    const Pose root = root_of(finger);
    const std::array<double, 3> length = lengths_of(finger);
    const FingerJoints joints = finger_joints(finger);
    const std::vector<Joint> chain =
        finger == 0 ? thumb_chain(root, length, speed) : finger_chain(root, length, joints.first, finger, speed);
    tool.joint.insert(tool.joint.end(), chain.begin(), chain.end());
    double start = 0;
    for (std::int32_t part = 0; part < 3; ++part) {
      const auto at = static_cast<std::size_t>(part);
      tool.piece.push_back(part_piece(finger, part, root, start, points));
      tool.piece_joint.push_back(joints.flexion[at]);
      tool.piece_finger.push_back(finger);
      start += length[at];
    }
  }
  tool.piece.push_back(palm_piece());
  tool.piece_joint.push_back(-1);
  tool.piece_finger.push_back(kMaxFingers);
  // Stretched out; the thumb's spread undone, so that it bends in the plane of the fingers.
  for (Joint& joint : tool.joint) joint.open = joint.closed = clamp_to(0, joint.lowest, joint.highest);
  tool.joint[0].open = tool.joint[0].closed =
      clamp_to(hand.thumb_spread_rad, tool.joint[0].lowest, tool.joint[0].highest);
  if (hand.side == HandSide::kLeft) mirror(tool);
  set_zero_poses(tool.joint);
  return tool;
}

void shape_hand_points(const HandDesc& hand, Tool& tool) {
  if (hand.contact == HandContact::kMesh) touch_with_mesh(tool);
  for (ToolPoint& point : tool.point) {
    const ToolPiece& piece = tool.piece[static_cast<std::size_t>(point.piece)];
    point.area_m2 = piece.margin_m * (2 * piece.half_extent_m[2] + piece.margin_m) / piece.point_count;
  }
}

void set_palm(const HandTool& hand, ModelParams& params) {
  const Vec3 size_m = hand.piece.back().size_m;
  params.palm_radius_m = 0.5 * min_of(size_m.x, size_m.y);
  params.palm_face_m = 0.5 * size_m.z;
}

}  // namespace palpate
