// Someone who holds the tool and means it to take as long as it can: what a baker, a test and a benchmark put a scene
// through. Deterministic: a function of the model and the seed alone.
#pragma once

#include <cstdint>
#include <random>

#include "rt_core/io.h"
#include "rt_core/model.h"

namespace palpate {

class Adversary {
 public:
  Adversary(const Model& model, std::uint64_t seed) : model_(model), random_(seed) {}

  // The next tick's input. In episodes of some fifty ticks: creeping over the surface as a hand does, jumping anywhere
  // on it every tick, sliding fast, pushing towards the middle, spinning, shaking while pressed deep; held by the tool
  // or by the handle, with every joint anywhere. `forgets`: the state is to be reset before that tick.
  Input next(const Output& last, bool& forgets);

  // A tool point on or below a vertex of the surface, up to `deepest_m`, the tool turned anyhow.
  Pose start(double deepest_m);
  double uniform(double low, double high);
  // A direction times up to `most` units. The direction is drawn first: `uniform() * direction()` draws in either
  // order, gcc the direction first and clang the number, and found other worst ticks (2,909,722 and 3,066,924
  // instructions in one grasp, 2026-11-23).
  Vec3 any_way(double most, double unit = 1);
  bool one_in(unsigned n) { return random_() % n == 0; }
  Vec3 direction();

 private:
  enum class Move { kCreep, kJump, kSlide, kPush, kSpin, kShake };
  bool begin();
  void move(const Output& last);

  const Model& model_;
  std::mt19937_64 random_;
  Input input_;
  Move move_ = Move::kCreep;
  Pose middle_;  // of what shakes
  Vec3 drift_, spin_;
  double joint_step_ = 0;
  int left_ = 0;
};

}  // namespace palpate
