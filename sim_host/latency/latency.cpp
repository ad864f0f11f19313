#include "sim_host/latency/latency.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <thread>

#include "hal/loop/clock.h"
#include "hal/system/rt_linux.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_reader.h"
#include "sim_host/status_text.h"

namespace palpate {

namespace {

double us(std::int64_t ns) { return 1e-3 * static_cast<double>(ns); }

void add_wake(LatencyData& data, std::int64_t late_ns, std::uint64_t tick) {
  add(data.wake, late_ns);
  add(data.summary.wake, late_ns, tick);
}

void row(std::string& text, const char* name, const Histogram& h) {
  if (h.total == 0 || h.max_ns == 0) return;
  fmt::format_to(std::back_inserter(text), "  {:<16}{:>10.1f}{:>10.1f}{:>10.1f}{:>10}\n", name,
                 us(percentile_ns(h, 0.5)), us(percentile_ns(h, 0.999)), us(h.max_ns), h.cycle_of_max);
}

// The part of the worst tick that took longest, in words.
std::string worst_part(const TickTiming& t) {
  struct Part {
    std::int64_t ns;
    const char* name;
  };
  const Part parts[] = {{t.wake_latency_ns, "waking up (scheduler or interrupts: see palpate doctor)"},
                        {t.receive_ns, "receiving from the device"},
                        {t.compute_ns, "computing"},
                        {t.transmit_ns, "sending to the device"},
                        {t.publish_ns, "publishing telemetry"}};
  const Part& worst =
      *std::max_element(std::begin(parts), std::end(parts), [](const Part& a, const Part& b) { return a.ns < b.ns; });
  return fmt::format("{:.0f} µs of it {}", us(worst.ns), worst.name);
}

std::string verdict(const LatencyData& data) {
  const Histogram& h = data.bare_loop ? data.summary.wake : data.summary.busy;
  const double share = 100.0 * static_cast<double>(h.max_ns) / static_cast<double>(data.period_ns);
  const char* what = data.bare_loop ? "latest wake-up" : "longest tick (wake-up included)";
  std::string text;
  if (data.summary.missed_ticks > 0) {
    text = fmt::format("BAD: {} deadlines missed in {} ticks", data.summary.missed_ticks, data.summary.ticks);
  } else if (share >= 50) {
    text = fmt::format("TIGHT: no deadline missed, but the {} used {:.0f} % of the period", what, share);
  } else {
    text = fmt::format("GOOD: no deadline missed; the {} used {:.1f} % of the period", what, share);
  }
  text += ".\n";
  if (!data.bare_loop) {
    text += fmt::format("Longest tick: number {}, {:.0f} µs, {}.\n", data.summary.busy.cycle_of_max,
                        us(data.summary.busy.max_ns), worst_part(data.summary.worst.record[0].timing));
    if (data.summary.compute.total > 0 && data.summary.busy.sum_ns > 0) {
      text += fmt::format(
          "On average {:.0f} % of a tick's time is waiting to wake up, {:.0f} % computing.\n",
          100.0 * static_cast<double>(data.summary.wake.sum_ns) / static_cast<double>(data.summary.busy.sum_ns),
          100.0 * static_cast<double>(data.summary.compute.sum_ns) / static_cast<double>(data.summary.busy.sum_ns));
    }
  }
  if (data.summary.missed_ticks > 0 || share >= 50) {
    text += "To improve it: run `palpate doctor`; use a PREEMPT_RT kernel, an isolated CPU (--cpu) and priority 80.\n";
  }
  return text + "A run without load proves little: repeat under the load you expect, for hours.\n";
}

}  // namespace

void add(LatencyData& data, const TickRecord& record) {
  add(data.summary, record);
  add(data.wake, record.timing.wake_latency_ns);
}

LatencyData latency_of_recording(const std::string& path) {
  const MappedFile file(path);
  RecordingReader recording(file.bytes());
  LatencyData data;
  data.period_ns = recording.header().period_ns;
  TickRecord record;
  while (recording.next(record)) add(data, record);
  data.damage = recording.error();
  if (data.damage.empty() && recording.lost() > 0)
    data.damage = fmt::format("{} records are missing", recording.lost());
  return data;
}

LatencyData measure_wake_up(const MeasureOptions& options, std::string& verdicts) {
  const std::atomic<bool>& stop = install_stop_signals();
  auto data = std::make_unique<LatencyData>();
  data->bare_loop = true;
  data->period_ns = options.period_ns;
  const auto ticks = static_cast<std::uint64_t>(options.duration_s * 1e9 / static_cast<double>(options.period_ns));
  std::thread loop([&] {
    RtOptions rt;
    rt.priority = options.priority;
    rt.cpu = options.cpu;
    const RtSetup setup(rt);
    verdicts = setup.text();
    MonotonicClock clock;
    std::int64_t deadline_ns = clock.now_ns() + options.period_ns;
    for (std::uint64_t tick = 0; tick < ticks && !stop.load(std::memory_order_relaxed); ++tick) {
      clock.wait_until(deadline_ns);
      const std::int64_t late_ns = clock.now_ns() - deadline_ns;
      add_wake(*data, late_ns, tick);
      const std::int64_t missed =
          late_ns / options.period_ns;  // whole slots that passed: skipped, as the controller does
      data->summary.missed_ticks += static_cast<std::uint64_t>(missed);
      deadline_ns += (missed + 1) * options.period_ns;
      ++data->summary.ticks;
    }
  });
  loop.join();
  return *data;
}

std::string latency_text(const LatencyData& data, int worst) {
  std::string text = fmt::format("{} ticks of {:.0f} µs\n  {:<16}{:>10}{:>10}{:>10}{:>10}\n", data.summary.ticks,
                                 us(data.period_ns), "µs", "   median", "99.9 %", "max", "at tick");
  const RunSummary& s = data.summary;
  row(text, "wake-up", s.wake);
  if (!data.bare_loop) {
    row(text, "receive", s.receive);
    row(text, "compute", s.compute);
    for (int i = 0; i < kStageCount; ++i) {
      row(text, fmt::format("  {}", stage_name(static_cast<Stage>(i))).c_str(), s.stage[i]);
    }
    row(text, "transmit", s.transmit);
    row(text, "deadline to sent", s.sent);
    row(text, "publish", s.publish);
    row(text, "whole tick", s.busy);
    text += worst_ticks_text(s.worst, worst);
  }
  if (!data.damage.empty()) text += "note: the recording is incomplete: " + data.damage + '\n';
  return text + (data.summary.ticks > 0 ? verdict(data) : "No ticks to judge.\n");
}

Drawing latency_drawing(const LatencyData& data, const std::string& title, std::span<const LatencySeries> overlay) {
  const RunSummary& s = data.summary;
  std::vector<LatencySeries> series{{"wake-up latency", &s.wake}};
  series.insert(series.end(), overlay.begin(), overlay.end());
  if (!data.bare_loop) {
    series.insert(series.end(), {{"receive from device", &s.receive},
                                 {"compute (tick)", &s.compute},
                                 {"transmit to device", &s.transmit},
                                 {"whole tick, wake-up included", &s.busy}});
  }
  return latency_plot(series, title);
}

}  // namespace palpate
