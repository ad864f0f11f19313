// The worst ticks of a run, each kept whole: its record says where the time went, what came in and what went out.
#pragma once

#include <cstdint>
#include <string>

#include "rt_core/limits.h"
#include "rt_core/record.h"

namespace palpate {

// Time from the planned wake-up to the end of a tick's work, ns: wake-up latency, receive, compute, transmit and
// publish. This is what must stay below the period.
inline std::int64_t busy_ns(const TickTiming& timing) PALPATE_RT {
  return std::int64_t{timing.wake_latency_ns} + timing.receive_ns + timing.compute_ns + timing.transmit_ns +
         timing.publish_ns;
}

// The kWorstTicksKept ticks with the largest busy time, the worst first; of equals the earlier. Plain data.
struct WorstTicks {
  std::int32_t count = 0;
  TickRecord record[kWorstTicksKept];
};

// Constant memory; at most kWorstTicksKept records move.
inline void add(WorstTicks& worst, const TickRecord& record) PALPATE_RT {
  const std::int64_t busy = busy_ns(record.timing);
  std::int32_t at = worst.count;
  if (at == kWorstTicksKept) {
    at = kWorstTicksKept - 1;
    if (busy <= busy_ns(worst.record[at].timing)) return;
  } else {
    worst.count += 1;
  }
  for (; at > 0 && busy_ns(worst.record[at - 1].timing) < busy; --at) worst.record[at] = worst.record[at - 1];
  worst.record[at] = record;
}

// Table of the first `number` of them, times in µs, with the stage of compute that took longest. Empty for none.
std::string worst_ticks_text(const WorstTicks& worst, int number);

}  // namespace palpate
