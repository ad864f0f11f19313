// Two runs against one another, and scripts of a viewer, without a screen.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim_host/view/comparison.h"
#include "sim_host/view/opened_recording.h"
#include "sim_host/view/view_script.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

// It refuses, and says all of that.
template <class Call>
void expect_error(const Call& call, std::initializer_list<std::string> words) {
  const std::string said = test::refusal_by<std::runtime_error>(call);
  for (const std::string& word : words) EXPECT_NE(said.find(word), std::string::npos) << said << "\n  without " << word;
}

// Ticks of a run whose force rises in a straight line after a touch.
struct Ramp {
  double period_s = 1e-3;
  double touch_s = 0.1, until_s = 1;
  double N_per_s = 10;
  double starts_s = 0;
};
std::unique_ptr<RunTrack> track_of(const Ramp& ramp) {
  auto track = std::make_unique<RunTrack>(ramp.period_s);
  const auto tick_at = [&](double time_s) { return static_cast<std::uint64_t>(std::llround(time_s / ramp.period_s)); };
  for (std::uint64_t tick = tick_at(ramp.starts_s); tick <= tick_at(ramp.until_s); ++tick) {
    TickRecord record{};
    record.sequence = record.tick = tick;
    record.output.mode = Mode::kForce;
    const double since_s = ramp.period_s * static_cast<double>(tick) - ramp.touch_s;
    // The tick of the touch itself counts, whatever rounding says.
    if (since_s > -1e-9) {
      record.output.regions = 1;
      record.output.contact_w.force_N = {0, ramp.N_per_s * since_s, 0};
      record.output.penetration_m = 1e-3 * since_s;
    }
    track->append(record);
  }
  return track;
}

const std::array<std::string, 2> kNames{"a.plr", "b.plr"};

TEST(Comparison, ARunDoesNotDifferFromItself) {
  const auto a = track_of({}), b = track_of({});
  for (const Alignment alignment : {Alignment::kTime, Alignment::kTouch}) {
    const Comparison both(*a, *b, alignment, kNames);
    EXPECT_EQ(both.difference().largest_N, 0);
    EXPECT_EQ(both.difference().rms_mm, 0);
    EXPECT_EQ(both.difference().ticks, a->size());
  }
}

TEST(Comparison, AlignedByTouchTheSameMotionBegunLaterIsTheSame) {
  const auto a = track_of({}), b = track_of({.touch_s = 0.35, .until_s = 1.25});
  const Comparison by_touch(*a, *b, Alignment::kTouch, kNames);
  EXPECT_NEAR(by_touch.zero_s(0), 0.1, 1e-12);
  EXPECT_NEAR(by_touch.zero_s(1), 0.35, 1e-12);
  // Times are products of ticks and periods: a rounding of them is 1e-15 N.
  EXPECT_LT(by_touch.difference().largest_N, 1e-12);
  EXPECT_NEAR(by_touch.first_s(), -0.35, 1e-12);
  EXPECT_NEAR(by_touch.last_s(), 0.9, 1e-12);
  EXPECT_EQ(a->at(by_touch.index_at(0, 0)).regions, 1);
  EXPECT_EQ(a->at(by_touch.index_at(0, -1e-3)).regions, 0);
  EXPECT_EQ(b->at(by_touch.index_at(1, 0)).regions, 1);
  EXPECT_EQ(b->at(by_touch.index_at(1, -1e-3)).regions, 0);
  // By time they are a quarter of a second apart: 2.5 N from b's touch on.
  const Comparison by_time(*a, *b, Alignment::kTime, kNames);
  EXPECT_NEAR(by_time.difference().largest_N, 2.5, 1e-9);
}

TEST(Comparison, OtherTickPeriodsAreComparedTickForTick) {
  // Of twice the period: each of its ticks has one of the other at the same time.
  const auto a = track_of({}), b = track_of({.period_s = 2e-3, .N_per_s = 13});
  const Comparison both(*a, *b, Alignment::kTime, kNames);
  EXPECT_EQ(both.difference().ticks, b->size());
  // 3 N/s of difference over 0.9 s; its mean square over the run of a ramp is a third of it, times 0.9.
  EXPECT_NEAR(both.difference().largest_N, 2.7, 1e-9);
  EXPECT_NEAR(both.difference().largest_at_s, 1, 1e-9);
  EXPECT_NEAR(both.difference().rms_N, std::sqrt(0.9 * 2.7 * 2.7 / 3), 0.01) << "a sum of 450 steps for an integral";
  const Comparison other_way(*b, *a, Alignment::kTime, kNames);
  EXPECT_DOUBLE_EQ(other_way.difference().rms_N, both.difference().rms_N);
}

TEST(Comparison, WhereARunIsOverItsPlotIsEmptyAndItSaysSo) {
  const auto a = track_of({}), b = track_of({.until_s = 0.5});
  const Comparison both(*a, *b, Alignment::kTime, kNames);
  EXPECT_TRUE(both.is_there(0, 0.9));
  EXPECT_FALSE(both.is_there(1, 0.9));
  EXPECT_TRUE(both.is_there(1, 0.5));
  EXPECT_EQ(both.index_at(1, 0.9), b->size() - 1);
  const TrackColumns columns = both.columns(1, 0, 1, 100);
  EXPECT_FALSE(std::isnan(columns.contact_N[49].high));
  EXPECT_NEAR(static_cast<double>(columns.contact_N[49].high), 4, 0.02);
  EXPECT_TRUE(std::isnan(columns.contact_N[60].high));
  EXPECT_TRUE(std::isnan(columns.depth_mm[99].low));
}

TEST(Comparison, OnlyForceThatIsRenderedCounts) {
  const auto a = track_of({}), b = track_of({.N_per_s = 20});
  RunTrack resting(1e-3);
  for (std::size_t i = 0; i < b->size(); ++i) {
    TickRecord record{};
    record.sequence = record.tick = b->at(i).tick;
    record.output.mode = i < 200 ? Mode::kForce : Mode::kIdle;
    record.output.contact_w.force_N = b->at(i).contact_N;
    resting.append(record);
  }
  const Comparison both(*a, resting, Alignment::kTime, kNames);
  EXPECT_EQ(both.difference().ticks, 200u);
  EXPECT_NEAR(both.difference().largest_N, 0.99, 1e-9) << "at 0.199 s, 10 N/s for 99 ms";
}

TEST(Comparison, WhatCannotBeComparedIsRefusedByName) {
  const auto a = track_of({}), untouched = track_of({.touch_s = 5});
  expect_error([&] { Comparison(*a, *untouched, Alignment::kTouch, kNames); },
               {"b.plr", "never touches", "--align time"});
  const auto later = track_of({.touch_s = 7, .until_s = 8, .starts_s = 6});
  expect_error([&] { Comparison(*a, *later, Alignment::kTime, kNames); },
               {"a.plr is over at 1.000 s", "b.plr begins at 6.000 s", "--align touch"});
  EXPECT_NO_THROW(Comparison(*a, *later, Alignment::kTouch, kNames));
  Model small, large;
  small.params.surface_size_m = 0.05;
  large.params.surface_size_m = 0.7;
  expect_error([&] { check_sizes(small, large, kNames); }, {"a.plr", "b.plr", "50", "700", "10"});
  large.params.surface_size_m = 0.4;
  EXPECT_NO_THROW(check_sizes(small, large, kNames));
}

TEST(OpenedRecording, GarbageIsRefusedByName) {
  const std::string path = std::filesystem::temp_directory_path() / ("palpate_garbage_" + std::to_string(getpid()));
  std::ofstream(path) << "neither a recording nor anything else";
  expect_error([&] { OpenedRecording(path, ""); }, {path});
  std::filesystem::remove(path);
  expect_error([&] { OpenedRecording(path, ""); }, {path, "No such file"});
}

TEST(ViewScript, EveryStepIsRead) {
  const auto steps = parse_view_script(
      "# a press\n"
      "look front\n"
      "  drag 1 -2.5 3 0.5   # from above\n"
      "\n"
      "set stiffness=0.5\n"
      "wait 0.25\nscrub -1\nfollow\nturn 30 -10\nzoom 2\nclose 1\nopen 2\nrelease\nfit\npicture a.png\n"
      "close 1 thumb\nopen 0.5 index_flexion\njoint index_flexion=30\nfree index_flexion\nlist\n"
      "switch . tools/cone_30  name=x\nrefused other.pal",
      "s");
  ASSERT_EQ(steps.size(), 20u);
  EXPECT_EQ(steps[0].view, StandardView::kFront);
  EXPECT_EQ(steps[1].kind, ViewStep::Kind::kDrag);
  EXPECT_DOUBLE_EQ(steps[1].at_m.y, -0.0025);
  EXPECT_DOUBLE_EQ(steps[1].seconds, 0.5);
  EXPECT_EQ(steps[2].setting, &LiveSettings::stiffness);
  EXPECT_FLOAT_EQ(static_cast<float>(steps[2].value), 0.5f);
  EXPECT_DOUBLE_EQ(steps[4].value, -1);
  EXPECT_DOUBLE_EQ(steps[6].up, -10);
  EXPECT_EQ(steps[12].file, "a.png");
  EXPECT_EQ(steps[7].part, "") << "all fingers";
  EXPECT_EQ(steps[13].part, "thumb");
  EXPECT_EQ(steps[14].part, "index_flexion");
  EXPECT_EQ(steps[15].part, "index_flexion=30");
  EXPECT_EQ(steps[16].kind, ViewStep::Kind::kFree);
  EXPECT_EQ(steps[17].kind, ViewStep::Kind::kList);
  EXPECT_EQ(steps[18].words, ". tools/cone_30  name=x");
  EXPECT_EQ(steps[18].where, "s:21");
  EXPECT_EQ(steps[19].kind, ViewStep::Kind::kRefused);
}

TEST(ViewScript, AMistakeIsNamedWithItsLine) {
  const auto error = [](const char* text, std::initializer_list<std::string> words) {
    expect_error([&] { parse_view_script(text, "s.txt"); }, words);
  };
  error("wait 1\njump 3", {"s.txt:2", "jump", "there are", "drag X_mm"});
  error("drag 1 2 3", {"s.txt:1", "the time is missing", "expected: drag X_mm"});
  error("drag 1 2 x 1", {"s.txt:1", "'x'"});
  error("wait nan", {"s.txt:1", "nan"});
  error("wait 1 2", {"s.txt:1", "'2' is too much"});
  error("close 1 thumb index", {"s.txt:1", "'index' is too much", "FINGER | JOINT"});
  error("joint index_flexion", {"s.txt:1", "no value", "JOINT=VALUE"});
  error("free", {"s.txt:1", "the joint is missing"});
  error("switch", {"s.txt:1", "the scene is missing", "IMAGE"});
  error("set stiffness=9", {"s.txt:1", "stiffness", "0.1 to 2"});
  error("set mass=1", {"s.txt:1", "mass", "stiffness"});
  error("look inside", {"s.txt:1", "inside"});
  error("picture a.jpg", {"s.txt:1", "a.jpg", ".png"});
  error("# nothing", {"s.txt", "no steps"});
}

}  // namespace
}  // namespace palpate
