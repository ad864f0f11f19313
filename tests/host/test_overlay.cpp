// Cyclictest's histogram text as it comes (rt-tests 2.4, Debian 12), its damage, and the plot with both.
#include <gtest/gtest.h>

#include <memory>

#include "sim_host/latency/cyclictest_read.h"
#include "sim_host/latency/latency.h"
#include "tests/host/xml_check.h"
#include "tests/support/refusal.h"

namespace palpate {
namespace {

// Output of `cyclictest -D 1 -i 1000 -h 6 -q -t 2`, shortened in the list of overflows.
constexpr char kTwoThreads[] =
    "# /dev/cpu_dma_latency set to 0us\n"
    "# Histogram\n"
    "000000 000000\t000000\n"
    "000001 000000\t000000\n"
    "000002 000010\t000001\n"
    "000003 000900\t000800\n"
    "000004 000080\t000150\n"
    "000005 000009\t000040\n"
    "# Total: 000000999 000000991\n"
    "# Min Latencies: 00002 00002\n"
    "# Avg Latencies: 00003 00003\n"
    "# Max Latencies: 00148 00076\n"
    "# Histogram Overflows: 00001 00002\n"
    "# Histogram Overflow at cycle number:\n"
    "# Thread 0: 00512\n"
    "# Thread 1: 00100 00200\n\n";

std::string error_of(const std::string& text) {
  return test::refusal_by<std::runtime_error>([&] { parse_cyclictest(text, "c.txt"); });
}
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(Overlay, ReadsBothThreadsTogether) {
  const CyclictestHistogram read = parse_cyclictest(kTwoThreads, "c.txt");
  EXPECT_EQ(read.threads, 2);
  EXPECT_EQ(read.latency.total, 999u + 991u + 3u);
  EXPECT_EQ(read.latency.overflow, 3u);
  EXPECT_EQ(read.latency.min_ns, 2000);
  EXPECT_EQ(read.latency.max_ns, 148'000);
  EXPECT_EQ(read.latency.count[bucket_of(3000)], 1700u);
  EXPECT_EQ(bucket_start_ns(bucket_of(percentile_ns(read.latency, 0.5))), bucket_start_ns(bucket_of(3000)));
  EXPECT_EQ(percentile_ns(read.latency, 1.0), 148'000);
}

TEST(Overlay, ReadsWhatWeWriteOurselves) {
  MicrosecondHistogram thread;
  for (const std::int64_t ns : {8'999, 9'000, 37'000, 2'500'000}) add(thread, ns);
  const CyclictestHistogram read = parse_cyclictest(cyclictest_text({thread}), "own");
  EXPECT_EQ(read.threads, 1);
  EXPECT_EQ(read.latency.total, 4u);
  EXPECT_EQ(read.latency.overflow, 1u);
  EXPECT_EQ(read.latency.max_ns, 2'500'000);
}

TEST(Overlay, EveryDamageIsNamedWithItsLine) {
  EXPECT_NE(error_of("hello\n").find("no line '# Histogram'"), std::string::npos);
  EXPECT_NE(error_of("").find("c.txt:0"), std::string::npos);
  EXPECT_NE(error_of("# Histogram\n").find("no rows"), std::string::npos);
  const std::string whole = kTwoThreads;
  EXPECT_NE(error_of(with(whole, "000003 000900\t000800", "000003 000900")).find("c.txt:6: expected 3 columns"),
            std::string::npos);
  EXPECT_NE(error_of(with(whole, "000003 000900", "000003 9x0")).find("c.txt:6: expected 'microseconds"),
            std::string::npos);
  EXPECT_NE(error_of(with(whole, "000003 000900\t000800\n", "")).find("c.txt:6: expected the row of 3"),
            std::string::npos);
  EXPECT_NE(error_of(with(whole, "000900", "000901")).find("thread 0: the rows add up to 1000, its total is 999"),
            std::string::npos);
  EXPECT_NE(error_of(whole.substr(0, whole.find("# Total"))).find("cut off"), std::string::npos);
  EXPECT_NE(error_of(with(whole, "00148 00076", "00148")).find("one number per thread"), std::string::npos);
  EXPECT_NE(error_of(with(whole, "000900", "-00900")).find("c.txt:6"), std::string::npos);
  EXPECT_THROW(read_cyclictest("/nonexistent.txt"), std::runtime_error);
}

TEST(Overlay, IsDrawnBesideOurOwnWakeUps) {
  auto data = std::make_unique<LatencyData>();
  TickRecord record{};
  record.timing.wake_latency_ns = 5'000;
  for (int i = 0; i < 100; ++i) add(*data, record);
  const CyclictestHistogram other = parse_cyclictest(kTwoThreads, "c.txt");
  const LatencySeries overlay[] = {{"cyclictest (2 threads)", &other.latency}};
  const std::string svg = latency_drawing(*data, "both", overlay).svg();
  EXPECT_EQ(test::xml_error(svg), "");
  EXPECT_NE(svg.find("cyclictest (2 threads)"), std::string::npos);
  EXPECT_NE(svg.find("max 148"), std::string::npos);
  EXPECT_NE(svg.find("wake-up latency"), std::string::npos);
}

}  // namespace
}  // namespace palpate
