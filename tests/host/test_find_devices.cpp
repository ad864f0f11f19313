// What is plugged in, told from a made-up /sys and made-up traffic: each kind is found with its next command, and what
// is alike is not taken for it.
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <random>

#include "hal/bus/codec.h"
#include "hal/bus/loopback.h"
#include "hal/bus/usb_hid.h"
#include "hal/device/device_profile.h"
#include "hal/drives/canopen_wire.h"
#include "hal/drives/moteus_sim.h"
#include "hal/drives/odrive_wire.h"
#include "sim_host/doctor/ask_moteus.h"
#include "sim_host/doctor/bus_speakers.h"
#include "sim_host/doctor/find_devices.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

Frame classic_frame(std::uint32_t id, std::initializer_list<int> bytes) {
  Frame frame{.id = id, .length = static_cast<std::uint8_t>(bytes.size())};
  std::ranges::copy(bytes, frame.data);
  return frame;
}

Frame status_frame(int node) {
  std::array<std::uint8_t, wire::kStatusBytes> payload;
  wire::encode(wire::Status{}, node, payload);
  Frame frame{.id = wire::kStatusId + static_cast<std::uint32_t>(node), .length = wire::kStatusBytes, .fd = true};
  std::ranges::copy(payload, frame.data);
  return frame;
}

Frame classic_position_frame(int node) {
  std::array<std::uint8_t, wire::kClassicPositionBytes> payload;
  wire::encode(wire::ClassicPosition{}, node, payload);
  Frame frame{.id = wire::kClassicPositionId + static_cast<std::uint32_t>(node), .length = wire::kClassicPositionBytes};
  std::ranges::copy(payload, frame.data);
  return frame;
}

Frame canopen_heartbeat(int node) {
  return classic_frame(canopen::kHeartbeat + static_cast<std::uint32_t>(node), {127});
}
Frame odrive_heartbeat(int node) {
  return classic_frame(odrive::frame_id(node, odrive::kHeartbeat), {0, 0, 0, 0, odrive::kIdle, 0, 0, 0});
}

class FindDevices : public testing::Test {
 protected:
  void SetUp() override {
    root_ =
        fs::path(testing::TempDir()) / "find_devices" / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  void put(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path, std::ios::binary) << text;
  }
  void put_can(const std::string& name, bool is_up, bool fd) {
    put("sys/class/net/" + name + "/type", "280\n");
    put("sys/class/net/" + name + "/flags", is_up ? "0x41\n" : "0x40\n");
    put("sys/class/net/" + name + "/mtu", fd ? "72\n" : "16\n");
  }
  std::vector<DoctorItem> find() {
    return find_devices(root_, [this](const std::string& name, bool fd) {
      listened_.push_back(name + (fd ? " fd" : ""));
      return traffic_;
    });
  }

  fs::path root_;
  BusTraffic traffic_;
  std::vector<std::string> listened_;
};

TEST_F(FindDevices, ABareMachineIsToldWhatCanBeDone) {
  const auto items = find();
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0].verdict, Verdict::kUnknown);
  EXPECT_NE(items[0].remedy.find("palpate view"), std::string::npos);
  EXPECT_TRUE(listened_.empty());
}

TEST_F(FindDevices, OpenNodesAreFoundByTheirChecksums) {
  put_can("can0", true, true);
  put("sys/class/net/eth0/type", "1\n");
  traffic_.frames = {status_frame(3), status_frame(3), status_frame(1)};
  auto items = find();
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0].name, "can:can0: open node 1, 3");
  EXPECT_EQ(items[0].verdict, Verdict::kPass);
  EXPECT_EQ(items[0].remedy, "palpate device-test can:can0");
  EXPECT_EQ(listened_, std::vector<std::string>{"can0 fd"});
  traffic_.frames = {classic_position_frame(2)};
  items = find();
  EXPECT_EQ(items[0].name, "can:can0: open node 2");
  EXPECT_EQ(items[0].remedy, "palpate device-test can:can0,classic,node=2");
}

TEST_F(FindDevices, DrivesAreFoundByTheirHeartbeats) {
  put_can("can1", true, false);
  traffic_.frames = {canopen_heartbeat(2), canopen_heartbeat(1)};
  auto items = find();
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0].name, "can:can1: CANopen node 1, 2");
  EXPECT_NE(items[0].remedy.find("example-delta-cia402.toml"), std::string::npos);
  traffic_.frames = {odrive_heartbeat(0), odrive_heartbeat(7)};
  items = find();
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0].name, "can:can1: ODrive 0, 7");
  EXPECT_NE(items[0].remedy.find("example-arm-odrive.toml"), std::string::npos);
}

TEST_F(FindDevices, ProfilesItNamesAreShipped) {
  put_can("can0", true, true);
  traffic_.frames = {status_frame(1), canopen_heartbeat(9), odrive_heartbeat(1)};
  const auto items = find();
  ASSERT_EQ(items.size(), 3u);
  for (const DoctorItem& item : items) {
    const std::size_t at = item.found.find("config/devices/");
    ASSERT_NE(at, std::string::npos) << item.found;
    EXPECT_TRUE(fs::exists(fs::path(PALPATE_SOURCE_DIR) / item.found.substr(at))) << item.found;
  }
}

TEST_F(FindDevices, AnInterfaceThatIsDownSaysHowToRaiseIt) {
  put_can("can0", false, true);
  put("sys/class/net/can0/device/vendor", "0x1");
  put_can("vcan0", false, true);
  const auto items = find();
  ASSERT_EQ(items.size(), 2u);
  for (const DoctorItem& item : items) EXPECT_EQ(item.verdict, Verdict::kFail);
  EXPECT_EQ(items[0].remedy.find("ip link set can0 up type can bitrate 1000000"), 0u) << items[0].remedy;
  EXPECT_EQ(items[1].remedy, "ip link set vcan0 up");
  EXPECT_TRUE(listened_.empty());
}

TEST_F(FindDevices, SilenceForeignTrafficAndRefusalAreToldApart) {
  put_can("can0", true, false);
  EXPECT_NE(find()[0].found.find("nobody heard"), std::string::npos);
  traffic_.frames = {classic_frame(0x123, {1, 2, 3}), classic_frame(0x7E8, {3, 65, 13})};
  EXPECT_EQ(find()[0].found, "2 frames of 2 identifiers, of no driver here, the first 0x123");
  traffic_ = {{}, "no permission"};
  EXPECT_EQ(find()[0].found, "not listened to: no permission");
  for (const DoctorItem& item : find()) EXPECT_EQ(item.verdict, Verdict::kUnknown);
}

TEST_F(FindDevices, TheHidNodeIsKnownByItsDescriptorAlone) {
  const std::string ours(reinterpret_cast<const char*>(kReportDescriptor), sizeof kReportDescriptor);
  put("sys/class/hidraw/hidraw0/device/report_descriptor", std::string("\x05\x01\x09\x06\xA1\x01", 6));  // a keyboard
  put("sys/class/hidraw/hidraw1/device/report_descriptor", ours);
  put("sys/class/hidraw/hidraw1/device/uevent", "HID_ID=0003:1\nHID_NAME=A lab Handle\nHID_UNIQ=\n");
  put("sys/class/hidraw/hidraw2/device/report_descriptor", ours.substr(0, ours.size() - 1));
  const auto items = find();
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0].name, "usb:/dev/hidraw1: open node");
  EXPECT_NE(items[0].found.find("'A lab Handle'"), std::string::npos);
  EXPECT_EQ(items[0].remedy, "palpate device-test usb:/dev/hidraw1");
}

TEST_F(FindDevices, AFalconIsFoundByItsNumbers) {
  put("sys/bus/usb/devices/1-1/idVendor", "0403\n");
  put("sys/bus/usb/devices/1-1/idProduct", "cb48\n");
  put("sys/bus/usb/devices/1-1/busnum", "1\n");
  put("sys/bus/usb/devices/1-1/devnum", "12\n");
  put("sys/bus/usb/devices/1-2/idVendor", "046d\n");
  put("sys/bus/usb/devices/1-2/idProduct", "c077\n");
  const auto items = find();
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0].verdict, Verdict::kPass);
  EXPECT_EQ(items[0].name, "usb:/dev/bus/usb/001/012: Novint Falcon");
  EXPECT_EQ(items[0].remedy, "palpate device-test usb:/dev/bus/usb/001/012 --profile FILE");
}

// Three moteus controllers say nothing until they are asked; then they answer as the real ones do, and none is enabled.
TEST_F(FindDevices, MoteusControllersAreFoundByAsking) {
  put_can("can0", true, true);
  put_can("can1", true, false);
  EXPECT_NE(find()[0].found.find("a moteus until it is asked"), std::string::npos);
  EXPECT_EQ(find()[0].remedy.find("palpate doctor --device --ask"), 0u);
  EXPECT_EQ(find()[1].found.find("moteus"), std::string::npos) << "not on a classic bus";
  std::string error;
  const auto profile =
      read_device_profile(std::string(PALPATE_SOURCE_DIR) + "/config/devices/example-arm-moteus.toml", error);
  ASSERT_TRUE(profile && profile->arm) << error;
  auto ends = open_loopback_pair(error);
  MoteusSim sim(*ends.second, *profile->arm, {}, {});
  std::vector<std::string> asked;
  const AskOn ask = [&](const std::string& name) {
    asked.push_back(name);
    return BusAnswers{ask_moteus(*ends.first, [&sim] { sim.step_bus(); }), ""};
  };
  const auto listen = [this](const std::string&, bool) { return traffic_; };
  auto items = find_devices(root_, listen, ask);
  ASSERT_EQ(items.size(), 2u);
  EXPECT_EQ(items[0].name, "can:can0: moteus 1, 2, 3");
  EXPECT_EQ(items[0].verdict, Verdict::kPass);
  EXPECT_NE(items[0].remedy.find("example-arm-moteus.toml"), std::string::npos);
  EXPECT_EQ(asked, std::vector<std::string>{"can0"}) << "CAN FD alone";
  EXPECT_FALSE(sim.any_enabled());
  EXPECT_EQ(sim.watchdogs(), 0u);
  sim.set_fault({.axis = 1, .mute = true});
  EXPECT_EQ(find_devices(root_, listen, ask)[0].name, "can:can0: moteus 1, 3");
  traffic_.frames = {odrive_heartbeat(7)};
  asked.clear();
  items = find_devices(root_, listen, ask);
  EXPECT_EQ(items[1].found, "moteus not asked for: classic frames were heard, whose nodes CAN FD may disturb");
  EXPECT_TRUE(asked.empty());
}

TEST_F(FindDevices, NobodyWhoAnswersIsSaid) {
  put_can("can0", true, true);
  const auto listen = [](const std::string&, bool) { return BusTraffic(); };
  auto items = find_devices(root_, listen, [](const std::string&) { return BusAnswers(); });
  ASSERT_EQ(items.size(), 1u);
  EXPECT_NE(items[0].found.find("no moteus answers"), std::string::npos);
  items = find_devices(root_, listen, [](const std::string&) { return BusAnswers{{}, "it is driven"}; });
  EXPECT_EQ(items[0].found, "moteus not asked for: it is driven");
}

// CANopen's node 1 sends its first process data object with identifier 0x181, which is ODrive 12's heartbeat.
TEST(BusSpeakers, ProcessDataOfADriveIsNoOdrive) {
  const Frame pdo = classic_frame(0x181, {1, 2, 3, 4, 5, 6, 7, 8});
  EXPECT_EQ(speakers_of(std::vector{pdo}), (std::vector<Speaker>{{Protocol::kOdrive, 12}}));
  EXPECT_EQ(speakers_of(std::vector{pdo, canopen_heartbeat(1)}), (std::vector<Speaker>{{Protocol::kCanopen, 1}}));
}

// One random payload in 256 has the checksum of the classic profile: 2,000 of one identifier have some that do.
TEST(BusSpeakers, ChanceIsNoOpenNode) {
  std::mt19937 draw(7);
  std::vector<Frame> frames;
  int by_chance = 0;
  for (int i = 0; i < 2000; ++i) {
    Frame frame{.id = wire::kClassicPositionId + 1, .length = 8};
    for (int k = 0; k < 8; ++k) frame.data[k] = static_cast<std::uint8_t>(draw());
    wire::ClassicPosition position;
    by_chance += wire::decode({frame.data, 8}, 1, position) == wire::DecodeResult::kOk ? 1 : 0;
    frames.push_back(frame);
  }
  EXPECT_GT(by_chance, 0);
  for (const Speaker& speaker : speakers_of(frames)) EXPECT_NE(speaker.protocol, Protocol::kOpenNodeClassic);
}

TEST(BusSpeakers, GarbageOfEveryLengthIsNobody) {
  std::mt19937 draw(11);
  std::vector<Frame> frames;
  for (std::uint32_t id = 0; id < 0x800; ++id)
    for (const bool fd : {false, true}) {
      Frame frame{.id = id, .length = static_cast<std::uint8_t>(fd ? draw() % 65 : draw() % 8), .fd = fd};
      for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(draw() | 0x80);
      if (frame.length == 1) frame.data[0] = 0xFE;  // no state of CiA 301
      frames.push_back(frame);
    }
  EXPECT_TRUE(speakers_of(frames).empty());
}

}  // namespace
}  // namespace palpate::test
