// A contact sheet: small panels in rows, each with a caption, written as an indexed PNG that a document can carry.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "sim_host/view/raster.h"

namespace palpate::papers {

inline constexpr int kPanelWidth = 320, kPanelHeight = 230;
inline constexpr Colour kInk = colour(0x1f2933), kGrey = colour(0x5b6672), kFaint = colour(0xe3e7ec),
                        kPaper = colour(0xffffff);
inline constexpr std::array kSeries{colour(0x2f6fb2), colour(0xd1495b), colour(0x2e9e6b), colour(0x7d5ba6),
                                    colour(0xe08e2b), colour(0x22262b), colour(0x3aa6a6), colour(0x8a6d3b)};

class Sheet {
 public:
  explicit Sheet(int columns) : columns_(columns) {}
  // `panel` is kPanelWidth by kPanelHeight; a caption has two lines, the first one bold.
  void add(Canvas panel, std::string first, std::string second);
  // Throws std::runtime_error when the file cannot be written.
  void save(const std::string& path) const;

 private:
  struct Panel {
    Canvas canvas;
    std::string first, second;
  };
  int columns_;
  std::vector<Panel> panels_;
};

}  // namespace palpate::papers
