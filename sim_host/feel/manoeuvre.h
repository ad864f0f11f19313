// What the simulated hand does at a scene's place of contact: a table of manoeuvres, from a tap to a hand that beats
// the motors.
#pragma once

#include <string>
#include <vector>

#include "config/scene/scene.h"
#include "sim_host/feel/feel_loop.h"

namespace palpate {

// X(name, title, what the hand does)
#define PALPATE_MANOEUVRES(X)                                                                           \
  X(kTap, "tap", "six taps to 4 mm at 0.3 m/s")                                                         \
  X(kPress, "press", "in to 8 mm within half a second, rest, out")                                      \
  X(kSlide, "slide", "in to 5 mm, 20 mm along the surface in a second and back, out")                   \
  X(kLoop, "loop", "four closed rounds of press, slide, lift, back")                                    \
  X(kHold, "hold", "in to 6 mm, two seconds at rest")                                                   \
  X(kTremor, "tremor", "the same with a tremor of 0.1 mm and 0.1 degree at 9 Hz")                       \
  X(kTurn, "turn", "in to 5 mm, turned by 20 degrees either way about two axes, out")                   \
  X(kOverload, "overload", "slowly to 60 mm with a hand of 2000 N/m, which beats the motors, and back") \
  X(kPush, "push", "through to 60 mm at 0.5 m/s with that hand, and back as fast")                      \
  X(kTeleport, "teleport", "in to 5 mm; the encoder jumps 4 mm in, 4 mm out, 4 mm aside and back")      \
  X(kLost, "lost", "in to 6 mm; 1, 2, 3 and 5 samples are lost")                                        \
  X(kGap, "gap", "in to 6 mm and out, and along at 5 mm; 4, 10 and 30 samples are lost on the way")     \
  X(kSlow, "slow", "a press with a device that sends 400 samples a second")                             \
  X(kPath, "path", "the scene's own path")

enum class Manoeuvre {
#define PALPATE_MANOEUVRE(name, title, what) name,
  PALPATE_MANOEUVRES(PALPATE_MANOEUVRE)
#undef PALPATE_MANOEUVRE
};
struct ManoeuvreText {
  Manoeuvre manoeuvre;
  const char* title;
  const char* what;
};
const std::vector<ManoeuvreText>& manoeuvre_texts();
// Throws std::runtime_error that lists the titles.
Manoeuvre manoeuvre_of(const std::string& title);

// Where and how the tool meets the body.
struct TouchPlace {
  Pose touch_w;                    // of the handle, where contact begins (articulated tools: where they hold the body)
  Vec3 out_w;                      // unit, away from the body
  Vec3 along_w;                    // unit, across it
  std::vector<HandPose> approach;  // how the hand gets there; empty: straight in from outside
  double approach_s = 0;
  std::vector<HandPose> own;  // the scene's own path
};
// Plays the scene's own path without a hand until the force reaches half a newton there. Articulated tools: where the
// fingers are closed most. Throws std::runtime_error when the path meets no body.
TouchPlace touch_place_of(const Model& model, const SceneDesc& scene);

// How a hand holds the handle.
struct HandModel {
  const char* title;
  double stiffness_N_per_m, damping_N_s_per_m, mass_kg;
};
// light, medium, firm, strong
const std::vector<HandModel>& hand_models();

// Path, events, tremor, sample rate and, where the manoeuvre needs a strong one, hand of `manoeuvre`, into `setup`.
void set_manoeuvre(Manoeuvre manoeuvre, const TouchPlace& place, FeelSetup& setup);

}  // namespace palpate
