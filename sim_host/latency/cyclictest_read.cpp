#include "sim_host/latency/cyclictest_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace palpate {

namespace {

// The numbers of a line, blank or tab between them; nothing when it holds anything else.
std::optional<std::vector<std::uint64_t>> numbers(const std::string& line) {
  std::istringstream words(line);
  std::vector<std::uint64_t> values;
  for (std::string word; words >> word;) {
    std::uint64_t value = 0;
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (status != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    values.push_back(value);
  }
  return values;
}

class Parser {
 public:
  Parser(const std::string& text, const std::string& name) : lines_(text), name_(name) {}

  CyclictestHistogram parse() {
    std::string line;
    bool found = false;
    while (!found && next(line)) found = line == "# Histogram";
    if (!found) fail("no line '# Histogram': is it the output of `cyclictest -h 400 -q` or its --histfile?");
    while (next(line)) {
      if (line.starts_with("# ")) {
        summary(line);
      } else if (!line.empty()) {
        row(line);
      }
    }
    check();
    return result_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(fmt::format("{}:{}: {}", name_, number_, what));
  }
  bool next(std::string& line) {
    if (!std::getline(lines_, line)) return false;
    number_ += 1;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    return true;
  }

  void row(const std::string& line) {
    const auto values = numbers(line);
    if (!values || values->size() < 2) fail("expected 'microseconds count...', found '" + line + "'");
    if (counted_.empty()) counted_.resize(values->size() - 1);
    if (values->size() - 1 != counted_.size()) fail(fmt::format("expected {} columns", counted_.size() + 1));
    if (values->front() != rows_) fail(fmt::format("expected the row of {} µs", rows_));
    const auto value_ns = static_cast<std::int64_t>(1000 * rows_++);
    for (std::size_t i = 0; i < counted_.size(); ++i) {
      add_many(value_ns, (*values)[i + 1]);
      counted_[i] += (*values)[i + 1];
    }
  }

  void add_many(std::int64_t value_ns, std::uint64_t many) {
    Histogram& h = result_.latency;
    if (many == 0) return;
    const std::int32_t bucket = bucket_of(value_ns);
    if (bucket < kHistogramBuckets) h.count[bucket] += static_cast<std::uint32_t>(many);
    if (bucket >= kHistogramBuckets) h.overflow += many;
    if (h.total == 0) h.min_ns = value_ns;
    h.max_ns = value_ns;
    h.sum_ns += value_ns * static_cast<std::int64_t>(many);
    h.total += many;
  }

  // "# Title: n n n": one number per thread.
  void summary(const std::string& line) {
    const std::size_t colon = line.find(':');
    const std::string title = line.substr(2, colon - 2);
    if (title != "Total" && title != "Max Latencies" && title != "Histogram Overflows") return;
    const auto values = numbers(colon == std::string::npos ? "" : line.substr(colon + 1));
    if (!values || values->size() < counted_.size()) fail("expected one number per thread after '" + title + "'");
    (title == "Total" ? totals_ : title == "Max Latencies" ? maxima_ : overflows_) = *values;
  }

  void check() {
    if (rows_ == 0) fail("no rows after '# Histogram'");
    if (totals_.empty()) fail("no line '# Total:': the file is cut off");
    for (std::size_t i = 0; i < counted_.size(); ++i) {
      if (totals_[i] != counted_[i]) {
        fail(fmt::format("thread {}: the rows add up to {}, its total is {}", i, counted_[i], totals_[i]));
      }
    }
    Histogram& h = result_.latency;
    for (std::size_t i = 0; i < counted_.size() && i < overflows_.size(); ++i) {
      h.overflow += overflows_[i];
      h.total += overflows_[i];
    }
    for (const std::uint64_t us : maxima_) h.max_ns = std::max(h.max_ns, static_cast<std::int64_t>(1000 * us));
    result_.threads = static_cast<int>(counted_.size());
  }

  std::istringstream lines_;
  std::string name_;
  int number_ = 0;
  std::uint64_t rows_ = 0;
  std::vector<std::uint64_t> counted_, totals_, maxima_, overflows_;
  CyclictestHistogram result_;
};

}  // namespace

CyclictestHistogram parse_cyclictest(const std::string& text, const std::string& name) {
  return Parser(text, name).parse();
}

CyclictestHistogram read_cyclictest(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot open");
  std::stringstream text;
  text << file.rdbuf();
  return parse_cyclictest(text.str(), path);
}

}  // namespace palpate
