// Fixed-memory log-linear histogram of durations: every value below 128 ns has its own bucket, above that each octave
// is split into 64, so a bucket is never wider than 1/64 (1.6 %) of its value. Plain data: the real-time loop may own
// one.
#pragma once

#include <cstdint>
#include <type_traits>

#include "rt_core/base.h"

namespace palpate {

inline constexpr int kHistogramSubBits = 6;  // 64 buckets per octave
inline constexpr std::int32_t kHistogramExact = 2 << kHistogramSubBits;
inline constexpr int kHistogramOctaves = 24;  // 2^7 .. 2^31 ns = 2.1 s; longer goes to `overflow`
inline constexpr std::int32_t kHistogramBuckets = kHistogramExact + (kHistogramOctaves << kHistogramSubBits);

struct Histogram {
  std::uint32_t count[kHistogramBuckets] = {};
  std::uint64_t total = 0;         // all values, overflow included
  std::uint64_t overflow = 0;      // values beyond the last bucket
  std::uint64_t cycle_of_max = 0;  // when the largest value came (its first occurrence)
  std::int64_t min_ns = 0;         // exact; 0 while empty
  std::int64_t max_ns = 0;
  std::int64_t sum_ns = 0;
};

static_assert(std::is_trivially_copyable_v<Histogram>);

// Bucket of a value >= 0; kHistogramBuckets when it is beyond the last one.
inline std::int32_t bucket_of(std::int64_t value_ns) PALPATE_RT {
  if (value_ns < kHistogramExact) return value_ns > 0 ? static_cast<std::int32_t>(value_ns) : 0;
  const int octave = 63 - __builtin_clzll(static_cast<unsigned long long>(value_ns));  // >= 7
  if (octave >= kHistogramSubBits + 1 + kHistogramOctaves) return kHistogramBuckets;
  const std::int64_t sub = (value_ns >> (octave - kHistogramSubBits)) - (1 << kHistogramSubBits);
  return kHistogramExact + ((octave - kHistogramSubBits - 1) << kHistogramSubBits) + static_cast<std::int32_t>(sub);
}

// Smallest value of a bucket; `bucket` = kHistogramBuckets gives the first value that overflows.
inline std::int64_t bucket_start_ns(std::int32_t bucket) PALPATE_RT {
  if (bucket < kHistogramExact) return bucket;
  const std::int32_t k = bucket - kHistogramExact;
  const int octave = (k >> kHistogramSubBits) + kHistogramSubBits + 1;
  const std::int64_t sub = (k & ((1 << kHistogramSubBits) - 1)) + (1 << kHistogramSubBits);
  return sub << (octave - kHistogramSubBits);
}

// Adds one value (negative counts as 0, as a clock read twice may give). Constant time, no branch on history length.
inline void add(Histogram& histogram, std::int64_t value_ns, std::uint64_t cycle) PALPATE_RT {
  const std::int64_t value = value_ns > 0 ? value_ns : 0;
  const std::int32_t bucket = bucket_of(value);
  if (bucket < kHistogramBuckets) {
    histogram.count[bucket] += 1;
  } else {
    histogram.overflow += 1;
  }
  if (histogram.total == 0 || value < histogram.min_ns) histogram.min_ns = value;
  if (histogram.total == 0 || value > histogram.max_ns) {
    histogram.max_ns = value;
    histogram.cycle_of_max = cycle;
  }
  histogram.sum_ns += value;
  histogram.total += 1;
}

// Smallest value not below `fraction` (0..1) of all values, within one bucket width: the upper edge of its bucket, kept
// within [min, max]. 0 for an empty histogram. Nearest-rank definition: rank = ceil(fraction * total), at least 1.
std::int64_t percentile_ns(const Histogram& histogram, double fraction);

}  // namespace palpate
