// The tick in a program of one's own: a baked image, no device, no host. A tool moves 22 mm down and up again.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include "rt_core/palpate_core.h"

using namespace palpate;
using Block = std::unique_ptr<std::byte, void (*)(void*)>;
Block block_of(std::size_t bytes) {
  return {static_cast<std::byte*>(std::aligned_alloc(kImageAlignment, bytes)), std::free};
}

int main(int argc, char** argv) {
  if (argc != 2) return std::puts("usage: embed_tick IMAGE.pal"), 2;
  const std::size_t bytes = std::filesystem::file_size(argv[1]);
  const Block image = block_of((bytes + kImageAlignment - 1) / kImageAlignment * kImageAlignment);
  std::ifstream(argv[1], std::ios::binary)
      .read(reinterpret_cast<char*>(image.get()), static_cast<std::streamsize>(bytes));
  Model model;
  if (const ImageResult result = open_image({image.get(), bytes}, model); result.error != ImageError::kNone) {
    return std::printf("%s: %s\n", describe(result.error), result.field), 1;
  }
  // All the memory there will ever be; nothing below allocates, waits or throws.
  const Block state_block = block_of(state_bytes(model)), scratch_block = block_of(scratch_bytes(model));
  State& state = create_state(model, state_block.get());
  Scratch& scratch = create_scratch(model, scratch_block.get());
  Input input;
  Output output;
  input.drive = Drive::kTool;
  double peak_N = 0;
  for (int i = 0; i < 2000; ++i) {
    input.pose_w.position_m = {-0.010, 0.090 - 0.022 * (i < 1000 ? i : 2000 - i) / 1000, 0};
    tick(model, state, scratch, input, output);
    peak_N = output.contact_w.force_N.y > peak_N ? output.contact_w.force_N.y : peak_N;
  }
  std::printf("%s: at most %.3f N, at the end %.3f N\n", model.name, peak_N, output.contact_w.force_N.y);
}
