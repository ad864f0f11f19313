// Moving pictures: every frame comes back as it was drawn, from a file that other programs read; a run is shown from
// its first touch to its last; what cannot be shown is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "rt_core/tick.h"
#include "sim_host/record/mapped_file.h"
#include "sim_host/record/recording_writer.h"
#include "sim_host/tick_memory.h"
#include "sim_host/view/apng_file.h"
#include "sim_host/view/movie.h"
#include "tests/host/tiny_run.h"
#include "tests/support/refusal.h"
#include "tests/support/tiny_image.h"

namespace palpate {
namespace {

using testing::HasSubstr;
using Rgb = std::vector<std::uint8_t>;

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name)).string();
}

struct Chunk {
  std::string type;
  std::string data;
};
std::uint32_t number(const std::string& bytes, std::size_t at, int size = 4) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i)
    value = value << 8 | static_cast<std::uint8_t>(bytes[at + static_cast<std::size_t>(i)]);
  return value;
}
std::string big_endian(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}
std::uint32_t checksum(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}
std::string chunk_bytes(const Chunk& chunk) {
  return big_endian(static_cast<std::uint32_t>(chunk.data.size())) + chunk.type + chunk.data +
         big_endian(checksum(chunk.type + chunk.data));
}

// Reads an animated PNG by the standard's words: chunks with their checksums, and each frame's rows through libpng.
class ApngReader {
 public:
  explicit ApngReader(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string all((std::istreambuf_iterator<char>(file)), {});
    signature_ = all.substr(0, 8);
    for (std::size_t at = 8; at + 12 <= all.size();) {
      const std::size_t length = number(all, at);
      const Chunk chunk{all.substr(at + 4, 4), all.substr(at + 8, length)};
      EXPECT_EQ(number(all, at + 8 + length), checksum(chunk.type + chunk.data)) << chunk.type;
      chunks.push_back(chunk);
      at += 12 + length;
    }
  }

  std::vector<Rgb> frames() const {
    std::vector<Rgb> frames;
    const std::string& header = chunks.at(0).data;
    const std::uint32_t width = number(header, 0);
    Rgb canvas(std::size_t{3} * width * number(header, 4));
    std::uint32_t sequence = 0;
    std::string control;
    for (const Chunk& chunk : chunks) {
      if (chunk.type == "fcTL") {
        EXPECT_EQ(number(chunk.data, 0), sequence++);
        control = chunk.data;
      }
      if (chunk.type == "fdAT") {
        EXPECT_EQ(number(chunk.data, 0), sequence++);
      }
      if (chunk.type != "IDAT" && chunk.type != "fdAT") continue;
      const std::uint32_t w = number(control, 4), h = number(control, 8), x = number(control, 12),
                          y = number(control, 16);
      const Rgb part = rows(header, w, h, chunk.type == "IDAT" ? chunk.data : chunk.data.substr(4));
      for (std::uint32_t row = 0; row < h; ++row)
        std::copy_n(part.begin() + std::ptrdiff_t{3} * w * row, 3 * w,
                    canvas.begin() + std::ptrdiff_t{3} * ((y + row) * width + x));
      frames.push_back(canvas);
    }
    return frames;
  }

  std::vector<Chunk> chunks;

 private:
  Rgb rows(std::string header, std::uint32_t width, std::uint32_t height, const std::string& data) const {
    header.replace(0, 8, big_endian(width) + big_endian(height));
    const std::string png =
        signature_ + chunk_bytes({"IHDR", header}) + chunk_bytes({"IDAT", data}) + chunk_bytes({"IEND", ""});
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_NE(png_image_begin_read_from_memory(&image, png.data(), png.size()), 0) << image.message;
    image.format = PNG_FORMAT_RGB;
    Rgb rgb(PNG_IMAGE_SIZE(image));
    EXPECT_NE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr), 0) << image.message;
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    return rgb;
  }
  std::string signature_;
};

TEST(Apng, EveryFrameComesBack) {
  constexpr int kWidth = 37, kHeight = 23;
  std::mt19937 random(7);
  Rgb frame(std::size_t{3} * kWidth * kHeight);
  for (auto& byte : frame) byte = static_cast<std::uint8_t>(random());
  std::vector<Rgb> drawn{frame, frame};  // the second is the first again
  for (const std::size_t changed : {std::size_t{0}, frame.size() / 2, frame.size() - 1}) {
    drawn.push_back(drawn.back());
    drawn.back()[changed] ^= 0x55;
  }
  for (auto& byte : frame) byte = static_cast<std::uint8_t>(random());
  drawn.push_back(frame);
  const std::string path = temporary("_frames.png");
  ApngFile file(path, kWidth, kHeight, static_cast<int>(drawn.size()), 25);
  for (const Rgb& rgb : drawn) file.add(rgb);
  EXPECT_THROW(file.add(frame), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path)) << "not before it is complete";
  file.finish();
  const ApngReader reader(path);
  EXPECT_EQ(number(reader.chunks.at(1).data, 0), drawn.size());
  EXPECT_EQ(reader.frames(), drawn);
  EXPECT_EQ(reader.chunks.back().type, "IEND");
  std::filesystem::remove(path);
}

TEST(Apng, RefusesWhatWasNotAnnounced) {
  const std::string path = temporary("_refused.png");
  {
    ApngFile file(path, 4, 4, 2, 10);
    EXPECT_THROW(file.add(Rgb(3)), std::runtime_error);
    file.add(Rgb(48));
    EXPECT_THROW(file.finish(), std::runtime_error);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  std::filesystem::remove(path + kPartSuffix);
}

class MovieOfARun : public testing::Test {
 protected:
  static constexpr std::uint64_t kTicks = 1200;
  MovieOfARun() {
    EXPECT_EQ(open_image(image_.bytes(), model_).error, ImageError::kNone);
    const StatePtr initial = make_state(model_);
    RecordingHeader header;
    header.scene_hash = model_.scene_hash;
    header.period_ns = 1'000'000;
    std::strcpy(header.scene_name, "tiny");
    std::strcpy(header.image_path, "tiny.pal");
    RecordingWriter writer(run_, header, *initial);
    const StatePtr state = copy_of(*initial);
    test::play_tiny_run(model_, *state, kTicks, [&](const TickRecord& record) {
      if (record.output.regions > 0) {
        last_touch_s_ = 1e-3 * static_cast<double>(record.tick);
        if (first_touch_s_ < 0) first_touch_s_ = last_touch_s_;
      }
      writer.add(record);
    });
    writer.finish();
  }
  ~MovieOfARun() override {
    std::filesystem::remove(run_);
    std::filesystem::remove(movie_);
  }
  MovieMade make(const MovieOptions& options) {
    const MappedFile file(run_);
    return save_movie(movie_, file.bytes(), model_, options, {});
  }
  std::string refusal(const MovieOptions& options) {
    return test::refusal_by<std::runtime_error>([&] { make(options); });
  }

  const std::string run_ = temporary("_movie.plr"), movie_ = temporary("_movie.png");
  test::ImageBytes image_ = test::tiny_image();
  Model model_;
  double first_touch_s_ = -1, last_touch_s_ = -1;
};

TEST_F(MovieOfARun, ShowsItFromTheFirstTouchToTheLast) {
  ASSERT_GT(first_touch_s_, 0);
  MovieOptions options;
  options.width = 240;
  options.height = 180;
  options.per_second = 10;
  const MovieMade made = make(options);
  EXPECT_NEAR(made.from_s, std::max(0.0, first_touch_s_ - 0.25), 1e-9);
  EXPECT_LE(made.to_s, last_touch_s_ + 0.25 + 1e-9);
  EXPECT_EQ(made.frames, static_cast<int>((made.to_s - made.from_s) * 10) + 1);
  const std::vector<Rgb> frames = ApngReader(movie_).frames();
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(made.frames));
  EXPECT_NE(frames.front(), frames[frames.size() / 2]) << "the tool moves";
}

TEST_F(MovieOfARun, RefusesWhatItCannotShow) {
  MovieOptions late;
  late.from_s = 5;
  late.to_s = 6;
  EXPECT_THAT(refusal(late), HasSubstr("the recording holds 0 to 1.199 s"));
  MovieOptions slow;
  slow.speed = 0.01;
  slow.per_second = 60;
  EXPECT_THAT(refusal(slow), HasSubstr("more than 3000"));
  EXPECT_FALSE(std::filesystem::exists(movie_));
}

}  // namespace
}  // namespace palpate
