#include "sim_host/press/grasp_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim_host/press/grasp_stability.h"

namespace palpate {

GraspWatch::GraspWatch(const Model& model) : model_(model) {
  constexpr double kLook_s = 0.05;  // a look takes the host about a millisecond
  every_ticks_ = static_cast<std::uint64_t>(std::max(1.0, std::round(kLook_s / model.params.period_s)));
}

void GraspWatch::take(const TickRecord& record) {
  if (model_.params.articulation != Articulation::kHand) return;
  if (record.tick % every_ticks_ != 0 || record.region_count == 0) return;
  const Grasp grasp = grasp_of(model_, record);
  const double time_s = static_cast<double>(record.tick) * model_.params.period_s;
  looks_ += 1;
  if (holds(grasp)) {
    if (held_++ == 0) from_s_ = time_s;
    until_s_ = time_s;
    return;
  }
  const double left_N = imbalance_N(grasp, 1);
  if (!(left_N > worst_N_)) return;
  worst_N_ = left_N;
  worst_s_ = time_s;
}

std::string GraspWatch::text() const {
  if (looks_ == 0) return "";
  std::string text =
      fmt::format("grasp   held the body's weight within the stated friction in {} of {} looks", held_, looks_);
  if (held_ > 0) text += fmt::format(", from {:.2f} to {:.2f} s", from_s_, until_s_);
  if (held_ < looks_) text += fmt::format("; most is missing at {:.2f} s: {:.3f} N", worst_s_, worst_N_);
  return text + "\n";
}

}  // namespace palpate
