#include "sim_host/viewer/comparison_panel.h"

#include <fmt/format.h>

#include <cmath>

#include "sim_host/viewer/panels.h"
#include "sim_host/viewer/plots.h"

namespace palpate {

namespace {

void plots(const Comparison& comparison, double now_s, ImVec2 size) {
  const float gap = 1.2f * ImGui::GetTextLineHeight();
  const auto columns = static_cast<std::size_t>(std::max(50.0f, 0.5f * size.x));
  const double from_s = comparison.first_s(), until_s = std::max(from_s + 0.1, comparison.last_s());
  std::array<TrackColumns, Comparison::kRuns> data;
  for (std::size_t run = 0; run < Comparison::kRuns; ++run)
    data[run] = comparison.columns(run, from_s, until_s, columns);
  // They cover one another when the runs are the same: the first lies below, broad.
  const auto plot = [&](const char* title, const char* unit, auto member) {
    const PlotLine lines[] = {{kRunLetter[0], kRunColour[0], data[0].*member, 3.2f},
                              {kRunLetter[1], kRunColour[1], data[1].*member}};
    ImGui::BeginChild(title, {0.5f * (size.x - gap), size.y});
    history_plot(title, unit, lines, from_s, until_s, now_s, size.y);
    ImGui::EndChild();
  };
  plot("Force on the tool", "N", &TrackColumns::contact_N);
  ImGui::SameLine(0, gap);
  plot("Depth", "mm", &TrackColumns::depth_mm);
}

struct Row {
  const char* name;
  std::array<double, Comparison::kRuns> value;
};

void cell(Colour c, const std::string& text) {
  ImGui::TableNextColumn();
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x);
  ImGui::TextColored(colour_vector(c), "%s", text.c_str());
}

void numbers(const Comparison& comparison, double now_s) {
  std::array<TrackTick, Comparison::kRuns> tick;
  for (std::size_t run = 0; run < Comparison::kRuns; ++run)
    tick[run] = comparison.track(run).at(comparison.index_at(run, now_s));
  const Row rows[] = {{"force on the tool (N)", {norm(tick[0].contact_N), norm(tick[1].contact_N)}},
                      {"force felt (N)", {norm(tick[0].device_N), norm(tick[1].device_N)}},
                      {"depth (mm)", {1e3 * std::max(0.0, tick[0].depth_m), 1e3 * std::max(0.0, tick[1].depth_m)}},
                      {"stored energy (mJ)", {1e3 * tick[0].energy_J, 1e3 * tick[1].energy_J}},
                      {"its own time (s)", {now_s + comparison.zero_s(0), now_s + comparison.zero_s(1)}}};
  if (!ImGui::BeginTable("both", 4, ImGuiTableFlags_SizingStretchProp)) return;
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  cell(kRunColour[0], kRunLetter[0]);
  cell(kRunColour[1], kRunLetter[1]);
  cell(theme::kGrey, "B - A");
  for (const Row& row : rows) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(colour_vector(theme::kGrey), "%s", row.name);
    for (std::size_t run = 0; run < Comparison::kRuns; ++run)
      cell(theme::kInk, comparison.is_there(run, now_s) ? fmt::format("{:.3f}", row.value[run]) : "none");
    const bool both = comparison.is_there(0, now_s) && comparison.is_there(1, now_s);
    cell(theme::kInk, both ? fmt::format("{:+.3f}", row.value[1] - row.value[0]) : "");
  }
  ImGui::EndTable();
}

// What holds of the whole of both. Short lines: a break may fall after any dot.
void words(const Comparison& comparison) {
  const Comparison::Difference& apart = comparison.difference();
  wrapped(theme::kGrey, comparison.alignment() == Alignment::kTime
                            ? std::string("Aligned by time: both at their own zero.")
                            : fmt::format("Aligned by first touch: A at {:.3f} s, B at {:.3f} s.", comparison.zero_s(0),
                                          comparison.zero_s(1)));
  const double a_ms = 1e3 * comparison.track(0).period_s(), b_ms = 1e3 * comparison.track(1).period_s();
  if (std::abs(a_ms - b_ms) > 1e-9 * a_ms)
    wrapped(theme::kGrey, fmt::format("A ticks every {:g} ms, B every {:g} ms.", a_ms, b_ms));
  if (apart.ticks == 0) return wrapped(theme::kGrey, "There is no time at which both render force.");
  wrapped(theme::kGrey, "Apart, while both render force:");
  wrapped(theme::kInk, fmt::format("forces {:.3g} N rms, {:.3g} N at most ({:.3f} s)", apart.rms_N, apart.largest_N,
                                   apart.largest_at_s));
  wrapped(theme::kInk, fmt::format("depths {:.3g} mm rms, {:.3g} mm at most", apart.rms_mm, apart.largest_mm));
}

}  // namespace

void comparison_panel(ImVec2 low, ImVec2 size, const Comparison& comparison, double now_s) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("comparison", nullptr, kPanelFlags);
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float table = std::min(24 * line, 0.36f * room.x);
  plots(comparison, now_s, {room.x - table - 1.5f * line, room.y});
  ImGui::SameLine(0, 1.5f * line);
  ImGui::BeginChild("numbers", {table, room.y});
  numbers(comparison, now_s);
  ImGui::Spacing();
  words(comparison);
  ImGui::EndChild();
  ImGui::End();
}

}  // namespace palpate
