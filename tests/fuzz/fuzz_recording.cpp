// Recordings: whatever the reader accepts is replayed, drawn from its own image, and its state was checked.
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "rt_core/tick.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recorded_image.h"
#include "sim_host/record/recording_writer.h"
#include "sim_host/record/replay.h"
#include "sim_host/tick_memory.h"
#include "tests/fuzz/edits.h"
#include "tests/support/tiny_image.h"

using namespace palpate;

namespace {

// A short press, with the image inside.
std::vector<std::byte> valid_recording() {
  test::ImageBytes image = test::tiny_image();
  Model model;
  open_image(image.bytes(), model);
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  Output output;
  Input input;
  input.pose_w.position_m = {0.01, 0.005, 0.012};
  for (int i = 0; i < 20; ++i) {
    input.commands = i > 2 ? Command::kArm : 0;
    tick(model, *state, *scratch, input, output);
  }
  RecordingHeader header;
  header.scene_hash = model.scene_hash;
  const std::string path =
      (std::filesystem::temp_directory_path() / ("palpate_fuzz_" + std::to_string(getpid()) + ".plr")).string();
  {
    RecordingWriter writer(PartFile(path, WhenItExists::kReplace), header, block_of(*state), pack_image(image.bytes()));
    for (std::uint64_t i = 1; i <= 4; ++i) {
      tick(model, *state, *scratch, input, output);
      TickRecord record{};
      fill_record(*state, input, output, record);
      record.sequence = i;
      writer.add(record);
    }
    writer.finish();
  }
  const MappedFile file(path);
  std::filesystem::remove(path);
  return {file.bytes().begin(), file.bytes().end()};
}

// Puts the checksums of every chunk right, and the header's of the state, as far as the sizes lead.
void seal(std::span<std::byte> bytes) {
  plr::Prefix prefix{plr::kMagic, plr::kVersion, 0};
  prefix.crc = plr::crc32(&prefix, offsetof(plr::Prefix, crc));
  std::memcpy(bytes.data(), &prefix, sizeof(prefix));
  const std::size_t head = sizeof(prefix) + sizeof(plr::ChunkHeader);
  const std::size_t state = head + sizeof(RecordingHeader) + sizeof(plr::ChunkHeader);
  plr::ChunkHeader state_chunk;
  std::memcpy(&state_chunk, bytes.data() + state - sizeof(state_chunk), sizeof(state_chunk));
  if (state_chunk.bytes > bytes.size() - state) return;
  const std::uint64_t state_hash = plr::crc32(bytes.data() + state, state_chunk.bytes);
  std::memcpy(bytes.data() + head + offsetof(RecordingHeader, initial_state_hash), &state_hash, sizeof(state_hash));
  const std::uint64_t layout = kRecordLayoutHash;
  std::memcpy(bytes.data() + head + offsetof(RecordingHeader, layout_hash), &layout, sizeof(layout));
  for (std::size_t at = sizeof(prefix); at + sizeof(plr::ChunkHeader) <= bytes.size();) {
    plr::ChunkHeader chunk;
    std::memcpy(&chunk, bytes.data() + at, sizeof(chunk));
    if (chunk.bytes > bytes.size() - at - sizeof(chunk)) return;
    chunk.crc =
        plr::crc32(bytes.data() + at + sizeof(chunk), chunk.bytes, plr::crc32(&chunk, offsetof(plr::ChunkHeader, crc)));
    std::memcpy(bytes.data() + at, &chunk, sizeof(chunk));
    at += sizeof(chunk) + chunk.bytes;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<std::byte> valid = valid_recording();
  std::vector<std::byte> bytes = valid;
  fuzz::apply_all(data, size, bytes);
  if (size % 2 == 0) seal(bytes);
  if (size % 3 == 0 && size > 0) bytes.resize(bytes.size() - data[0]);
  try {
    RecordingReader reader(bytes);
    const RecordedScene scene(reader, "");
    replay(reader, scene.model());
    RecordingReader again(bytes);
    TickRecord record;
    while (again.next(record)) {
    }
  } catch (const std::runtime_error&) {  // refused, in words
  }
  return 0;
}
