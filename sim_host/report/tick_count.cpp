#include "sim_host/report/tick_count.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string_view>

#include "config/scene/child_program.h"

namespace palpate {

namespace {

// The function of each stage as it stands in a call, in the stages' order.
constexpr const char* kFunction[kStageCount] = {
#define PALPATE_NAME(name, function, shown, what) #function,
    PALPATE_STAGES(PALPATE_NAME)
#undef PALPATE_NAME
};

// -1: no stage. Methods give their steps names of their own (tests/bench/worst_tick.awk does the same).
int stage_of(std::string_view function) {
  const std::size_t bracket = function.find('(', function.starts_with("palpate::(") ? 12 : 0);
  std::string name(function.substr(0, bracket));
  if (const std::size_t colon = name.rfind(':'); colon != std::string::npos) name.erase(0, colon + 1);
  if (name.starts_with("find_")) name = "find_rows";
  if (name.starts_with("rub") || name == "load_pieces") name = "account";
  for (int i = 0; i < kStageCount; ++i)
    if (name == kFunction[i]) return i;
  return -1;
}

// One tick's part of the file.
struct Part {
  std::int64_t total = 0;
  std::array<std::int64_t, kStageCount> stage{};
};

// The first tick has no last place to start its search from: a path has one, and it says nothing of the rest.
void keep(const Part& part, bool& is_first, TickCount& count, std::int64_t& sum) {
  if (part.total == 0) return;
  if (is_first) {
    is_first = false;
    return;
  }
  count.ticks += 1;
  sum += part.total;
  if (part.total <= count.worst) return;
  count.worst = part.total;
  count.worst_stage = part.stage;
}

void write_poses(const std::string& path, std::span<const TimedPose> poses) {
  std::ofstream out(path);
  out << "x_mm,y_mm,z_mm\n";
  for (const TimedPose& pose : poses) {
    const Vec3 p = 1e3 * pose.tool_w.position_m;
    out << fmt::format("{:.12g},{:.12g},{:.12g}\n", p.x, p.y, p.z);
  }
}

}  // namespace

TickCount read_callgrind(const std::string& path) {
  std::ifstream in(path);
  TickCount count;
  std::string line;
  Part part;
  bool in_tick = false, called = false, is_first = true;
  int callee = -1;
  std::int64_t sum = 0;
  while (std::getline(in, line)) {
    if (line.starts_with("part: ")) {
      keep(part, is_first, count, sum);
      part = {};
      in_tick = false;
    } else if (line.starts_with("fn=")) {
      in_tick = line.starts_with("fn=palpate::tick(") || line.starts_with("fn=palpate::contact(");
    } else if (line.starts_with("cfn=")) {
      callee = stage_of(std::string_view(line).substr(4));
    } else if (line.starts_with("calls=")) {
      called = true;
    } else if (called) {
      called = false;
      if (in_tick && callee >= 0)
        part.stage[static_cast<std::size_t>(callee)] += std::atoll(line.c_str() + line.find(' ') + 1);
    } else if (line.starts_with("totals: ")) {
      part.total = std::atoll(line.c_str() + 8);
    }
  }
  keep(part, is_first, count, sum);
  count.counted = count.ticks > 0;
  if (count.counted) count.mean = sum / count.ticks;
  return count;
}

TickCount count_ticks(const std::string& image_path, std::span<const TimedPose> poses) {
  TickCount count;
  try {
    const TemporaryFolder folder("palpate-count");
    write_poses(folder.file("poses.csv"), poses);
    const int status = run_program(
        {"valgrind", "--tool=callgrind", "--quiet", "--collect-atstart=no", "--toggle-collect=palpate::tick(*",
         "--dump-after=palpate::tick(palpate::Model const&*", "--combine-dumps=yes", "--compress-strings=no",
         "--compress-pos=no", "--callgrind-out-file=" + folder.file("counts"), own_program("palpate"), "press",
         image_path, "--path", folder.file("poses.csv"), "--out", folder.file("forces.csv"), "--allow",
         "unconverged=100"},
        folder.file("log"));
    count = read_callgrind(folder.file("counts"));
    if (status == kProgramMissing)
      count.why_not = "valgrind is not installed";
    else if (!count.counted)
      count.why_not = "valgrind: " + last_lines(folder.file("log"));
  } catch (const std::exception& error) {
    count.why_not = error.what();
  }
  return count;
}

}  // namespace palpate
