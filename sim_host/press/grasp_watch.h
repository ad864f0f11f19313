// Whether a hand holds its body, judged while a run or a replay goes on: twenty times a second of its time, from what
// the tick tells of each region. The tick itself does not judge: no force of it would change.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/model.h"
#include "rt_core/record.h"

namespace palpate {

class GraspWatch {
 public:
  // `model` must outlive it. Tools that are no hand are not judged.
  explicit GraspWatch(const Model& model);
  // One tick. One thread at a time.
  void take(const TickRecord& record);
  std::uint64_t looks() const { return looks_; }  // with a finger on the body
  std::uint64_t held() const { return held_; }    // of them, within the friction cones
  // A line for the report of a run; "" when nothing was judged.
  std::string text() const;

 private:
  const Model& model_;
  std::uint64_t every_ticks_, looks_ = 0, held_ = 0;
  double worst_N_ = 0, worst_s_ = 0, from_s_ = 0, until_s_ = 0;
};

}  // namespace palpate
