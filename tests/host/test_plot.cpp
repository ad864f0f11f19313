// Plots: axes, no lost peaks, well-formed SVG, and text that a raster can show.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "sim_host/view/line_plot.h"
#include "sim_host/view/plot.h"
#include "tests/host/xml_check.h"

namespace palpate {
namespace {

TEST(Plot, TicksAreRoundAndInside) {
  EXPECT_EQ(axis_ticks(0, 10, 10), (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
  EXPECT_EQ(axis_ticks(0, 1, 4), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  for (const double high : {1e-6, 0.37, 3.0, 8.5, 197.4, 12345.0}) {
    const std::vector<double> ticks = axis_ticks(-0.3 * high, high, 6);
    EXPECT_GE(ticks.size(), 4u);
    EXPECT_LE(ticks.size(), 12u);
    EXPECT_GE(ticks.front(), -0.3 * high * (1 + 1e-9));
    EXPECT_LE(ticks.back(), high * (1 + 1e-9));
  }
  EXPECT_EQ(axis_ticks(2, 2, 5), std::vector<double>{2});
  EXPECT_EQ(tick_label(-0.0), "0");
  EXPECT_EQ(tick_label(0.6000000000000001), "0.6");
}

// A one-sample spike among 100,000 must still be drawn: its height decides the picture.
TEST(Plot, KeepsTheExtremesOfLongHistories) {
  std::vector<ForceSample> samples(100'000);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].time_s = 1e-3 * static_cast<double>(i);
  samples[54'321].force_N = {0, 10, 0};
  samples[54'321].penetration_m = 2e-3;
  const std::string svg = force_history_plot(samples, "spike & <friends>").svg();
  EXPECT_EQ(test::xml_error(svg), "");
  EXPECT_NE(svg.find("spike &amp; &lt;friends&gt;"), std::string::npos);
  EXPECT_LT(svg.size(), 400'000u);  // five curves of at most four points per pixel column
  // The spike's pixel: 10 N in a panel that spans 0..10.6 N over 270 pixels from 56 down.
  const double y = 56 + 270 * (1 - 10 / 10.6);
  char expected[16];
  std::snprintf(expected, sizeof expected, ",%.2f ", y);
  EXPECT_NE(svg.find(expected), std::string::npos);
}

TEST(Plot, SurvivesDegenerateData) {
  EXPECT_EQ(test::xml_error(force_history_plot({}, "nothing").svg()), "");
  const ForceSample one[] = {{0.5, {1, 2, 3}, 1e-3, 1}};
  EXPECT_EQ(test::xml_error(force_history_plot(one, "one").svg()), "");
  const auto empty = std::make_unique<Histogram>();
  const LatencySeries series[] = {{"nothing measured", empty.get()}};
  EXPECT_EQ(test::xml_error(latency_plot(series, "empty").svg()), "");
  EXPECT_THROW(force_history_plot({}, "").save("plot.bmp"), std::runtime_error);
  EXPECT_THROW(force_history_plot({}, "").save("/nonexistent_folder/plot.svg"), std::runtime_error);
}

TEST(Plot, LatencyShowsMedianTailAndMaximum) {
  auto histogram = std::make_unique<Histogram>();
  for (std::uint64_t i = 0; i < 999; ++i) add(*histogram, 12'000, i);
  add(*histogram, 153'000, 999);
  const LatencySeries series[] = {{"wake-up latency", histogram.get()}};
  const std::string svg = latency_plot(series, "latency").svg();
  EXPECT_EQ(test::xml_error(svg), "");
  EXPECT_NE(svg.find("max 153 µs"), std::string::npos);
  EXPECT_NE(svg.find("median 12 µs"), std::string::npos);
}

double ink(const Canvas& canvas) {
  double sum = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) sum += 1 - static_cast<double>(canvas.pixel(x, y).r);
  }
  return sum;
}

TEST(LinePlot, ACurveUponAnotherIsDashed) {
  const PlotCurve first{"first", {0, 1, 2}, {0, 1, 4}}, same{"same", {0, 1, 2}, {0, 1, 4}},
      other{"other", {0, 1, 2}, {0, 2, 3}};
  const auto lines = [](const PlotCurve& a, const PlotCurve& b) {
    const std::string svg = line_plot({a, b}, {"title", "x", "y"}, false).svg();
    int count = 0;
    for (std::size_t at = svg.find("<polyline"); at != std::string::npos; at = svg.find("<polyline", at + 1)) ++count;
    return count;
  };
  EXPECT_GT(lines(first, same), lines(first, other) + 20);
}

// However long the names are, the legend ends within the page: the plot gives way.
TEST(LinePlot, LongNamesNarrowThePlot) {
  std::vector<PlotCurve> curves;
  for (int k = 0; k < 8; ++k) curves.push_back({"a_scene_with_quite_a_long_name", {0, 1}, {0, 1.0 + k}});
  const Canvas canvas = line_plot(curves, {"title", "x", "y"}, true).raster(1);
  for (int y = 0; y < canvas.height(); ++y)
    for (int x = canvas.width() - 10; x < canvas.width(); ++x) EXPECT_EQ(canvas.pixel(x, y), canvas.pixel(0, 0));
}

// Anchors have nothing between them: a bar for each value, as high as it says, and no line from one to the next.
TEST(BarPlot, BarsAreAsHighAsTheirValues) {
  const std::vector<PlotCurve> series{{"a", {1, 2, 3}, {2, 4, 1}}, {"b", {1, 2, 3}, {1, 1, 3}}};
  const std::string svg = bar_plot(series, {"title", "x", "y"}).svg();
  std::vector<double> height;
  for (std::size_t at = svg.find("<rect"); at != std::string::npos; at = svg.find("<rect", at + 1)) {
    const std::size_t value = svg.find("height=\"", at) + 8;
    height.push_back(std::stod(svg.substr(value)));
  }
  ASSERT_GE(height.size(), 6u);
  const std::vector<double> bar(height.end() - 6, height.end());
  const double wanted[] = {2, 4, 1, 1, 1, 3};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(bar[i] / bar[1], wanted[i] / 4, 0.01) << i;
}

TEST(Raster, LinesAndRectanglesCoverTheirArea) {
  Canvas canvas(200, 100, colour(0xffffff));
  canvas.rectangle(10.25, 20.5, 30.5, 9.75, colour(0));
  EXPECT_NEAR(ink(canvas), 30.5 * 9.75, 1e-3);
  Canvas line(200, 100, colour(0xffffff));
  line.polyline(Stroke{{20, 50}, {180, 50}}, 4, colour(0));
  EXPECT_NEAR(ink(line), 160 * 4 + 3.14159 * 4, 4.0);  // with round ends; 1-pixel edges blur a little
}

TEST(Raster, NothingIsDrawnOutside) {
  Canvas canvas(20, 10, colour(0xffffff));
  canvas.rectangle(-50, -50, 20, 20, colour(0));
  canvas.polyline(Stroke{{-100, -100}, {-50, 300}}, 3, colour(0));
  canvas.text(-500, 5, "far away", 12, colour(0));
  EXPECT_EQ(ink(canvas), 0);
  canvas.rectangle(-5, -5, 100, 100, colour(0));
  EXPECT_NEAR(ink(canvas), 200, 1e-3);
}

TEST(StrokeFont, EveryPrintableCharacterHasAGlyph) {
  const double box = text_width("\x7f", 20);  // outside the font
  EXPECT_GT(box, 0);
  for (const char* text :
       {"ABCDEFGHIJKLMNOPQRSTUVWXYZ", "abcdefghijklmnopqrstuvwxyz", "0123456789", "%()+-./:<=>|_,;#µ"}) {
    const std::vector<Stroke> strokes = text_strokes(text, 20);
    EXPECT_FALSE(strokes.empty());
    for (const Stroke& stroke : strokes) {
      EXPECT_GE(stroke.size(), 2u);
      for (const Point2 p : stroke) {
        EXPECT_GE(p.x, -1e-9);
        EXPECT_LE(p.x, text_width(text, 20) + 1e-9);
        EXPECT_LE(std::abs(p.y), 20);
      }
    }
  }
  EXPECT_NEAR(text_width("µm", 10), text_width("um", 10), 1e-9);  // two bytes, one character
}

}  // namespace
}  // namespace palpate
