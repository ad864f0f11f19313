// What an attacker, an editor or a broken host may do to a running controller: change its image's file, send it wrong
// handshakes, write garbage into its mailbox, or die. Each once broke it, or might have.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "sim_host/bake/scene_image.h"
#include "sim_host/exit_codes.h"
#include "sim_host/run/controller_link.h"
#include "sim_host/run/device_process.h"
#include "tests/support/ball_run.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Attack : public BallRun {
 protected:
  Attack() : scene_(prepare_scene(options_.scene, "", (folder_ / "run.plr").string())) {}

  std::vector<std::string> arguments() const {
    return {"--image", scene_.image_path, "--device", "loopback", "--device-fd", "4", "--priority", "0"};
  }
  std::string program(const char* name) const { return options_.program_folder + "/" + name; }
  // Beats until the controller has written `ticks` more records, or has ended.
  void beat_for(ControllerLink& link, std::uint64_t ticks) {
    const std::uint64_t until = link.telemetry().newest.load() + ticks;
    for (int i = 0; i < 2000 && link.telemetry().newest.load() < until && link.process().running(); ++i) {
      link.mailbox().beat();
      std::this_thread::sleep_for(milliseconds(5));
    }
  }

  SceneImage scene_;
};

// cp, truncate and dd on the image of a running controller: SIGBUS, SIGBUS and SIGSEGV before (2026-11-21).
TEST_F(Attack, AnImageFileChangedUnderTheControllerChangesNothing) {
  const std::string whole = text_of(scene_.image_path);
  const std::function<void()> changes[] = {
      [&] { std::filesystem::resize_file(scene_.image_path, 0); },
      [&] {
        std::ofstream(scene_.image_path, std::ios::binary | std::ios::trunc) << std::string(whole.size() / 2, 'x');
      },
      [&] {  // dd conv=notrunc
        std::fstream file(scene_.image_path, std::ios::binary | std::ios::in | std::ios::out);
        file << std::string(whole.size(), '\xff');
      },
  };
  for (const auto& change : changes) {
    std::ofstream(scene_.image_path, std::ios::binary | std::ios::trunc) << whole;
    DeviceProcess device(program("palpate-device"), scene_, "", "loopback", 0);
    ControllerLink link(program("palpate-rt"), arguments(), device.controller_end());
    device.close_controller_end();
    beat_for(link, 50);
    change();
    const std::uint64_t before = link.telemetry().newest.load();
    beat_for(link, 200);
    EXPECT_GE(link.telemetry().newest.load(), before + 200);
    const int exit_code = link.finish();
    EXPECT_TRUE(exit_code == 0 || exit_code == 1) << exit_code;  // 1: an overrun of this computer
  }
}

// A host of our own making: what it sends instead of the mailbox, and whether the controller goes away by itself.
class EvilHandshake : public Attack {
 protected:
  // Returns the exit code of a controller whose host does `act` with the socket.
  int exit_code_after(const std::function<void(int socket)>& act) {
    int control[2], device[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, control), 0);
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, device), 0);
    std::vector<std::string> all = arguments();
    all.insert(all.end(), {"--control-fd", "3"});
    Process process = Process::start(program("palpate-rt"), all, {{control[1], 3}, {device[1], 4}});
    close(control[1]);
    act(control[0]);
    const bool ended = process.wait(20'000);
    for (const int fd : {control[0], device[0], device[1]}) close(fd);
    EXPECT_TRUE(ended);
    return process.exit_code();
  }
  static void pass(int socket, char tag, int fd) {
    std::string error;
    EXPECT_TRUE(send_descriptor(socket, tag, fd, error)) << error;
  }
};

TEST_F(EvilHandshake, IsRefusedWithoutAWordToTheDevice) {
  constexpr int kUnavailable = 3;
  std::string error;
  const auto memory_of = [&](std::size_t bytes, auto fill) {
    SharedMemory memory = SharedMemory::create("evil", bytes, error);
    EXPECT_TRUE(memory) << error;
    fill(static_cast<MailboxRegion*>(memory.data()));
    return memory;
  };
  const auto valid = [](MailboxRegion* region) { MailboxWriter{*region}; };
  const auto memfd = [](std::size_t bytes, unsigned flags) {
    const int fd = memfd_create("evil", flags | MFD_CLOEXEC);
    EXPECT_EQ(ftruncate(fd, static_cast<off_t>(bytes)), 0);
    return fd;
  };
  EXPECT_EQ(exit_code_after([](int socket) { shutdown(socket, SHUT_RDWR); }), kUnavailable) << "hangs up";
  EXPECT_EQ(exit_code_after([](int socket) { send(socket, "C", 1, 0); }), kUnavailable) << "no descriptor";
  EXPECT_EQ(exit_code_after([](int socket) { send(socket, std::string(4096, 'C').data(), 4096, 0); }), kUnavailable);
  EXPECT_EQ(exit_code_after([](int) {}), kUnavailable) << "says nothing";
  EXPECT_EQ(exit_code_after([](int socket) { pass(socket, 'C', STDERR_FILENO); }), kUnavailable) << "no memory at all";
  EXPECT_EQ(exit_code_after([&](int socket) {
              const int fd = memfd(sizeof(MailboxRegion), 0);
              pass(socket, 'C', fd);
              close(fd);
            }),
            kUnavailable)
      << "not sealed, cannot be";
  EXPECT_EQ(exit_code_after([&](int socket) {
              const int fd = memfd(sizeof(MailboxRegion), MFD_ALLOW_SEALING);
              pass(socket, 'C', fd);
              close(fd);
            }),
            kUnavailable)
      << "not sealed yet";
  EXPECT_EQ(exit_code_after([&](int socket) { pass(socket, 'C', memory_of(4096, [](auto*) {}).fd()); }), kUnavailable)
      << "too short or too long";
  EXPECT_EQ(exit_code_after([&](int socket) { pass(socket, 'T', memory_of(sizeof(MailboxRegion), valid).fd()); }),
            kUnavailable)
      << "wrong label";
  EXPECT_EQ(exit_code_after([&](int socket) {
              pass(socket, 'C', memory_of(sizeof(MailboxRegion), [](auto* region) {
                                  MailboxWriter{*region};
                                  region->version += 1;
                                }).fd());
            }),
            kUnavailable)
      << "another build's";
}

// Each writes into the mailbox of a controller that runs. It must ramp out and end by itself with a fault; nothing the
// host can write stops the loop or makes it go on for ever.
class EvilMailbox : public Attack {
 protected:
  struct End {
    int exit_code = -1;
    std::uint32_t fault = 0;
    Wrench device_w;
  };
  // `act` is called about every 2 ms with the region until the controller has ended.
  End end_of(const std::function<void(MailboxRegion& region, MailboxWriter& writer, int turn)>& act, bool beats) {
    DeviceProcess device(program("palpate-device"), scene_, "", "loopback", 0);
    ControllerLink link(program("palpate-rt"), arguments(), device.controller_end());
    device.close_controller_end();
    link.mailbox().set(Command::kArm, false);
    beat_for(link, 100);
    MailboxRegion& region = link.mailbox_region();
    for (int turn = 0; turn < 5000 && link.process().running(); ++turn) {
      if (beats) link.mailbox().beat();
      act(region, link.mailbox(), turn);
      std::this_thread::sleep_for(milliseconds(2));
    }
    EXPECT_TRUE(link.process().wait(10'000));
    TelemetryReader reader(link.telemetry());
    TickRecord last{};
    EXPECT_TRUE(reader.newest(last));
    return {link.process().exit_code(), last.output.fault, last.output.device_w};
  }
  void expect_fault(const End& end, std::uint32_t fault, const char* attack) {
    EXPECT_EQ(end.exit_code, kExitFault) << attack;
    EXPECT_NE(end.fault & (fault | Fault::kOverrun | Fault::kDeviceSilent), 0u) << attack;  // this computer may be busy
    EXPECT_EQ(end.device_w, Wrench{}) << attack;
  }
};

TEST_F(EvilMailbox, EndsTheRunWithZeroForceWhateverItHolds) {
  const auto word = [](std::size_t index, std::uint64_t value) {
    return [=](MailboxRegion& region, MailboxWriter&, int) { region.word[index].store(value); };
  };
  constexpr std::size_t kCommandsWord = offsetof(HostCommand, commands) / 8, kGeneration = 0,
                        kJoints = offsetof(HostCommand, joints) / 8,
                        kDirect = (offsetof(HostCommand, joints) + offsetof(JointCommand, direct)) / 8;
  static_assert(offsetof(JointCommand, reserved) == offsetof(JointCommand, direct) + 4 &&
                offsetof(JointCommand, direct) % 8 == 0);
  expect_fault(end_of(word(kCommandsWord, ~0ull), false), Fault::kCommandInvalid, "unknown commands");
  expect_fault(end_of(word(kDirect, 1ull << 32), false), Fault::kCommandInvalid, "reserved set");
  expect_fault(end_of(word(kJoints, 0x7fc000007fc00000ull), false), Fault::kCommandInvalid,
               "joints that are no number");
  expect_fault(end_of([](MailboxRegion& region, MailboxWriter&,
                         int turn) { region.word[kGeneration].store(turn == 0 ? ~0ull : 1); },
                      false),
               Fault::kCommandInvalid, "generation goes back");
  expect_fault(end_of([](MailboxRegion& region, MailboxWriter&, int) { region.sequence.store(1); }, false),
               Fault::kHostSilent, "torn for ever");
  expect_fault(end_of([](MailboxRegion& region, MailboxWriter&, int) { region.sequence.store(0); }, false),
               Fault::kHostSilent, "never written");
  expect_fault(end_of([](MailboxRegion&, MailboxWriter&, int) {}, false), Fault::kHostSilent, "silence");
  expect_fault(end_of(
                   [](MailboxRegion& region, MailboxWriter&, int turn) {
                     for (auto& w : region.word) w.store(0x9E3779B97F4A7C15ull * static_cast<unsigned>(turn + 1));
                   },
                   false),
               Fault::kCommandInvalid | Fault::kHostSilent, "noise");
}

TEST_F(EvilMailbox, TogglingCommandsNeitherStopsTheLoopNorOutlivesIt) {
  int turns = 0;
  const End end = end_of(
      [&](MailboxRegion&, MailboxWriter& writer, int turn) {
        constexpr std::uint32_t kSome[] = {Command::kArm, Command::kStop, Command::kReset, 0,
                                           Command::kArm | Command::kStop | Command::kReset};
        writer.set(kSome[turn % 5], turn > 300);
        turns = turn;
      },
      true);
  EXPECT_GT(turns, 0);
  EXPECT_TRUE(end.exit_code == 0 || end.exit_code == 1) << end.exit_code;
  EXPECT_EQ(end.device_w, Wrench{});
}

}  // namespace
}  // namespace palpate
