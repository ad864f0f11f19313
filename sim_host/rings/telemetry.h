// Telemetry: the one-way region through which the controller shows every tick to the host. Only the controller
// writes it; it never reads anything a reader can write, so a reader that is slow, stopped, killed or hostile can
// lose only its own records.
//
// Two views of the same records:
//   snapshot  the newest record, under a version counter (a sequence lock);
//   ring      the last kTelemetryCapacity records; record n lies in slot n % capacity and is overwritten by
//             n + capacity, whether anyone has read it or not.
//
// Payloads are 64-bit atomic words, so that a copy torn by the writer is a detected event and not a data race. There
// are no fences: ThreadSanitizer in gcc 12 does not model them. Each data word is instead stored with release and
// loaded with acquire, which on x86-64 compiles to the same plain moves as relaxed words with fences, and on AArch64 to
// stlr and ldar.
//
// Interleaving that must be caught (version of the snapshot, or sequence of a slot; w = data words):
//
//   writer                              reader
//   version = odd        (relaxed)
//                                       v1 = version            (acquire)   odd: give up this try
//   w[i] = new           (release)
//                                       copy w[i]               (acquire)
//   version = even       (release)
//                                       v2 = version            (relaxed)   v1 != v2: torn, give up this try
//
//   A. The reader sees v1 even (release/acquire pair on version): every word of that version is visible to it.
//   B. It then copies a word of a *later* write: that word's release store is ordered after the odd version, and the
//      reader's acquire load makes the odd version visible before v2 is loaded. So v2 >= odd > v1: torn is detected.
//   C. Neither: all words are of version v1, and v2 == v1.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "rt_core/record.h"

namespace palpate {

inline constexpr std::uint64_t kTelemetryMagic = 0x3130544C4554504Cull;  // bytes "LPTELT01"
inline constexpr std::uint32_t kTelemetryVersion = 4;
// Slots of the ring: 4 s at 1 kHz, so an ordinary process under load does not lose records. Overflow: the oldest
// record is overwritten and the reader counts it as lost.
inline constexpr std::uint64_t kTelemetryCapacity = 4096;
inline constexpr std::size_t kRecordWords = sizeof(TickRecord) / 8;
inline constexpr std::size_t kBuildIdBytes = 256;
inline constexpr std::size_t kImagePathBytes = 1024;
inline constexpr std::size_t kSchemaBytes = 24 * 1024;  // of the text, and room for more; a test holds it

static_assert(sizeof(TickRecord) % 8 == 0);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free, "words shared between processes must not hide a lock");
static_assert(sizeof(std::atomic<std::uint64_t>) == 8);
static_assert((kTelemetryCapacity & (kTelemetryCapacity - 1)) == 0, "the slot index must stay right when n wraps");

// Hash of the memory layout of everything telemetry and recordings carry: two builds that disagree about one size or
// offset have different hashes. FNV-1a over the sizes and offsets.
constexpr std::uint64_t record_layout_hash() noexcept {
  const std::uint64_t facts[] = {sizeof(TickRecord),
                                 offsetof(TickRecord, tick),
                                 offsetof(TickRecord, state_hash),
                                 offsetof(TickRecord, timing),
                                 offsetof(TickRecord, input),
                                 offsetof(TickRecord, output),
                                 offsetof(TickRecord, high_water),
                                 offsetof(TickRecord, region_count),
                                 offsetof(TickRecord, region),
                                 sizeof(RegionRecord),
                                 offsetof(RegionRecord, centre_w),
                                 offsetof(RegionRecord, force_w),
                                 offsetof(RegionRecord, normal_w),
                                 offsetof(RegionRecord, depth_equivalent_m),
                                 offsetof(RegionRecord, friction),
                                 sizeof(TickTiming),
                                 offsetof(TickTiming, stage_ns),
                                 sizeof(Input),
                                 offsetof(Input, stale_ticks),
                                 offsetof(Input, commands),
                                 offsetof(Input, device_fault),
                                 offsetof(Input, overrun_ticks),
                                 offsetof(Input, buttons),
                                 offsetof(Input, drive),
                                 offsetof(Input, joints),
                                 sizeof(JointCommand),
                                 offsetof(Input, live),
                                 sizeof(LiveSettings),
                                 offsetof(Input, second_w),
                                 sizeof(Output),
                                 offsetof(Output, contact_w),
                                 offsetof(Output, tool_w),
                                 offsetof(Output, penetration_m),
                                 offsetof(Output, energy_J),
                                 offsetof(Output, surplus_J),
                                 offsetof(Output, ramp),
                                 offsetof(Output, status),
                                 offsetof(Output, fault),
                                 offsetof(Output, mode),
                                 offsetof(Output, palm_w),
                                 offsetof(Output, second_w),
                                 state_layout_hash(),
                                 kMaxRegions,
                                 kStageCount};
  std::uint64_t hash = kLayoutSeed;
  for (const std::uint64_t fact : facts) hash = layout_with(hash, fact);
  return hash;
}
inline constexpr std::uint64_t kRecordLayoutHash = record_layout_hash();

// Written once, before the region is shared; never changes afterwards. The first three keep their places in every
// version, so that a reader that knows nothing else finds the schema.
struct TelemetryHeader {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t schema_bytes;   // of the text, without its end; 0: none
  std::uint64_t schema_offset;  // of the text from the region's beginning
  std::uint64_t record_words;
  std::uint64_t layout_hash;
  std::uint64_t total_bytes;
  std::uint64_t capacity;
  std::uint64_t scene_hash;          // of the image the controller renders
  std::int64_t period_ns;            // of its loop
  char scene_name[kNameBytes];       // zero-terminated
  char build_id[kBuildIdBytes];      // zero-terminated
  char image_path[kImagePathBytes];  // zero-terminated
};

// A scene that the run went over to; the header has the one it began with. Never changes once first_sequence is set.
inline constexpr std::size_t kMostLaterScenes = 16;
struct TelemetryScene {
  std::atomic<std::uint64_t> first_sequence;  // of its first record; 0: not yet
  std::uint64_t scene_hash;
  char scene_name[kNameBytes];
  char image_path[kImagePathBytes];
};

struct TelemetryRegion {
  TelemetryHeader header;
  alignas(64) std::atomic<std::uint64_t> newest;            // sequence of the newest complete record, 0: none yet
  alignas(64) std::atomic<std::uint64_t> snapshot_version;  // odd while the snapshot is being written
  std::atomic<std::uint64_t> snapshot[kRecordWords];
  struct alignas(64) Slot {
    std::atomic<std::uint64_t> sequence;  // of the record inside; 0: being written, or never written
    std::atomic<std::uint64_t> word[kRecordWords];
  } slot[kTelemetryCapacity];
  TelemetryScene later_scene[kMostLaterScenes];
  char schema[kSchemaBytes];  // what lies where, in JSON (telemetry_schema.h); before the region is shared, too
};
static_assert(std::is_standard_layout_v<TelemetryRegion>);

// What is wrong with a header, as a static text, or nullptr when this build can read the region.
inline const char* check_telemetry(const TelemetryRegion& region) noexcept {
  const TelemetryHeader& header = region.header;
  if (header.magic != kTelemetryMagic) return "magic";
  if (header.version != kTelemetryVersion) return "version";
  if (header.layout_hash != kRecordLayoutHash) return "layout hash";
  if (header.record_words != kRecordWords) return "record size";
  if (header.capacity != kTelemetryCapacity) return "capacity";
  if (header.total_bytes != sizeof(TelemetryRegion)) return "total size";
  return nullptr;
}

// The scene that the newest records are of: null: the header's.
inline const TelemetryScene* newest_scene(const TelemetryRegion& region) noexcept {
  const TelemetryScene* newest = nullptr;
  for (const TelemetryScene& scene : region.later_scene)
    if (scene.first_sequence.load(std::memory_order_acquire) != 0) newest = &scene;
  return newest;
}

// The controller's side. `write` is wait-free: a fixed number of plain stores.
class TelemetryWriter {
 public:
  TelemetryWriter() = default;
  // Fills the header of a zeroed region. Texts longer than their field are cut.
  void open(TelemetryRegion& region, const Model& model, std::int64_t period_ns, const char* build_id,
            const char* image_path) noexcept {
    region_ = &region;
    sequence_ = 0;
    TelemetryHeader& header = region.header;
    header.magic = kTelemetryMagic;
    header.version = kTelemetryVersion;
    header.schema_offset = offsetof(TelemetryRegion, schema);
    header.record_words = kRecordWords;
    header.layout_hash = kRecordLayoutHash;
    header.total_bytes = sizeof(TelemetryRegion);
    header.capacity = kTelemetryCapacity;
    header.scene_hash = model.scene_hash;
    header.period_ns = period_ns;
    copy_text(header.scene_name, model.name);
    copy_text(header.build_id, build_id);
    copy_text(header.image_path, image_path);
  }
  // By an ordinary thread, before the loop may take it up: what is known of the run's later scene `number`, 1...
  void announce_scene(std::uint64_t number, const Model& model, const char* image_path) noexcept {
    TelemetryScene& scene = region_->later_scene[number - 1];
    scene.scene_hash = model.scene_hash;
    copy_text(scene.scene_name, model.name);
    copy_text(scene.image_path, image_path);
  }
  // The next record is the first of later scene `number`, 1 to kMostLaterScenes.
  void begin_scene(std::uint64_t number) PALPATE_RT {
    // Release: with it the texts become visible; pairs with the acquire load in newest_scene().
    region_->later_scene[number - 1].first_sequence.store(sequence_ + 1, std::memory_order_release);
  }
  // Publishes one record under the next sequence number 1, 2, 3..., whatever record.sequence says. Not before open().
  void write(const TickRecord& record) PALPATE_RT {
    sequence_ += 1;
    TelemetryRegion::Slot& slot = region_->slot[sequence_ % kTelemetryCapacity];
    // Relaxed: ordered before the data words by *their* release stores (case B above).
    slot.sequence.store(0, std::memory_order_relaxed);
    store_words(slot.word, record);
    // Release: pairs with the acquire load of slot.sequence in the reader (case A).
    slot.sequence.store(sequence_, std::memory_order_release);
    // Release: pairs with the acquire load of `newest`, so a reader that sees n also sees slot n complete.
    region_->newest.store(sequence_, std::memory_order_release);
    // Relaxed: as for slot.sequence. Odd marks "being written".
    region_->snapshot_version.store(2 * sequence_ - 1, std::memory_order_relaxed);
    store_words(region_->snapshot, record);
    // Release: pairs with the acquire load of snapshot_version in the reader (case A).
    region_->snapshot_version.store(2 * sequence_, std::memory_order_release);
  }
  std::uint64_t sequence() const PALPATE_RT { return sequence_; }

 private:
  template <std::size_t N>
  static void copy_text(char (&to)[N], const char* from) noexcept {
    std::size_t i = 0;
    for (; i + 1 < N && from[i] != '\0'; ++i) to[i] = from[i];
    for (; i < N; ++i) to[i] = '\0';
  }
  void store_words(std::atomic<std::uint64_t> (&word)[kRecordWords], const TickRecord& record) const PALPATE_RT {
    const auto* bytes = reinterpret_cast<const unsigned char*>(&record);
    static_assert(offsetof(TickRecord, sequence) == 0, "word 0 is the sequence");
    word[0].store(sequence_, std::memory_order_release);  // as below
    for (std::size_t i = 1; i < kRecordWords; ++i) {      // bound: kRecordWords
      std::uint64_t value;
      __builtin_memcpy(&value, bytes + 8 * i, 8);
      // Release: keeps the "being written" mark before the data; pairs with the acquire load in load_words (case B).
      word[i].store(value, std::memory_order_release);
    }
  }

  TelemetryRegion* region_ = nullptr;
  std::uint64_t sequence_ = 0;
};

// The host's side. Works on a read-only mapping whose size has been checked; nothing the writer puts there, right or
// hostile, makes it read outside the region, loop for ever or crash. Field values are the writer's own: check counts
// before using them as indices.
class TelemetryReader {
 public:
  explicit TelemetryReader(const TelemetryRegion& region) noexcept : region_(&region) {}
  // Copies the next record in order and returns true; false when there is none yet. Records overwritten before they
  // were read are skipped and counted in lost(). Bounded tries: a writer that laps the reader cannot trap it.
  bool next(TickRecord& record) noexcept {
    for (int attempt = 0; attempt < kTries; ++attempt) {
      // Acquire: pairs with the release store of `newest`.
      const std::uint64_t newest = region_->newest.load(std::memory_order_acquire);
      if (newest < next_) return false;  // nothing new, or a counter that ran backwards: not believed
      if (newest - next_ > kTelemetryCapacity - kGuard) skip_to(newest - (kTelemetryCapacity - kGuard));
      const TelemetryRegion::Slot& slot = region_->slot[next_ % kTelemetryCapacity];
      // Acquire: pairs with the release store of slot.sequence (case A).
      if (slot.sequence.load(std::memory_order_acquire) != next_) continue;
      load_words(slot.word, record);
      // Relaxed: the acquire loads of the words order it after them (case B).
      if (slot.sequence.load(std::memory_order_relaxed) != next_ || record.sequence != next_) continue;
      next_ += 1;
      return true;
    }
    skip_to(next_ + 1);  // it will never become readable: overwritten meanwhile, or the region is corrupt
    return false;
  }
  // Copies the newest record, whatever next() has read; false when there is none or it changed during both tries.
  bool newest(TickRecord& record) const noexcept {
    for (int attempt = 0; attempt < kTries; ++attempt) {
      // Acquire: pairs with the release store of snapshot_version (case A).
      const std::uint64_t version = region_->snapshot_version.load(std::memory_order_acquire);
      if (version == 0) return false;
      if ((version & 1) != 0) continue;
      load_words(region_->snapshot, record);
      // Relaxed: the acquire loads of the words order it after them (case B).
      if (region_->snapshot_version.load(std::memory_order_relaxed) == version) return true;
    }
    return false;
  }
  // Records the writer published and this reader did not get, so far.
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  static constexpr int kTries = 8;
  // The reader keeps this far from the slot the writer overwrites next.
  static constexpr std::uint64_t kGuard = 64;

  void skip_to(std::uint64_t sequence) noexcept {
    lost_ += sequence - next_;
    next_ = sequence;
  }
  static void load_words(const std::atomic<std::uint64_t> (&word)[kRecordWords], TickRecord& record) noexcept {
    auto* bytes = reinterpret_cast<unsigned char*>(&record);
    for (std::size_t i = 0; i < kRecordWords; ++i) {
      // Acquire: pairs with the release store in store_words (case B).
      const std::uint64_t value = word[i].load(std::memory_order_acquire);
      std::memcpy(bytes + 8 * i, &value, 8);
    }
  }

  const TelemetryRegion* region_;
  std::uint64_t next_ = 1;
  std::uint64_t lost_ = 0;
};

}  // namespace palpate
