#include "sim_host/certify/tick_search.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "config/bake/adversary.h"
#include "rt_core/stage_cost.h"
#include "rt_core/tick.h"

namespace palpate {

namespace {

constexpr std::size_t kClimbers = 12;
// Changes of a pose that a climber tries: from a nanometre, which moves a contact's count, to a millimetre.
constexpr double kLeast_m = 1e-9, kMost_m = 1e-3;
constexpr double kTurn_rad_per_m = 30;

class Searcher {
 public:
  Searcher(const Model& model, const TickSearchOptions& options)
      : model_(model),
        options_(options),
        random_(options.seed),
        state_(make_state(model)),
        before_(make_state(model)),
        scratch_(make_scratch(model)) {}

  TickSearch run(std::span<const Input> path) {
    follow(path);
    Adversary adversary(model_, options_.seed);
    reset(*state_);
    Output output;
    for (std::int64_t t = 0; t < options_.ticks / 2; ++t) {
      bool forgets = false;
      const Input input = adversary.next(output, forgets);
      if (forgets) reset(*state_);
      play(input, output, "an adversary");
      if (t % kKeepEvery == 0) since_kept_ = 0;
    }
    climb();
    result_.dearest = std::move(best_);
    return std::move(result_);
  }

 private:
  static constexpr std::int64_t kKeepEvery = 500;  // climbers from all over the search

  // One tick from state_, noted.
  double play(const Input& input, Output& output, const char* who) {
    copy_state(*state_, *before_);
    tick(model_, *state_, *scratch_, input, output);
    result_.ticks += 1;
    if (options_.progress && result_.ticks % 1000 == 0)
      options_.progress(static_cast<double>(result_.ticks) / static_cast<double>(options_.ticks));
    if (is_beyond_stated(model_, scratch_->work)) result_.beyond_stated += 1;
    for (std::size_t i = 0; i < result_.stage.size(); ++i)
      result_.stage[i] = std::max(result_.stage[i], counted_instructions(scratch_->work, static_cast<Stage>(i)));
    const double cost = counted_instructions(scratch_->work);
    if (cost > best_.instructions) {
      best_ = {cost, copy_of(*before_), input};
      result_.found_by = who;
    }
    if (cost > since_kept_) keep(cost, input);
    return cost;
  }

  void keep(double cost, const Input& input) {
    const auto cheapest = std::ranges::min_element(climber_, {}, &DearTick::instructions);
    if (climber_.size() == kClimbers && cost <= cheapest->instructions) return;
    since_kept_ = cost;
    if (climber_.size() < kClimbers) {
      climber_.push_back({cost, copy_of(*before_), input});
      return;
    }
    cheapest->instructions = cost;
    copy_state(*before_, *cheapest->before);
    cheapest->input = input;
  }

  void follow(std::span<const Input> path) {
    reset(*state_);
    Output output;
    for (const Input& input : path) play(input, output, "the scene's own path");
  }

  // From each climber's state: its input changed a little, or one tick on and then changed. What is dearer is where it
  // goes on from.
  void climb() {
    if (climber_.empty()) return;
    since_kept_ = 1e300;  // climbers replace themselves
    Output output;
    for (std::size_t k = 0; result_.ticks < options_.ticks; k = (k + 1) % climber_.size()) {
      DearTick& from = climber_[k];
      copy_state(*from.before, *state_);
      Input input = from.input;
      if (random_() % 2 == 0) play(input, output, "climbing");
      change(input);
      if (const double cost = play(input, output, "climbing"); cost > from.instructions) {
        from.instructions = cost;
        copy_state(*before_, *from.before);
        from.input = input;
      }
    }
  }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  Vec3 vector() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }

  void change(Input& input) {
    const double step_m = kLeast_m * std::pow(kMost_m / kLeast_m, uniform(0, 1));
    input.pose_w.position_m += step_m * vector();
    input.pose_w.orientation =
        normalised(small_rotation((kTurn_rad_per_m * step_m) * vector()) * input.pose_w.orientation);
    for (std::size_t j = 0; j < model_.joint.size(); ++j) {
      const Joint& joint = model_.joint[j];
      const double moved = static_cast<double>(input.joints.target[j]) + kTurn_rad_per_m * step_m * uniform(-1, 1);
      if ((input.joints.direct & (1u << j)) != 0)
        input.joints.target[j] = static_cast<float>(std::clamp(moved, joint.lowest, joint.highest));
    }
    for (float& closing : input.joints.closing)
      closing = std::clamp(closing + static_cast<float>(kTurn_rad_per_m * step_m * uniform(-1, 1)), 0.0f, 1.0f);
  }

  const Model& model_;
  const TickSearchOptions& options_;
  std::mt19937_64 random_;
  StatePtr state_, before_;
  ScratchPtr scratch_;
  std::vector<DearTick> climber_;
  double since_kept_ = 0;
  DearTick best_;
  TickSearch result_;
};

}  // namespace

TickSearch search_ticks(const Model& model, std::span<const Input> path, const TickSearchOptions& options) {
  return Searcher(model, options).run(path);
}

}  // namespace palpate
