#include "sim_host/viewer/timeline.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim_host/viewer/panels.h"
#include "sim_host/viewer/plots.h"

namespace palpate {

namespace {

Colour colour_of(TrackEvent::Kind kind) {
  switch (kind) {
    case TrackEvent::Kind::kFault:
      return theme::kFault;
    case TrackEvent::Kind::kWarning:
    case TrackEvent::Kind::kGap:
      return theme::kWarning;
    case TrackEvent::Kind::kMode:
      return theme::kFelt;
    case TrackEvent::Kind::kTouch:
    case TrackEvent::Kind::kLetGo:
      return theme::kForce;
  }
  return theme::kGrey;
}

struct Bar {
  ImVec2 low, high;
  TimelineSpan span;
  float x_of(double time_s) const {
    const double share = (time_s - span.first_s) / (span.last_s - span.first_s);
    return low.x + static_cast<float>(share) * (high.x - low.x);
  }
  double time_at(float x) const {
    return span.first_s + static_cast<double>((x - low.x) / (high.x - low.x)) * (span.last_s - span.first_s);
  }
};

// Marks with the texts that have room; the others say theirs under the mouse.
void event_marks(const Bar& bar, const TimelineRun& run, bool below) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float size = 0.82f * ImGui::GetFontSize();
  const float text_y = below ? bar.high.y + 0.1f * size : bar.low.y - 1.15f * size;
  float free_from = bar.low.x;
  for (const TrackEvent& event : run.track->events()) {
    const float x = bar.x_of(run.track->time_s(event.index) - run.zero_s);
    const Colour c = colour_of(event.kind);
    const float middle = 0.5f * (bar.low.y + bar.high.y);
    list->AddLine({x, below ? middle : bar.low.y}, {x, bar.high.y}, packed(c, 0.9f), 1.6f);
    const float width = ImGui::GetFont()->CalcTextSizeA(size, 1e9f, 0, event.text.c_str()).x;
    if (x >= free_from && x + width + 6 < bar.high.x) {
      list->AddText(ImGui::GetFont(), size, {x + 3, text_y}, packed(c), event.text.c_str());
      free_from = x + width + 12;
    }
    const ImVec2 low{x - 3, below ? bar.high.y : bar.low.y - size}, high{x + 3, below ? bar.high.y + size : bar.high.y};
    if (ImGui::IsMouseHoveringRect(low, high)) ImGui::SetTooltip("%s", event.text.c_str());
  }
}

void play_buttons(ImVec2 low, float middle, const TimelineSpan& span, Player& player) {
  const float line = ImGui::GetFontSize();
  ImGui::SetCursorScreenPos({low.x + line, middle - 0.8f * line});
  if (ImGui::Button(player.playing || player.live ? "Pause" : "Play", {4 * line, 1.6f * line})) {
    if (player.live)
      player.live = player.playing = false;
    else
      player.toggle(span.first_s, span.last_s);
  }
  ImGui::SetCursorScreenPos({low.x + 5.5f * line, middle - 0.8f * line});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.5f * line, 0.3f * line});
  ImGui::SetNextItemWidth(4.4f * line);
  const double speeds[] = {0.05, 0.1, 0.25, 0.5, 1, 2};
  if (ImGui::BeginCombo("##speed", fmt::format("x {:g}", player.speed).c_str(), ImGuiComboFlags_NoArrowButton)) {
    for (const double speed : speeds)
      if (ImGui::Selectable(fmt::format("x {:g}", speed).c_str(), speed == player.speed)) player.speed = speed;
    ImGui::EndCombo();
  }
  ImGui::PopStyleVar();
  ImGui::SetCursorScreenPos({low.x + 10.6f * line, middle - 0.5f * line});
  ImGui::TextUnformatted(fmt::format("{:.3f} s", player.time_s()).c_str());
}

void scrub_bar(const Bar& bar, Player& player) {
  const float line = ImGui::GetFontSize();
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(bar.low, bar.high, packed(theme::kWell), 3);
  list->AddRectFilled(bar.low, {bar.x_of(player.time_s()), bar.high.y}, packed(theme::kLine), 3);
  ImGui::SetCursorScreenPos({bar.low.x, bar.low.y - 0.3f * line});
  ImGui::InvisibleButton("##scrub", {bar.high.x - bar.low.x, bar.high.y - bar.low.y + 0.6f * line});
  if (!ImGui::IsItemActive()) return;
  player.playing = player.live = false;
  player.seek(bar.time_at(ImGui::GetIO().MousePos.x), bar.span.first_s, bar.span.last_s);
}

}  // namespace

void timeline(ImVec2 low, ImVec2 size, std::span<const TimelineRun> runs, const TimelineSpan& span, Player& player) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("timeline", nullptr, kPanelFlags);
  const float line = ImGui::GetFontSize(), middle = low.y + 0.56f * size.y;
  const float right = low.x + size.x - (span.is_live ? 6.0f : 5.5f) * line;
  Bar bar{{low.x + 15.5f * line, middle - 0.35f * line}, {right, middle + 0.35f * line}, span};
  bar.span.last_s = std::max(span.first_s + 1e-3, span.last_s);
  play_buttons(low, middle, span, player);
  scrub_bar(bar, player);
  for (std::size_t i = 0; i < runs.size(); ++i) event_marks(bar, runs[i], i > 0);
  ImGui::GetWindowDrawList()->AddCircleFilled({bar.x_of(player.time_s()), middle}, 0.42f * line, packed(theme::kInk));
  ImGui::SetCursorScreenPos({right + 0.8f * line, middle - 0.8f * line});
  if (span.is_live && ImGui::Button("Live", {4 * line, 1.6f * line})) player.live = true;
  if (!span.is_live) {
    ImGui::SetCursorScreenPos({right + 0.8f * line, middle - 0.5f * line});
    ImGui::TextColored(colour_vector(theme::kGrey), "%.2f s", bar.span.last_s);
  }
  ImGui::End();
}

}  // namespace palpate
