// Command mailbox: the one-way region through which the host tells the controller what to do. Only the host writes
// it; the controller maps it read-only, copies it at most twice per tick, and believes the copy only after checking it.
//
//   host                                controller (every tick, at most two tries)
//   version = odd        (relaxed)
//                                       v1 = version   (acquire)   odd: try once more, then keep the last command
//   word[i] = new        (release)
//                                       copy word[i]   (acquire)
//   version = even       (release)
//                                       v2 = version   (relaxed)   v1 != v2: try once more, then keep the last command
//
// The argument that a torn copy is always noticed is the one in telemetry.h, cases A, B and C.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "rt_core/io.h"

namespace palpate {

inline constexpr std::uint64_t kMailboxMagic = 0x31304C49414D504Cull;  // bytes "LPMAIL01"
inline constexpr std::uint32_t kMailboxVersion = 4;

// What the host asks for. Levels, not events: the newest replaces the older ones.
struct HostCommand {
  std::uint64_t generation = 0;  // +1 with every change of the other fields but heartbeat; never goes back
  std::uint32_t commands = 0;    // Command bits, given to every tick until changed
  std::uint32_t quit = 0;        // 1: ramp to zero force, then leave the loop
  std::uint64_t heartbeat = 0;   // +1 several times a second while the host lives
  JointCommand joints;           // for an articulated tool; reserved must be 0
  LiveSettings live;             // what is wanted of the settings that may change during a run
  std::uint64_t scene = 0;       // number of the scene to go over to, of those that were announced; never goes back
};
static_assert(std::is_trivially_copyable_v<HostCommand> && sizeof(HostCommand) % 8 == 0);
inline constexpr std::size_t kCommandWords = sizeof(HostCommand) / 8;
inline constexpr std::uint32_t kKnownCommands = Command::kArm | Command::kStop | Command::kReset;
inline constexpr std::uint32_t kKnownJoints = (1u << kMaxJoints) - 1;

// Whether a joint command is one a host may send: fractions, finite positions, known joints. Whether a position lies
// within its joint's limits only the tick knows: it cuts to them (Status::kJointLimited).
inline bool is_valid(const JointCommand& command) PALPATE_RT {
  for (const float closing : command.closing)  // bound: kMaxFingers
    if (!(closing >= 0.0f && closing <= 1.0f)) return false;
  for (const float target : command.target)  // bound: kMaxJoints
    if (!(target >= -10.0f && target <= 10.0f)) return false;
  return (command.direct & ~kKnownJoints) == 0 && command.reserved == 0;
}

struct MailboxRegion {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t command_words;
  std::uint64_t total_bytes;
  alignas(64) std::atomic<std::uint64_t> sequence;  // odd while the host is writing
  std::atomic<std::uint64_t> word[kCommandWords];
};
static_assert(std::is_standard_layout_v<MailboxRegion>);

// What is wrong with a region's constant part, as a static text, or nullptr.
inline const char* check_mailbox(const MailboxRegion& region) noexcept {
  if (region.magic != kMailboxMagic) return "magic";
  if (region.version != kMailboxVersion) return "version";
  if (region.command_words != kCommandWords) return "command size";
  if (region.total_bytes != sizeof(MailboxRegion)) return "total size";
  return nullptr;
}

// The host's side.
class MailboxWriter {
 public:
  // Fills the constant part of a zeroed region.
  explicit MailboxWriter(MailboxRegion& region) noexcept : region_(&region) {
    region.magic = kMailboxMagic;
    region.version = kMailboxVersion;
    region.command_words = kCommandWords;
    region.total_bytes = sizeof(MailboxRegion);
  }
  void set(std::uint32_t commands, bool quit) noexcept {
    current_.generation += 1;
    current_.commands = commands;
    current_.quit = quit ? 1 : 0;
    publish();
  }
  void set_joints(const JointCommand& joints) noexcept {
    current_.generation += 1;
    current_.joints = joints;
    publish();
  }
  void set_live(const LiveSettings& live) noexcept {
    current_.generation += 1;
    current_.live = live;
    publish();
  }
  // Together with the release of every command: what was asked of the scene before is not asked of this one.
  void set_scene(std::uint64_t number) noexcept {
    current_.generation += 1;
    current_.commands = 0;
    current_.scene = number;
    publish();
  }
  void beat() noexcept {
    current_.heartbeat += 1;
    publish();
  }

 private:
  void publish() noexcept {
    sequence_ += 2;
    // Relaxed: ordered before the words by their release stores (case B).
    region_->sequence.store(sequence_ - 1, std::memory_order_relaxed);
    const auto* bytes = reinterpret_cast<const unsigned char*>(&current_);
    for (std::size_t i = 0; i < kCommandWords; ++i) {
      std::uint64_t value;
      std::memcpy(&value, bytes + 8 * i, 8);
      // Release: pairs with the acquire load of the word in MailboxReader (case B).
      region_->word[i].store(value, std::memory_order_release);
    }
    // Release: pairs with the acquire load of `sequence` in MailboxReader (case A).
    region_->sequence.store(sequence_, std::memory_order_release);
  }

  MailboxRegion* region_;
  HostCommand current_;
  std::uint64_t sequence_ = 0;
};

enum class MailboxResult : std::int32_t {
  kAccepted = 0,  // a valid command, the newest
  kBusy = 1,      // nothing written yet, or the host was writing during both tries: the last command stands
  kInvalid = 2,   // torn-free but wrong: unknown bits, a value out of range or a generation that went back
};

// The controller's side. Never blocks; reads shared memory at most twice per call.
class MailboxReader {
 public:
  MailboxReader() = default;
  explicit MailboxReader(const MailboxRegion& region) noexcept : region_(&region) {}
  bool connected() const PALPATE_RT { return region_ != nullptr; }
  // Reads the region; `command` is overwritten only by kAccepted.
  MailboxResult poll(HostCommand& command) PALPATE_RT {
    HostCommand copy;
    if (region_ == nullptr || !read(copy)) return MailboxResult::kBusy;
    if ((copy.commands & ~kKnownCommands) != 0 || copy.quit > 1) return MailboxResult::kInvalid;
    if (!is_valid(copy.joints) || !is_valid(copy.live)) return MailboxResult::kInvalid;
    if (copy.generation < generation_ || copy.scene < scene_) return MailboxResult::kInvalid;
    generation_ = copy.generation;
    scene_ = copy.scene;
    command = copy;
    return MailboxResult::kAccepted;
  }

 private:
  static constexpr int kTries = 2;

  bool read(HostCommand& copy) const PALPATE_RT {
    for (int attempt = 0; attempt < kTries; ++attempt) {
      // Acquire: pairs with the release store of `sequence` in MailboxWriter (case A).
      const std::uint64_t before = region_->sequence.load(std::memory_order_acquire);
      if (before == 0 || (before & 1) != 0) continue;
      auto* bytes = reinterpret_cast<unsigned char*>(&copy);
      for (std::size_t i = 0; i < kCommandWords; ++i) {  // bound: kCommandWords
        // Acquire: pairs with the release store of the word (case B).
        const std::uint64_t value = region_->word[i].load(std::memory_order_acquire);
        __builtin_memcpy(bytes + 8 * i, &value, 8);
      }
      // Relaxed: the acquire loads of the words order it after them (case B).
      if (region_->sequence.load(std::memory_order_relaxed) == before) return true;
    }
    return false;
  }

  const MailboxRegion* region_ = nullptr;
  std::uint64_t generation_ = 0, scene_ = 0;
};

}  // namespace palpate
