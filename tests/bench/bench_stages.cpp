// Time per stage on this machine: the scripted hand plays each baked scene, a time stamp is taken after every stage,
// and median, 99.9th percentile and maximum are reported in nanoseconds. A mean says nothing about a deadline and is
// not printed for judgement; the figures belong to the machine named above them. Each includes one clock read, reported
// as "clock". Usage: bench_stages IMAGE... [Google Benchmark options]
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "rt_core/tick.h"
#include "sim_host/tick_memory.h"
#include "tests/support/image_file.h"
#include "tests/support/scripted_hand.h"

namespace palpate::test {
namespace {

constexpr int kRuns = 5;  // of the whole script: 40,000 ticks
#define PALPATE_STAGE(name, function, shown, what) shown,
constexpr const char* kStageNames[kStageCount] = {PALPATE_STAGES(PALPATE_STAGE)};
#undef PALPATE_STAGE

double now_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) * 1e9 + static_cast<double>(t.tv_nsec);
}

struct Stamps {
  double at_ns[kStageCount] = {};
};
// The probe's type promises not to block, and reading the monotonic clock through the vDSO does not.
#if defined(__clang__)
#pragma clang diagnostic ignored "-Wfunction-effects"
#endif
void stamp(void* context, Stage stage) PALPATE_RT {
  static_cast<Stamps*>(context)->at_ns[static_cast<int>(stage)] = now_ns();
}

// Samples of every stage and, last, of the whole tick.
struct SceneTimes {
  std::vector<double> ns[kStageCount + 1];
};

SceneTimes measure(const Model& model) {
  SceneTimes times;
  for (auto& samples : times.ns) samples.reserve(static_cast<std::size_t>(kRuns) * kScriptTicks);
  const auto state = make_state(model);
  const auto scratch = make_scratch(model);
  Stamps stamps;
  const StageProbe probe{stamp, &stamps};
  for (int run = 0; run < kRuns; ++run) {
    reset(*state);
    Output output;
    ScriptedHand hand(model);
    for (int i = 0; i < kScriptTicks; ++i) {
      const Input input = hand.next(output);
      const double start_ns = now_ns();
      tick(model, *state, *scratch, input, output, probe);
      double from_ns = start_ns;
      for (int s = 0; s < kStageCount; ++s) {
        times.ns[s].push_back(stamps.at_ns[s] - from_ns);
        from_ns = stamps.at_ns[s];
      }
      times.ns[kStageCount].push_back(from_ns - start_ns);
    }
  }
  for (auto& samples : times.ns) std::sort(samples.begin(), samples.end());
  return times;
}

SceneTimes measure_clock() {
  SceneTimes times;
  for (int i = 0; i < kRuns * kScriptTicks; ++i) {
    const double from_ns = now_ns();
    times.ns[0].push_back(now_ns() - from_ns);
  }
  std::sort(times.ns[0].begin(), times.ns[0].end());
  return times;
}

void report(benchmark::State& state, const std::vector<double>& sorted_ns) {
  const auto at = [&](double fraction) {
    return sorted_ns[static_cast<std::size_t>(fraction * static_cast<double>(sorted_ns.size() - 1))];
  };
  for ([[maybe_unused]] auto _ : state) state.SetIterationTime(at(0.5) * 1e-9);
  state.counters["p50_ns"] = at(0.5);
  state.counters["p99.9_ns"] = at(0.999);
  state.counters["max_ns"] = sorted_ns.back();
}

void add(const std::string& name, std::shared_ptr<SceneTimes> times, int index) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [times, index](benchmark::State& state) { report(state, times->ns[index]); })
      ->Iterations(1)
      ->UseManualTime();
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace
}  // namespace palpate::test

int main(int argc, char** argv) {
  using namespace palpate::test;
  benchmark::Initialize(&argc, argv);
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_stages IMAGE... [Google Benchmark options]\n");
    return 2;
  }
  benchmark::AddCustomContext("machine", processor_name());
  try {
    add("clock", std::make_shared<SceneTimes>(measure_clock()), 0);
    for (int i = 1; i < argc; ++i) {
      const ImageFile image(argv[i]);
      const auto times = std::make_shared<SceneTimes>(measure(image.model()));
      for (int s = 0; s < palpate::kStageCount; ++s)
        add(std::string(image.model().name) + "/" + kStageNames[s], times, s);
      add(std::string(image.model().name) + "/tick", times, palpate::kStageCount);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_stages: %s\n", error.what());
    return 2;
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
