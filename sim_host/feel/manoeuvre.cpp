#include "sim_host/feel/manoeuvre.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "rt_core/tick.h"
#include "sim_host/press/pose_csv.h"
#include "sim_host/tick_memory.h"

namespace palpate {

namespace {

constexpr double kClear_m = 0.010;  // outside the body, where a manoeuvre begins and ends
constexpr double kDegree = kPi / 180;
constexpr double kPeakOfMean = 1.875;  // speed of a minimum-jerk motion

// The hand's path, told in coordinates of the place: out of the body, along it, turns about two axes.
class PathMaker {
 public:
  PathMaker(const TouchPlace& place) : place_(place), pose_(place.approach) {
    time_s_ = place.approach_s;
    if (pose_.empty()) {
      out_m_ = kClear_m;
      add();
      rest(0.3);  // the force ramps in
    } else {
      rest(0.2);
    }
  }
  PathMaker& to(double out_m, double seconds) {
    out_m_ = out_m;
    return after(seconds);
  }
  PathMaker& at_speed(double out_m, double peak_m_per_s) {
    return to(out_m, kPeakOfMean * std::max(1e-3, std::abs(out_m - out_m_)) / peak_m_per_s);
  }
  PathMaker& aside(double along_m, double seconds) {
    along_m_ = along_m;
    return after(seconds);
  }
  PathMaker& turn(Vec3 turn_rad, double seconds) {
    turn_rad_ = turn_rad;
    return after(seconds);
  }
  PathMaker& rest(double seconds) { return after(seconds); }
  double time_s() const { return time_s_; }
  HandPath path() const { return HandPath(pose_); }

 private:
  PathMaker& after(double seconds) {
    time_s_ += seconds;
    add();
    return *this;
  }
  void add() {
    Pose pose = place_.touch_w;
    pose.position_m += out_m_ * place_.out_w + along_m_ * place_.along_w;
    pose.orientation = rotation_by(turn_rad_) * pose.orientation;
    pose_.push_back({time_s_, pose, !place_.approach.empty() && place_.approach.back().trigger});
  }
  const TouchPlace& place_;
  std::vector<HandPose> pose_;
  double time_s_ = 0, out_m_ = 0, along_m_ = 0;
  Vec3 turn_rad_;
};

void set_hand(const HandModel& hand, PlantOptions& plant) {
  plant.hand_stiffness_N_per_m = hand.stiffness_N_per_m;
  plant.hand_damping_N_s_per_m = hand.damping_N_s_per_m;
  plant.hand_mass_kg = hand.mass_kg;
}

void set_tap(PathMaker& hand) {
  for (int i = 0; i < 6; ++i) hand.at_speed(-0.004, 0.3).rest(0.03).at_speed(kClear_m, 0.3).rest(0.05);
}

void set_loop(PathMaker& hand) {
  for (int i = 0; i < 4; ++i) hand.to(-0.005, 0.2).aside(0.01, 0.3).to(kClear_m, 0.2).aside(0, 0.3);
}

void set_turn(const TouchPlace& place, PathMaker& hand) {
  hand.to(-0.005, 0.4);
  for (const Vec3 axis : {place.along_w, place.out_w})
    hand.turn(20 * kDegree * axis, 0.3).turn(-20 * kDegree * axis, 0.6).turn({}, 0.3);
  hand.to(kClear_m, 0.3);
}

void set_teleport(const TouchPlace& place, PathMaker& hand, FeelSetup& setup) {
  constexpr double kJump_m = 0.004;
  hand.to(-0.005, 0.4).rest(0.2);
  for (const Vec3 jump : {-place.out_w, place.out_w, place.along_w, -place.along_w}) {
    setup.event.push_back({hand.time_s(), 0, kJump_m * jump});
    hand.rest(0.3);
  }
  hand.to(kClear_m, 0.3);
}

void set_lost(PathMaker& hand, FeelSetup& setup) {
  hand.to(-0.006, 0.4).rest(0.2);
  for (const std::uint32_t lose : {1u, 2u, 3u, 5u}) {
    setup.event.push_back({hand.time_s(), lose, {}});
    hand.rest(0.2);
  }
  hand.to(kClear_m, 0.3);
}

// Longer than is bridged: with the shipped device 4 end in the passive mode, 10 and 30 in the ramp. Each is lost half
// way in, at depth, half way out and along the surface.
void set_gap(PathMaker& hand, FeelSetup& setup) {
  for (const std::uint32_t lose : {4u, 10u, 30u}) {
    const auto gap_after = [&](double seconds) { setup.event.push_back({hand.time_s() + seconds, lose, {}}); };
    gap_after(0.15);
    hand.to(-0.006, 0.4);
    gap_after(0.1);
    hand.rest(0.4);
    gap_after(0.1);
    hand.to(kClear_m, 0.4).to(-0.005, 0.4);
    gap_after(0.2);
    hand.aside(0.02, 0.6);
    gap_after(0.3);
    hand.aside(0, 0.6).to(kClear_m, 0.3);
  }
}

HandPose hand_pose(const PathPoint& point) {
  return {point.time_s, {point.position_m, rotation_by(point.rotation_rad)}, false};
}

// The articulated tool's place: the last pose at which its fingers are told to be as closed as they ever are.
TouchPlace grasped(const SceneDesc& scene) {
  TouchPlace place;
  const auto closing = [](const PathPoint& point) {
    double sum = 0;
    for (const double c : point.closing) sum += c;
    return sum;
  };
  double most = 0, now = 0;
  std::size_t held = 0;
  for (std::size_t i = 0; i < scene.path.point.size(); ++i) {
    if (!scene.path.point[i].closing.empty()) now = closing(scene.path.point[i]);
    if (now > most) most = now, held = i;  // the first: before the scene's own sway
  }
  for (std::size_t i = 0; i <= held; ++i) place.approach.push_back(hand_pose(scene.path.point[i]));
  place.touch_w = place.approach.back().pose;
  place.approach_s = place.approach.back().time_s;
  place.out_w = unit_or(place.approach.front().pose.position_m - place.touch_w.position_m, {0, 1, 0});
  place.along_w = unit_or(cross(axis_off(place.out_w), place.out_w), {1, 0, 0});
  return place;
}

// A rigid tool's: where the scene's path first presses.
TouchPlace first_touch(const Model& model, const SceneDesc& scene) {
  constexpr double kTouch_N = 0.5;
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Output output;
  for (const TimedPose& pose : scripted_poses(scene.path, model.params.period_s)) {
    Input input;
    input.pose_w = pose.tool_w;
    input.drive = Drive::kHeld;
    tick(model, *state, *scratch, input, output);
    if (!(norm(output.device_w.force_N) > kTouch_N)) continue;
    TouchPlace place;
    place.touch_w = pose.tool_w;
    place.out_w = unit_or(output.device_w.force_N, {0, 1, 0});
    place.along_w = unit_or(tangential_part({1, 0, 0}, place.out_w), axis_off(place.out_w));
    return place;
  }
  throw std::runtime_error(scene.name + ": its path meets no body with half a newton; give it a [path] that presses");
}

}  // namespace

const std::vector<ManoeuvreText>& manoeuvre_texts() {
  static const std::vector<ManoeuvreText> texts{
#define PALPATE_MANOEUVRE(name, title, what) {Manoeuvre::name, title, what},
      PALPATE_MANOEUVRES(PALPATE_MANOEUVRE)
#undef PALPATE_MANOEUVRE
  };
  return texts;
}

Manoeuvre manoeuvre_of(const std::string& title) {
  std::string known;
  for (const ManoeuvreText& text : manoeuvre_texts()) {
    if (title == text.title) return text.manoeuvre;
    known += fmt::format(" {}", text.title);
  }
  throw std::runtime_error(fmt::format("no manoeuvre '{}'; there are:{}", title, known));
}

const std::vector<HandModel>& hand_models() {
  // Impedances of a hand on a handle, from two fingers to a braced fist; mass is what moves with the handle.
  static const std::vector<HandModel> hands{
      {"light", 100, 1, 0.05}, {"medium", 300, 5, 0.1}, {"firm", 800, 8, 0.1}, {"strong", 2000, 16, 0.2}};
  return hands;
}

TouchPlace touch_place_of(const Model& model, const SceneDesc& scene) {
  TouchPlace place = scene.articulation != Articulation::kRigid ? grasped(scene) : first_touch(model, scene);
  for (const PathPoint& point : scene.path.point) place.own.push_back(hand_pose(point));
  return place;
}

void set_manoeuvre(Manoeuvre manoeuvre, const TouchPlace& place, FeelSetup& setup) {
  PathMaker hand(place);
  switch (manoeuvre) {
    case Manoeuvre::kTap:
      set_tap(hand);
      break;
    case Manoeuvre::kSlow:
      setup.sample_period_s = 2.5e-3;
      [[fallthrough]];
    case Manoeuvre::kPress:
      hand.to(-0.008, 0.5).rest(0.5).to(kClear_m, 0.5);
      break;
    case Manoeuvre::kSlide:
      hand.to(-0.005, 0.3).aside(0.02, 1).aside(0, 1).to(kClear_m, 0.3);
      break;
    case Manoeuvre::kLoop:
      set_loop(hand);
      break;
    case Manoeuvre::kTremor:
      setup.plant.tremor_m = 1e-4;
      setup.plant.tremor_rad = 0.1 * kDegree;
      [[fallthrough]];
    case Manoeuvre::kHold:
      hand.to(-0.006, 0.5).rest(2);
      break;
    case Manoeuvre::kTurn:
      set_turn(place, hand);
      break;
    case Manoeuvre::kOverload:
      set_hand(hand_models().back(), setup.plant);
      hand.to(-0.060, 1.5).rest(0.5).to(kClear_m, 1.5);
      break;
    case Manoeuvre::kPush:
      set_hand(hand_models().back(), setup.plant);
      hand.at_speed(-0.060, 0.5).rest(0.3).at_speed(kClear_m, 0.5).rest(0.2);
      break;
    case Manoeuvre::kTeleport:
      set_teleport(place, hand, setup);
      break;
    case Manoeuvre::kLost:
      set_lost(hand, setup);
      break;
    case Manoeuvre::kGap:
      set_gap(hand, setup);
      break;
    case Manoeuvre::kPath:
      break;
  }
  setup.path = manoeuvre == Manoeuvre::kPath ? HandPath(place.own) : hand.path();
  if (!setup.path.error().empty()) throw std::runtime_error(setup.path.error());
}

}  // namespace palpate
