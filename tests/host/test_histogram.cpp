// The log-linear histogram against exact sorting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "sim_host/latency/histogram.h"

namespace palpate {
namespace {

TEST(Histogram, BucketsTileTheRangeWithoutGapOrOverlap) {
  for (std::int32_t bucket = 0; bucket < kHistogramBuckets; ++bucket) {
    EXPECT_EQ(bucket_of(bucket_start_ns(bucket)), bucket);
    EXPECT_EQ(bucket_of(bucket_start_ns(bucket + 1) - 1), bucket);
    // Width at most 1/64 of the value, and 1 ns where that would be less.
    EXPECT_LE(bucket_start_ns(bucket + 1) - bucket_start_ns(bucket),
              std::max<std::int64_t>(1, bucket_start_ns(bucket) / 64));
  }
  EXPECT_EQ(bucket_of(bucket_start_ns(kHistogramBuckets)), kHistogramBuckets);
  EXPECT_EQ(bucket_start_ns(kHistogramBuckets), std::int64_t{1} << 31);
}

TEST(Histogram, PercentilesAgreeWithSorting) {
  std::mt19937_64 random(20261121);
  std::lognormal_distribution<double> spread(std::log(12000.0), 0.8);
  for (const std::size_t n : {1u, 2u, 7u, 1000u, 20000u}) {
    auto histogram = std::make_unique<Histogram>();
    std::vector<std::int64_t> values;
    for (std::size_t i = 0; i < n; ++i) {
      values.push_back(static_cast<std::int64_t>(spread(random)));
      add(*histogram, values.back(), i);
    }
    const auto largest = std::max_element(values.begin(), values.end());
    EXPECT_EQ(histogram->cycle_of_max, static_cast<std::uint64_t>(largest - values.begin()));
    std::vector<std::int64_t> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(histogram->total, n);
    EXPECT_EQ(histogram->min_ns, sorted.front());
    EXPECT_EQ(histogram->max_ns, sorted.back());
    std::int64_t sum = 0;
    for (const std::int64_t v : sorted) sum += v;
    EXPECT_EQ(histogram->sum_ns, sum);
    for (const double fraction : {0.0, 0.01, 0.5, 0.9, 0.99, 0.999, 1.0}) {
      const auto rank =
          std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(n))));
      const std::int64_t exact = sorted[rank - 1];
      const std::int64_t got = percentile_ns(*histogram, fraction);
      EXPECT_GE(got, exact) << fraction;
      EXPECT_LE(got, exact + exact / 64 + 1) << fraction;  // one bucket
    }
  }
}

TEST(Histogram, CountsWhatItCannotHold) {
  auto histogram = std::make_unique<Histogram>();
  add(*histogram, -5, 1);  // a clock read twice may run backwards by a rounding
  add(*histogram, 10, 2);
  add(*histogram, std::int64_t{1} << 31, 3);
  add(*histogram, std::int64_t{1} << 40, 4);
  EXPECT_EQ(histogram->total, 4u);
  EXPECT_EQ(histogram->overflow, 2u);
  EXPECT_EQ(histogram->min_ns, 0);
  EXPECT_EQ(histogram->max_ns, std::int64_t{1} << 40);
  EXPECT_EQ(histogram->cycle_of_max, 4u);
  EXPECT_EQ(percentile_ns(*histogram, 0.99), std::int64_t{1} << 40);
  EXPECT_EQ(percentile_ns(*std::make_unique<Histogram>(), 0.5), 0);
}

}  // namespace
}  // namespace palpate
