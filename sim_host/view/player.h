// Where in a run a viewer is, and how it goes on: played at some speed, held, put somewhere by hand, or at the end of
// what a live run has brought so far.
#pragma once

#include <algorithm>

namespace palpate {

class Player {
 public:
  bool playing = false;
  double speed = 1;
  bool live = false;  // stays at the end

  double time_s() const { return time_s_; }
  // By hand: leaves the live end unless it is put there.
  void seek(double time_s, double first_s, double last_s) {
    time_s_ = std::clamp(time_s, first_s, std::max(first_s, last_s));
    live = live && time_s >= last_s;
  }
  // Played to the end it stops there; from the end it begins anew.
  void toggle(double first_s, double last_s) {
    playing = !playing;
    if (playing && time_s_ >= last_s) time_s_ = first_s;
  }
  void advance(double elapsed_s, double first_s, double last_s) {
    if (live) {
      time_s_ = std::max(first_s, last_s);
      return;
    }
    if (playing) time_s_ += speed * elapsed_s;
    if (playing && time_s_ >= last_s) playing = false;
    time_s_ = std::clamp(time_s_, first_s, std::max(first_s, last_s));
  }

 private:
  double time_s_ = 0;
};

}  // namespace palpate
