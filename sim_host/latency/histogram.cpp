#include "sim_host/latency/histogram.h"

#include <algorithm>
#include <cmath>

namespace palpate {

std::int64_t percentile_ns(const Histogram& histogram, double fraction) {
  if (histogram.total == 0) return 0;
  const double wanted = std::ceil(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(histogram.total));
  const std::uint64_t rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted));
  std::uint64_t seen = 0;
  for (std::int32_t bucket = 0; bucket < kHistogramBuckets; ++bucket) {
    seen += histogram.count[bucket];
    if (seen >= rank) return std::clamp(bucket_start_ns(bucket + 1) - 1, histogram.min_ns, histogram.max_ns);
  }
  return histogram.max_ns;  // the rank lies among the overflows
}

}  // namespace palpate
