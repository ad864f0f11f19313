// Keys and sliders that move a hand's fingers and single joints, as with the keyboard of Cui & Xiao 2008 (section V).
#pragma once

#include <string>
#include <vector>

#include "rt_core/model.h"
#include "rt_core/state.h"
#include "sim_host/view/steering.h"

namespace palpate {

// A machine that stalls is no hand that darts: so much of a slow picture's time counts for who moves.
inline constexpr double kMostAtOnce_s = 0.05;

class HandControl {
 public:
  // Held keys move at a quarter of the way in a second: C closes, O opens; all fingers, or those whose keys F1 (thumb)
  // to F5 are held too, or of these, or of the one chosen last, the joints whose keys A to G are held, palm to tip.
  void keys(const Model& model, const State& state, Steering& steering, double elapsed_s);
  // Of the finger chosen: a slider for it and one for each of its joints, with their keys.
  void panel(const Model& model, const State& state, Steering& steering);

 private:
  void joint_slider(const Model& model, const State& state, Steering& steering, std::size_t joint, char key);

  std::int32_t finger_ = 1;  // whose joints the letters move, and the sliders show
};

// The keys that choose a finger or a joint by its name ("": none). Throws std::runtime_error, beginning with `where`,
// when the tool has no such part.
std::vector<int> keys_of_part(const Model& model, const std::string& part, const std::string& where);

}  // namespace palpate
