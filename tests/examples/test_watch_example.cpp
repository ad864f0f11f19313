// docs/examples/watch.py, as its reader starts it, on a ring that stands still: what it prints is what was written.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "sim_host/rings/telemetry_door.h"
#include "sim_host/rings/telemetry_schema.h"

namespace palpate {
namespace {

#ifdef PALPATE_PYTHON3

std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> part;
  while (pipe != nullptr && std::fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
  if (pipe != nullptr) pclose(pipe);
  return text;
}

TEST(WatchExample, PrintsTheTicksItIsShown) {
  std::string error;
  SharedMemory memory = SharedMemory::create("palpate-telemetry", sizeof(TelemetryRegion), error);
  ASSERT_TRUE(memory) << error;
  auto& region = *static_cast<TelemetryRegion*>(memory.data());
  Model model;
  model.name = "a scene";
  TelemetryWriter writer;
  writer.open(region, model, 1'000'000, "a build", "image.pal");
  describe_telemetry(region);
  TickRecord record{};
  for (std::uint64_t tick = 0; tick < kTelemetryCapacity + 3; ++tick) {
    record.tick = tick;
    record.output.mode = Mode::kRamp;
    record.output.device_w.force_N = {0.25, -1.5, 1e-9};
    writer.write(record);
  }
  const std::string path =
      (std::filesystem::temp_directory_path() / ("palpate_watch_" + std::to_string(getpid()))).string();
  TelemetryDoor door;
  ASSERT_TRUE(door.open(path, memory.fd(), error)) << error;
  const std::string watch = std::string(PALPATE_PYTHON3) + " " PALPATE_SOURCE_DIR "/docs/examples/watch.py ";
  EXPECT_EQ(output_of(watch + path + " 0.01"),
            "a scene every 1000000 ns, by a build\n4098 ramp force [0.25, -1.5, 1e-09] N\n");
  EXPECT_NE(output_of(watch + path + ".none 0.01").find("No such file"), std::string::npos);
}

#endif

}  // namespace
}  // namespace palpate
