#include "tests/published/sheets/sheet.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <stdexcept>

namespace palpate::papers {

namespace {

constexpr int kGap = 14, kCaption = 36, kColours = 88, kOwnColours = 24;

using Pixel = std::array<std::uint8_t, 3>;

// Pixels of one box of the colour space, for the median cut (Heckbert 1982).
struct Box {
  std::span<std::pair<Pixel, std::size_t>> colours;  // and how often each occurs
  std::size_t pixels = 0;
  int widest = 0, range = 0;

  explicit Box(std::span<std::pair<Pixel, std::size_t>> from) : colours(from) {
    Pixel low{255, 255, 255}, high{0, 0, 0};
    for (const auto& [c, count] : colours) {
      pixels += count;
      for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], c[k]), high[k] = std::max(high[k], c[k]);
    }
    for (std::size_t k = 0; k < 3; ++k)
      if (high[k] - low[k] > range) range = high[k] - low[k], widest = static_cast<int>(k);
  }
  Pixel mean() const {
    std::array<std::size_t, 3> sum{};
    for (const auto& [c, count] : colours)
      for (std::size_t k = 0; k < 3; ++k) sum[k] += c[k] * count;
    Pixel result{};
    for (std::size_t k = 0; k < 3; ++k) result[k] = static_cast<std::uint8_t>((sum[k] + pixels / 2) / pixels);
    return result;
  }
};

struct Indexed {
  std::vector<Pixel> palette;
  std::vector<std::uint8_t> index;
};

// What occurs most often keeps its own colour, as paper, ink and a plot's lines; the rest shares by median cut.
Indexed with_palette(std::span<const std::uint8_t> rgb) {
  std::map<Pixel, std::size_t> count;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) count[{rgb[i], rgb[i + 1], rgb[i + 2]}] += 1;
  std::vector<std::pair<Pixel, std::size_t>> colours(count.begin(), count.end());
  std::ranges::sort(colours, [](const auto& a, const auto& b) { return a.second > b.second; });
  const std::size_t own = std::min<std::size_t>(kOwnColours, colours.size());
  std::vector<Box> boxes;
  const std::span all(colours);
  for (std::size_t i = 0; i < own; ++i) boxes.emplace_back(all.subspan(i, 1));
  if (own < colours.size()) boxes.emplace_back(all.subspan(own));
  while (boxes.size() < kColours) {
    const auto cut = std::ranges::max_element(boxes, {}, &Box::range);
    if (cut->range == 0) break;
    const auto k = static_cast<std::size_t>(cut->widest);
    std::ranges::sort(cut->colours, {}, [k](const auto& entry) { return entry.first[k]; });
    const std::size_t half = cut->colours.size() / 2;
    const Box upper(cut->colours.subspan(half));
    *cut = Box(cut->colours.first(half));
    boxes.push_back(upper);
  }
  Indexed image;
  std::map<Pixel, std::uint8_t> number;
  for (const Box& box : boxes) {
    for (const auto& [c, times] : box.colours) number[c] = static_cast<std::uint8_t>(image.palette.size());
    image.palette.push_back(box.mean());
  }
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
    image.index.push_back(number.at({rgb[i], rgb[i + 1], rgb[i + 2]}));
  return image;
}

}  // namespace

void Sheet::add(Canvas panel, std::string first, std::string second) {
  if (panel.width() != kPanelWidth || panel.height() != kPanelHeight)
    throw std::runtime_error("a panel of another size");
  panels_.push_back({std::move(panel), std::move(first), std::move(second)});
}

void Sheet::save(const std::string& path) const {
  const int rows = (static_cast<int>(panels_.size()) + columns_ - 1) / columns_;
  Canvas sheet(columns_ * kPanelWidth + (columns_ + 1) * kGap, rows * (kPanelHeight + kCaption) + (rows + 1) * kGap,
               kPaper);
  for (std::size_t i = 0; i < panels_.size(); ++i) {
    const int column = static_cast<int>(i) % columns_, row = static_cast<int>(i) / columns_;
    const int left = kGap + column * (kPanelWidth + kGap), top = kGap + row * (kPanelHeight + kCaption + kGap);
    const Panel& panel = panels_[i];
    for (int y = 0; y < kPanelHeight; ++y)
      for (int x = 0; x < kPanelWidth; ++x) sheet.set_pixel(left + x, top + y, panel.canvas.pixel(x, y));
    sheet.text(left + 2, top + kPanelHeight + 15, panel.first, 13, kInk, Align::kStart, false, true);
    sheet.text(left + 2, top + kPanelHeight + 31, panel.second, 12, kGrey);
  }
  const Indexed image = with_palette(sheet.bytes());
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(sheet.width());
  png.height = static_cast<png_uint_32>(sheet.height());
  png.format = PNG_FORMAT_RGB_COLORMAP;
  png.colormap_entries = static_cast<png_uint_32>(image.palette.size());
  if (png_image_write_to_file(&png, path.c_str(), 0, image.index.data(), 0, image.palette.data()) == 0)
    throw std::runtime_error(path + ": cannot write: " + png.message);
}

}  // namespace palpate::papers
