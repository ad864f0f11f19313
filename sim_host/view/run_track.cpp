#include "sim_host/view/run_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rt_core/tick.h"
#include "sim_host/status_text.h"

namespace palpate {

TrackTick track_tick(const TickRecord& record) {
  TrackTick tick;
  tick.tick = record.tick;
  tick.input = record.input;
  tick.contact_N = record.output.contact_w.force_N;
  tick.device_N = record.output.device_w.force_N;
  tick.depth_m = record.output.penetration_m;
  tick.energy_J = record.output.energy_J;
  tick.surplus_J = record.output.surplus_J;
  tick.status = record.output.status;
  tick.fault = record.output.fault;
  tick.mode = record.output.mode;
  tick.regions = record.output.regions;
  for (std::int32_t i = 0; i < std::min(record.region_count, kMaxRegions); ++i)
    tick.largest_region_N = std::max(tick.largest_region_N, norm(record.region[i].force_w));
  tick.wake_ns = record.timing.wake_latency_ns;
  tick.compute_ns = record.timing.compute_ns;
  std::copy(std::begin(record.timing.stage_ns), std::end(record.timing.stage_ns), std::begin(tick.stage_ns));
  return tick;
}

std::uint32_t telling_status(std::uint32_t status) {
  // The rest of what a healthy run shows: ramps at the start, joints that stop, one sample held.
  constexpr std::uint32_t kOrdinary = Status::kRamping | Status::kJointStopped | Status::kInputHeld;
  return status & ~kOrdinary;
}

void RunTrack::note(TrackEvent::Kind kind, std::string text) {
  events_.push_back({kind, ticks_.size() - 1, std::move(text)});
}

// Contact that comes back within this is the same contact: a slide over a facet is no event.
constexpr double kSameContact_s = 0.05;

void RunTrack::find_events(const TrackTick& tick) {
  const std::size_t here = ticks_.size() - 1;
  const auto same = static_cast<std::size_t>(kSameContact_s / period_s_);
  if (tick.regions > 0) {
    if (!touching_) note(TrackEvent::Kind::kTouch, "first touch");
    touching_ = true;
    last_touching_ = here;
  } else if (touching_ && here > last_touching_ + same) {
    note(TrackEvent::Kind::kLetGo, "let go");
    touching_ = false;
  }
  const TrackTick before = ticks_.size() > 1 ? ticks_[here - 1] : TrackTick{};
  const bool steps_in = tick.mode == Mode::kForce && before.mode == Mode::kIdle;
  const bool steps_out = tick.mode == Mode::kIdle && before.mode != Mode::kIdle;
  find_fades(tick, before);
  if (steps_in) note(TrackEvent::Kind::kMode, "armed");
  if (steps_out) note(TrackEvent::Kind::kMode, "at rest");
  if (const std::uint32_t fresh = tick.fault & ~before.fault; fresh != 0)
    note(TrackEvent::Kind::kFault, bit_names(fault_bit_texts(), fresh));
  // Each kind of warning once: at its first tick.
  if (const std::uint32_t fresh = telling_status(tick.status) & ~warned_; fresh != 0) {
    note(TrackEvent::Kind::kWarning, bit_names(status_bit_texts(), fresh));
    warned_ |= fresh;
  }
}

// Force let go and taken up again within half a second of one another is one spell: a device that is late now and then.
void RunTrack::find_fades(const TrackTick& tick, const TrackTick& before) {
  constexpr double kSameSpell_s = 0.5;
  const std::size_t here = ticks_.size() - 1;
  const auto renders = [](Mode mode) { return mode == Mode::kForce || mode == Mode::kHold; };
  const bool fades = tick.mode == Mode::kPassive || tick.mode == Mode::kRamp;
  // At the end of a run, with the operator's stop, a ramp is order; the mark is "at rest" then.
  const bool begins = renders(before.mode) && fades && (tick.input.commands & Command::kStop) == 0;
  if (begins && !fading_) note(TrackEvent::Kind::kWarning, "force fades");
  fading_ = fading_ || begins;
  if (fading_ && fades) last_fading_ = here;
  if (!fading_ || static_cast<double>(here - last_fading_) * period_s_ < kSameSpell_s) return;
  fading_ = false;
  if (renders(tick.mode)) events_.push_back({TrackEvent::Kind::kMode, last_fading_ + 1, "force again"});
}

// The force of a tick acts until the next sample.
double RunTrack::work_of_hands(const TickRecord& record) {
  double work_J = 0;
  const Pose now[] = {record.input.pose_w, record.input.second_w};
  for (std::size_t hand = 0; hand < 2; ++hand) {
    const Vec3 turn = small_rotation_vector(now[hand].orientation * conjugate(handle_w_[hand].orientation));
    if (!ticks_.empty())
      work_J -= dot(felt_w_[hand].force_N, now[hand].position_m - handle_w_[hand].position_m) +
                dot(felt_w_[hand].torque_Nm, turn);
    handle_w_[hand] = now[hand];
  }
  felt_w_[0] = record.output.device_w;
  felt_w_[1] = record.output.second_w;
  return work_J;
}

void RunTrack::append(const TickRecord& record) {
  const std::lock_guard lock(mutex_);
  if (ticks_.size() >= kMostTicks) return;
  TrackTick tick = track_tick(record);
  if (const double work_J = work_of_hands(record); std::isfinite(work_J)) given_J_ += work_J;
  tick.given_J = given_J_;
  const std::uint64_t missing =
      ticks_.empty() || record.sequence < next_sequence_ ? 0 : record.sequence - next_sequence_;
  next_sequence_ = record.sequence + 1;
  lost_ += missing;
  ticks_.push_back(tick);
  palpate::add(timing_.compute, tick.compute_ns, tick.tick);
  for (std::size_t i = 0; i < kStageCount; ++i) palpate::add(timing_.stage[i], tick.stage_ns[i], tick.tick);
  if (missing > 0) note(TrackEvent::Kind::kGap, fmt::format("{} ticks are missing", missing));
  find_events(tick);
  // What happens after the force was let go, when the hand falls into the body, sets no scale.
  const bool rendering = tick.mode == Mode::kForce;
  if (rendering) largest_region_N_ = std::max(largest_region_N_, tick.largest_region_N);
  if (const double force = rendering ? norm(tick.contact_N) : -0.5; force > strongest_N_) {
    strongest_N_ = force;
    strongest_ = ticks_.size() - 1;
  }
}

std::size_t RunTrack::size() const {
  const std::lock_guard lock(mutex_);
  return ticks_.size();
}

TrackTick RunTrack::at(std::size_t index) const {
  const std::lock_guard lock(mutex_);
  return index < ticks_.size() ? ticks_[index] : TrackTick{};
}

double RunTrack::time_s(std::size_t index) const {
  const std::lock_guard lock(mutex_);
  if (ticks_.empty()) return 0;
  return period_s_ * static_cast<double>(ticks_[std::min(index, ticks_.size() - 1)].tick);
}

std::size_t RunTrack::index_at(double time_s) const {
  const std::lock_guard lock(mutex_);
  const double wanted = std::floor(time_s / period_s_ + 1e-6);
  const auto later = std::ranges::upper_bound(ticks_, wanted, {}, [](const TrackTick& t) { return double(t.tick); });
  return later == ticks_.begin() ? 0 : static_cast<std::size_t>(later - ticks_.begin()) - 1;
}

std::vector<Input> RunTrack::inputs(std::size_t first, std::size_t most) const {
  const std::lock_guard lock(mutex_);
  std::vector<Input> inputs;
  for (std::size_t i = first; i < std::min(ticks_.size(), first + most); ++i) inputs.push_back(ticks_[i].input);
  return inputs;
}

TrackColumns RunTrack::columns(double from_s, double until_s, std::size_t number) const {
  const std::lock_guard lock(mutex_);
  TrackColumns columns;
  columns.each([&](std::vector<TrackColumns::Range>& line) { line.resize(number); });
  columns.regions.resize(number);
  const double column_s = (until_s - from_s) / static_cast<double>(number);
  const auto start =
      std::ranges::lower_bound(ticks_, from_s / period_s_, {}, [](const TrackTick& t) { return double(t.tick); });
  auto tick = start;
  for (std::size_t c = 0; c < number; ++c) {
    const double end = (from_s + column_s * static_cast<double>(c + 1)) / period_s_;
    bool first = true;
    if (c > 0) {
      columns.each([c](std::vector<TrackColumns::Range>& line) { line[c] = line[c - 1]; });
      columns.regions[c] = columns.regions[c - 1];
    }
    for (; tick != ticks_.end() && static_cast<double>(tick->tick) < end; ++tick, first = false) {
      const auto take = [first, c](std::vector<TrackColumns::Range>& line, double value) {
        const auto v = static_cast<float>(value);
        line[c] = first ? TrackColumns::Range{v, v}
                        : TrackColumns::Range{std::min(line[c].low, v), std::max(line[c].high, v)};
      };
      take(columns.contact_N, norm(tick->contact_N));
      take(columns.felt_N, norm(tick->device_N));
      take(columns.depth_mm, 1e3 * std::max(0.0, tick->depth_m));
      take(columns.stored_mJ, 1e3 * tick->energy_J);
      take(columns.given_mJ, 1e3 * tick->given_J);
      take(columns.surplus_mJ, 1e3 * tick->surplus_J);
      take(columns.compute_us, 1e-3 * tick->compute_ns);
      for (std::size_t i = 0; i < kStageCount; ++i) take(columns.stage_us[i], 1e-3 * tick->stage_ns[i]);
      columns.regions[c] = first ? tick->regions : std::max(columns.regions[c], tick->regions);
    }
  }
  return columns;
}

TrackTiming RunTrack::timing() const {
  const std::lock_guard lock(mutex_);
  return timing_;
}

std::vector<TrackEvent> RunTrack::events() const {
  const std::lock_guard lock(mutex_);
  return events_;
}

std::size_t RunTrack::event_count() const {
  const std::lock_guard lock(mutex_);
  return events_.size();
}

double RunTrack::largest_region_N() const {
  const std::lock_guard lock(mutex_);
  return largest_region_N_;
}

std::size_t RunTrack::strongest() const {
  const std::lock_guard lock(mutex_);
  return strongest_;
}

std::uint64_t RunTrack::lost() const {
  const std::lock_guard lock(mutex_);
  return lost_;
}

TrackStates::TrackStates(const Model& model, const RunTrack& track, StatePtr initial)
    : model_(model), track_(track), state_(std::move(initial)), scratch_(make_scratch(model)) {
  checkpoints_[0] = copy_of(*state_);
}

// Where they grow too many, every second one goes and the rest stand twice as far apart.
void TrackStates::keep_checkpoint() {
  if (next_ % spacing_ != 0 || checkpoints_.contains(next_)) return;
  checkpoints_[next_] = copy_of(*state_);
  if (checkpoints_.size() * state_->bytes <= kMostCheckpointBytes) return;
  spacing_ *= 2;
  std::erase_if(checkpoints_, [this](const auto& entry) { return entry.first % spacing_ != 0; });
}

const State& TrackStates::go_to(std::size_t index, std::size_t budget) {
  const std::size_t size = track_.size();
  if (size == 0) return *state_;
  const std::size_t wanted = std::min(index, size - 1) + 1;  // the tick the state is to stand before
  const auto nearest = std::prev(checkpoints_.upper_bound(wanted));
  if (wanted < next_ || nearest->first > next_) {
    copy_state(*nearest->second, *state_);
    next_ = nearest->first;
  }
  while (next_ < wanted && budget > 0) {
    const std::vector<Input> inputs = track_.inputs(next_, std::min({budget, wanted - next_, std::size_t{256}}));
    for (const Input& input : inputs) {
      keep_checkpoint();
      tick(model_, *state_, *scratch_, input, output_);
      ++next_;
    }
    budget -= inputs.size();
  }
  return *state_;
}

}  // namespace palpate
