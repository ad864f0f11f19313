#include "sim_host/run/run_json.h"

#include <fmt/format.h>

#include "sim_host/status_text.h"

namespace palpate {

namespace {

double us(std::int64_t ns) { return 1e-3 * static_cast<double>(ns); }

Json stage_json(const Histogram& h) {
  return {{"count", h.total},       {"p50_us", us(percentile_ns(h, 0.5))}, {"p99_9_us", us(percentile_ns(h, 0.999))},
          {"max_us", us(h.max_ns)}, {"tick_of_max", h.cycle_of_max},       {"overflows", h.overflow}};
}

}  // namespace

Json stages_json(const RunSummary& s) {
  Json stages = Json::object();
  stages["wake_up"] = stage_json(s.wake);
  stages["receive"] = stage_json(s.receive);
  stages["compute"] = stage_json(s.compute);
  for (int i = 0; i < kStageCount; ++i) {
    stages[fmt::format("compute.{}", stage_name(static_cast<Stage>(i)))] = stage_json(s.stage[i]);
  }
  stages["transmit"] = stage_json(s.transmit);
  stages["deadline_to_sent"] = stage_json(s.sent);
  stages["publish"] = stage_json(s.publish);
  stages["whole_tick"] = stage_json(s.busy);
  return stages;
}

Json worst_json(const WorstTicks& worst) {
  Json ticks = Json::array();
  for (std::int32_t i = 0; i < worst.count; ++i) {
    const TickTiming& t = worst.record[i].timing;
    ticks.push_back({{"tick", worst.record[i].tick},
                     {"whole_us", us(busy_ns(t))},
                     {"wake_up_us", us(t.wake_latency_ns)},
                     {"receive_us", us(t.receive_ns)},
                     {"compute_us", us(t.compute_ns)},
                     {"transmit_us", us(t.transmit_ns)},
                     {"publish_us", us(t.publish_ns)},
                     {"missed_before", worst.record[i].input.overrun_ticks}});
  }
  return ticks;
}

Json verdicts_json(const std::vector<RunVerdict>& verdicts) {
  Json all = Json::array();
  for (const RunVerdict& verdict : verdicts)
    all.push_back({{"name", verdict.name},
                   {"ok", verdict.ok()},
                   {"share", verdict.share},
                   {verdict.at_least ? "at_least" : "at_most", verdict.limit},
                   {"meaning", verdict.meaning}});
  return all;
}

Json bit_json(const BitText& bit) { return {{"name", bit.name}, {"meaning", bit.meaning}, {"remedy", bit.remedy}}; }

Json faults_json(std::uint32_t fault) {
  Json faults = Json::array();
  for (const BitText& bit : fault_bit_texts())
    if ((fault >> bit.bit & 1u) != 0) faults.push_back(bit_json(bit));
  return faults;
}

Json summary_json(const RunSummary& s, std::uint64_t lost_records) {
  Json status = Json::array();
  for (const BitText& bit : status_bit_texts()) {
    if (s.status_ticks[bit.bit] == 0) continue;
    status.push_back(bit_json(bit));
    status.back()["ticks"] = s.status_ticks[bit.bit];
  }
  Json json = {{"ticks", s.ticks},
               {"rate_Hz", rate_Hz(s)},
               {"missed_ticks", s.missed_ticks},
               {"stale_ticks", s.stale_ticks},
               {"armed_ticks", s.armed_ticks},
               {"lost_records", lost_records},
               {"device_force_max_N", s.device_force_max_N},
               {"contact_force_max_N", s.contact_force_max_N},
               {"depth_max_m", s.penetration_max_m},
               {"regions_max", s.regions_max},
               {"stalls", s.stalls},
               {"longest_gap_ms", 1e-6 * static_cast<double>(s.longest_gap_ns)},
               {"status", status},
               {"faults", faults_json(s.fault)}};
  if ((s.fault & Fault::kSamplesSparse) != 0) {
    json["samples_Hz"] = samples_Hz(s);
    json["felt_share"] = felt_share(s);
  }
  if (s.ticks == 0 || is_virtual(s)) return json;
  json["stages"] = stages_json(s);
  json["worst_ticks"] = worst_json(s.worst);
  return json;
}

}  // namespace palpate
