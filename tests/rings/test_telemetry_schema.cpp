// Telemetry as a stranger reads it: by the schema in the region alone; and who is let in at the door.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "hal/system/local_socket.h"
#include "sim_host/record/record_markdown.h"
#include "sim_host/rings/telemetry_door.h"
#include "sim_host/rings/telemetry_schema.h"
#include "tests/config/generated_docs.h"

namespace palpate {
namespace {

using nlohmann::json;

TEST(RecordFormat, DocumentIsCurrent) {
  expect_generated(PALPATE_SOURCE_DIR "/docs/record_format.md", "## Tables", record_markdown());
}

// Every byte another one.
TickRecord patterned() {
  TickRecord record;
  auto* bytes = reinterpret_cast<unsigned char*>(&record);
  for (std::size_t i = 0; i < sizeof record; ++i) bytes[i] = static_cast<unsigned char>(i * 37 + i / 251);
  record.region_count = 2;
  return record;
}

class Schema : public testing::Test {
 protected:
  Schema() {
    memory_ = SharedMemory::create("palpate-telemetry", sizeof(TelemetryRegion), error_);
    region_ = static_cast<TelemetryRegion*>(memory_.data());
    Model model;
    model.scene_hash = 0x1234;
    model.name = "ring";
    writer_.open(*region_, model, 1'000'000, "build", "ring.pal");
    describe_telemetry(*region_);
    path_ = (std::filesystem::temp_directory_path() / ("palpate_door_" + std::to_string(getpid()))).string();
  }
  ~Schema() override { std::filesystem::remove(path_); }
  // As a stranger: from the 24 bytes that are promised.
  json schema() const {
    const auto* bytes = reinterpret_cast<const char*>(region_);
    std::uint32_t size;
    std::uint64_t start;
    std::memcpy(&size, bytes + 12, 4);
    std::memcpy(&start, bytes + 16, 8);
    return json::parse(std::string(bytes + start, size));
  }

  std::string error_, path_;
  SharedMemory memory_;
  TelemetryRegion* region_ = nullptr;
  TelemetryWriter writer_;
};

// Where the schema says a field lies: the bytes that the struct's own member has.
#define EXPECT_FIELD(bytes, part, name, member)                                                                      \
  do {                                                                                                               \
    const json* found = nullptr;                                                                                     \
    for (const json& field : (part)["fields"])                                                                       \
      if (field["name"] == (name)) found = &field;                                                                   \
    ASSERT_NE(found, nullptr) << (name);                                                                             \
    EXPECT_EQ(std::memcmp((bytes) + (*found)["offset"].get<std::size_t>(), &(member), sizeof(member)), 0) << (name); \
  } while (false)

TEST_F(Schema, FindsEveryFieldOfARecordThatWasWritten) {
  const TickRecord record = patterned();
  writer_.write(record);
  const json schema = this->schema();
  const json& ring = schema["ring"];
  const auto* slot = reinterpret_cast<const char*>(region_) + ring["slots"].get<std::size_t>() +
                     1 % ring["capacity"].get<std::size_t>() * ring["slot_bytes"].get<std::size_t>();
  std::uint64_t sequence;
  std::memcpy(&sequence, slot + ring["sequence"].get<std::size_t>(), 8);
  EXPECT_EQ(sequence, 1u);
  const char* bytes = slot + ring["record"].get<std::size_t>();
  const json& part = schema["record"];
  EXPECT_EQ(part["bytes"], sizeof(TickRecord));
  EXPECT_FIELD(bytes, part, "tick", record.tick);
  EXPECT_FIELD(bytes, part, "state_hash", record.state_hash);
  EXPECT_FIELD(bytes, part, "deadline_ns", record.timing.deadline_ns);
  EXPECT_FIELD(bytes, part, "stage_ns", record.timing.stage_ns);
  EXPECT_FIELD(bytes, part, "input_position_m", record.input.pose_w.position_m);
  EXPECT_FIELD(bytes, part, "input_orientation", record.input.pose_w.orientation);
  EXPECT_FIELD(bytes, part, "joint_target", record.input.joints.target);
  EXPECT_FIELD(bytes, part, "live_coupling", record.input.live.coupling);
  EXPECT_FIELD(bytes, part, "input_second_position_m", record.input.second_w.position_m);
  EXPECT_FIELD(bytes, part, "device_force_N", record.output.device_w.force_N);
  EXPECT_FIELD(bytes, part, "contact_torque_Nm", record.output.contact_w.torque_Nm);
  EXPECT_FIELD(bytes, part, "tool_orientation", record.output.tool_w.orientation);
  EXPECT_FIELD(bytes, part, "status", record.output.status);
  EXPECT_FIELD(bytes, part, "most_contacts", record.high_water.contacts);
  EXPECT_FIELD(bytes, part, "region_count", record.region_count);
  const json& regions = schema["regions"];
  const char* second = bytes + regions["offset"].get<std::size_t>() + regions["bytes"].get<std::size_t>();
  EXPECT_FIELD(second, regions, "force_w", record.region[1].force_w);
  EXPECT_FIELD(second, regions, "friction", record.region[1].friction);
  EXPECT_FIELD(reinterpret_cast<const char*>(region_), schema["header"], "scene_hash", region_->header.scene_hash);
}

TEST_F(Schema, NamesEveryFieldOnceWithTypeUnitAndMeaning) {
  const json schema = this->schema();
  EXPECT_EQ(schema["version"], kTelemetryVersion);
  EXPECT_LT(telemetry_schema().size(), kSchemaBytes) << "raise kSchemaBytes";
  for (const char* part : {"header", "record", "regions", "later_scenes"}) {
    std::set<std::string> names;
    for (const json& field : schema[part]["fields"]) {
      const std::string name = field["name"];
      EXPECT_TRUE(names.insert(name).second) << name << " twice";
      EXPECT_LT(name.size(), RecordField::kNameBytes);
      EXPECT_FALSE(field["meaning"].get<std::string>().empty()) << name;
      const bool real = field["type"] == "<f8" || field["type"] == "<f4";
      EXPECT_FALSE(real && field["unit"] == "") << name;
    }
  }
  EXPECT_EQ(schema["bits"]["fault"]["2"], "DeviceSilent");
  EXPECT_EQ(schema["modes"][static_cast<std::size_t>(Mode::kFault)], "fault");
}

TEST_F(Schema, TheDoorLetsTheSameUserReadAndNothingElse) {
  TelemetryDoor door;
  ASSERT_TRUE(door.open(path_, memory_.fd(), error_)) << error_;
  for (int reader = 0; reader < 5; ++reader) {
    const AttachedTelemetry attached = attach_telemetry(path_);
    EXPECT_EQ(attached.controller, getpid());
    writer_.write(patterned());
    TickRecord got;
    ASSERT_TRUE(TelemetryReader(attached.region()).newest(got));
    EXPECT_EQ(got.sequence, static_cast<std::uint64_t>(reader + 1));
    const int fd = attached.memory.fd();
    EXPECT_EQ(mmap(nullptr, sizeof(TelemetryRegion), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0), MAP_FAILED);
    EXPECT_EQ(errno, EPERM);
    EXPECT_EQ(mprotect(attached.memory.data(), 4096, PROT_READ | PROT_WRITE), -1);
    EXPECT_EQ(pwrite(fd, "x", 1, 0), -1);
  }
}

// They connect and say nothing, or talk without end and never read.
TEST_F(Schema, ReadersThatHangOrShoutDoNotKeepOthersOut) {
  TelemetryDoor door;
  ASSERT_TRUE(door.open(path_, memory_.fd(), error_)) << error_;
  LocalAddress address;
  ASSERT_TRUE(make_local_address(path_, address, error_));
  std::vector<int> hanging;
  const std::string noise(4096, 'x');
  for (int i = 0; i < 40; ++i) {
    const int fd = open_local_socket();
    ASSERT_EQ(connect(fd, address.generic(), address.length), 0);
    for (int k = 0; k < 100; ++k)
      if (send(fd, noise.data(), noise.size(), MSG_DONTWAIT | MSG_NOSIGNAL) < 0) break;
    hanging.push_back(fd);
  }
  EXPECT_EQ(attach_telemetry(path_).controller, getpid());
  for (const int fd : hanging) close(fd);
}

TEST_F(Schema, AnotherUserIsToldWhyNot) {
  if (geteuid() != 0) return;  // only root can become somebody else
  // The tests' own folder lets nobody else in; a stranger shall come as far as the door.
  std::filesystem::permissions(std::filesystem::path(path_).parent_path(),
                               std::filesystem::perms::group_exec | std::filesystem::perms::others_exec,
                               std::filesystem::perm_options::add);
  TelemetryDoor door;
  ASSERT_TRUE(door.open(path_, memory_.fd(), error_)) << error_;
  int said[2];
  ASSERT_EQ(pipe(said), 0);
  const pid_t child = fork();
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (setuid(kNobody) != 0) _exit(1);
    // Without our own check of who listens: a stranger's reader asks the door all the same.
    LocalAddress address;
    std::string error;
    const bool named = make_local_address(path_, address, error);
    const int fd = open_local_socket();
    char text[256];
    if (!named || connect(fd, address.generic(), address.length) != 0) _exit(2);
    const ssize_t got = recv(fd, text, sizeof text, 0);
    _exit(got > 0 && write(said[1], text, static_cast<std::size_t>(got)) == got ? 0 : 3);
  }
  int status = -1;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  char text[256] = {};
  ASSERT_GT(read(said[0], text, sizeof text - 1), 0);
  EXPECT_NE(std::string(text).find("refused: you are user 65534"), std::string::npos) << text;
  close(said[0]);
  close(said[1]);
}

TEST_F(Schema, WhatIsNoDoorIsSaid) {
  const auto why = [](const std::string& where) {
    try {
      attach_telemetry(where);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(why(path_).find("No such file"), std::string::npos) << why(path_);
  EXPECT_NE(why("1").find("none there"), std::string::npos) << why("1");
  TelemetryDoor door;
  EXPECT_FALSE(door.open("name", memory_.fd(), error_));
  EXPECT_NE(error_.find("./name"), std::string::npos) << error_;
  EXPECT_FALSE(door.open(path_ + std::string(200, 'x'), memory_.fd(), error_));
}

TEST_F(Schema, ADeadControllersPathIsReplacedAndAFileIsNot) {
  LocalAddress address;
  ASSERT_TRUE(make_local_address(path_, address, error_));
  const int dead = open_local_socket();
  ASSERT_EQ(bind(dead, address.generic(), address.length), 0);
  close(dead);
  {
    TelemetryDoor door, second;
    ASSERT_TRUE(door.open(path_, memory_.fd(), error_)) << error_;
    EXPECT_FALSE(second.open(path_, memory_.fd(), error_)) << "somebody listens there";
  }
  EXPECT_FALSE(std::filesystem::exists(path_)) << "removed with the door";
  std::ofstream(path_) << "mine";
  TelemetryDoor door;
  EXPECT_FALSE(door.open(path_, memory_.fd(), error_));
  EXPECT_EQ(std::filesystem::file_size(path_), 4u);
}

}  // namespace
}  // namespace palpate
