#include "sim_host/viewer/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim_host/status_text.h"
#include "sim_host/viewer/plots.h"

namespace palpate {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

ImVec4 vec(Colour c) { return {c.r, c.g, c.b, 1}; }

void wrapped(Colour c, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, vec(c));
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

struct Headline {
  const char* text;
  Colour colour;
};
Headline headline(const TrackTick& tick) {
  switch (tick.mode) {
    case Mode::kIdle:
      return {"At rest: no force until armed", theme::kGrey};
    case Mode::kForce:
      return tick.regions > 0 ? Headline{"Rendering force: in contact", theme::kFelt}
                              : Headline{"Rendering force: free", theme::kFelt};
    case Mode::kHold:
      return {"A sample is late: force held", theme::kWarning};
    case Mode::kPassive:
      return {"Samples are missing: force fades", theme::kWarning};
    case Mode::kRamp:
      return {"Ramping to zero force", theme::kWarning};
    case Mode::kFault:
      return {"FAULT: zero force, latched", theme::kFault};
  }
  return {"?", theme::kGrey};
}

void bits_in_words(std::span<const BitText> table, std::uint32_t bits, Colour c) {
  for (const BitText& text : table) {
    if ((bits >> text.bit & 1u) == 0) continue;
    wrapped(c, text.name);
    ImGui::Indent(8);
    wrapped(theme::kInk, text.meaning);
    wrapped(theme::kGrey, fmt::format("Remedy: {}", text.remedy));
    ImGui::Unindent(8);
  }
}

void status_block(const PanelScene& scene, const TrackTick& tick) {
  const Headline head = headline(tick);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float line = ImGui::GetTextLineHeight(), width = ImGui::GetContentRegionAvail().x;
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + width, at.y + 1.7f * line}, packed(head.colour, 0.12f), 4);
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + 4, at.y + 1.7f * line}, packed(head.colour), 2);
  ImGui::SetCursorScreenPos({at.x + 0.8f * line, at.y + 0.35f * line});
  ImGui::TextColored(vec(head.colour), "%s", head.text);
  ImGui::SetCursorScreenPos({at.x, at.y + 2.0f * line});
  bits_in_words(fault_bit_texts(), tick.fault, theme::kFault);
  bits_in_words(status_bit_texts(), telling_status(tick.status), theme::kWarning);
  if (scene.track->lost() > 0)
    wrapped(theme::kWarning,
            fmt::format("{} ticks did not arrive: from there on the picture is near the run, not the same",
                        scene.track->lost()));
}

// Live: the last ten seconds; otherwise the whole run.
void time_span(const PanelScene& scene, double& from_s, double& until_s) {
  constexpr double kLiveSpan_s = 10;
  const std::size_t size = scene.track->size();
  until_s = scene.track->time_s(size > 0 ? size - 1 : 0);
  from_s = scene.track->time_s(0);
  if (scene.is_live) from_s = std::max(from_s, until_s - kLiveSpan_s);
  if (!(until_s > from_s + 0.1)) until_s = from_s + 0.1;
}

std::string slider_name(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

void plots(const PanelScene& scene, double now_s) {
  double from_s = 0, until_s = 1;
  time_span(scene, from_s, until_s);
  const auto columns = static_cast<std::size_t>(std::max(50.0f, ImGui::GetContentRegionAvail().x));
  const TrackColumns data = scene.track->columns(from_s, until_s, columns);
  const float line = ImGui::GetTextLineHeight();
  // They cover one another when all is well: what is felt lies below, broad.
  const PlotLine force[] = {{"felt", theme::kFelt, data.felt_N, 4.0f, 0.55f},
                            {"on the tool", theme::kForce, data.contact_N}};
  history_plot("Force", "N", force, from_s, until_s, now_s, 11 * line);
  const PlotLine depth[] = {{"deepest", theme::kDepth, data.depth_mm}};
  history_plot("Depth", "mm", depth, from_s, until_s, now_s, 8 * line);
}

// What the tick says in numbers.
void numbers(const PanelScene& scene, const TrackTick& tick) {
  if (!ImGui::BeginTable("numbers", 2, ImGuiTableFlags_SizingStretchSame)) return;
  const auto row = [](const char* name, const std::string& value) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(vec(theme::kGrey), "%s", name);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(value.c_str());
  };
  const auto three = [](Vec3 v, const char* unit) {
    return fmt::format("{:.2f}  {:.2f}  {:.2f} {}", v.x, v.y, v.z, unit);
  };
  const State& state = *scene.frame->state;
  row("force on the tool", three(tick.contact_N, "N"));
  row("force felt", three(tick.device_N, "N"));
  row("tool at", three(1e3 * state.tool_w.position_m, "mm"));
  row("handle behind tool", fmt::format("{:.2f} mm", 1e3 * norm(state.device_w.position_m - state.tool_w.position_m)));
  row("stored energy", fmt::format("{:.2f} mJ", 1e3 * tick.energy_J));
  row("tick", fmt::format("{}", tick.tick));
  ImGui::EndTable();
}

void stage_table(const TrackTiming& timing, const TrackTick& tick) {
  if (!ImGui::BeginTable("stages", 4, ImGuiTableFlags_SizingStretchProp)) return;
  for (const char* name : {"stage, us", "now", "99.9 %", "max"}) ImGui::TableSetupColumn(name);
  const auto cell = [](Colour c, const std::string& text, bool right) {
    ImGui::TableNextColumn();
    if (right)
      ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x -
                           ImGui::CalcTextSize(text.c_str()).x);
    ImGui::TextColored(vec(c), "%s", text.c_str());
  };
  const auto us = [](double ns) { return fmt::format("{:.1f}", 1e-3 * ns); };
  ImGui::TableNextRow();
  cell(theme::kGrey, "stage (us)", false);
  for (const char* name : {"now", "99.9 %", "max"}) cell(theme::kGrey, name, true);
  const auto row = [&](const char* name, double now_ns, const Histogram& histogram) {
    ImGui::TableNextRow();
    cell(theme::kInk, name, false);
    cell(theme::kInk, us(now_ns), true);
    cell(theme::kInk, us(static_cast<double>(percentile_ns(histogram, 0.999))), true);
    cell(theme::kInk, us(static_cast<double>(histogram.max_ns)), true);
  };
  for (std::int32_t i = 0; i < kStageCount; ++i)
    if (timing.stage[i].max_ns > 0) row(stage_name(static_cast<Stage>(i)), tick.stage_ns[i], timing.stage[i]);
  row("whole tick", tick.compute_ns, timing.compute);
  ImGui::EndTable();
}

void times(const PanelScene& scene, const TrackTick& tick) {
  const TrackTiming timing = scene.track->timing();
  if (timing.compute.max_ns == 0) {
    ImGui::TextUnformatted("Time of a tick");
    wrapped(theme::kGrey, "virtual time: nothing is timed");
    return;
  }
  duration_plot("Time of a tick (us; 99.9 %, maximum, period)", timing.compute, scene.track->period_s(),
                7.5f * ImGui::GetTextLineHeight());
  stage_table(timing, tick);
}

void switches(ViewLayers& layers, OrbitCamera& camera, bool& reset_camera) {
  const std::pair<const char*, bool*> all[] = {{"rest shape", &layers.rest_outline}, {"tool", &layers.tool},
                                               {"forces", &layers.forces},           {"handle", &layers.device_ghost},
                                               {"contacts", &layers.contacts},       {"anchors", &layers.anchors}};
  const float third = ImGui::GetContentRegionAvail().x / 3;
  int n = 0;
  for (const auto& [name, value] : all) {
    if (n % 3 != 0) ImGui::SameLine(static_cast<float>(n % 3) * third + ImGui::GetStyle().WindowPadding.x);
    ImGui::Checkbox(name, value);
    ++n;
  }
  const std::pair<const char*, StandardView> views[] = {{"front", StandardView::kFront},
                                                        {"right", StandardView::kRight},
                                                        {"top", StandardView::kTop},
                                                        {"left", StandardView::kLeft},
                                                        {"oblique", StandardView::kOblique}};
  for (const auto& [name, view] : views) {
    if (ImGui::SmallButton(name)) camera.look_from(view);
    ImGui::SameLine();
  }
  if (ImGui::SmallButton("all")) reset_camera = true;
}

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

// Marks with the texts that have room; the others say theirs under the mouse.
void event_marks(ImVec2 low, ImVec2 high, const PanelScene& scene, double first_s, double last_s) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float size = 0.82f * ImGui::GetFontSize();
  float free_from = low.x;
  for (const TrackEvent& event : scene.track->events()) {
    const double share = (scene.track->time_s(event.index) - first_s) / (last_s - first_s);
    const float x = low.x + static_cast<float>(share) * (high.x - low.x);
    const Colour c = colour_of(event.kind);
    list->AddLine({x, low.y}, {x, high.y}, packed(c, 0.9f), 1.6f);
    const float width = ImGui::GetFont()->CalcTextSizeA(size, 1e9f, 0, event.text.c_str()).x;
    if (x >= free_from && x + width + 6 < high.x) {
      list->AddText(ImGui::GetFont(), size, {x + 3, low.y - 1.15f * size}, packed(c), event.text.c_str());
      free_from = x + width + 12;
    }
    if (ImGui::IsMouseHoveringRect({x - 3, low.y - size}, {x + 3, high.y})) ImGui::SetTooltip("%s", event.text.c_str());
  }
}

// Live settings, as the run has them now; a slider that is moved says what is wanted.
void settings_block(const PanelScene& scene) {
  const SettingsState& now = scene.frame->state->live;
  ImGui::PushItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
#define PALPATE_FIELD(name, lowest, highest, key, meaning)                                                           \
  float name = static_cast<float>(now.name);                                                                         \
  if (ImGui::SliderFloat(slider_name(#name).c_str(), &name, static_cast<float>(lowest), static_cast<float>(highest), \
                         "x %.2f", ImGuiSliderFlags_AlwaysClamp))                                                    \
    scene.steering->set(&LiveSettings::name, name);                                                                  \
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", meaning);
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  ImGui::PopItemWidth();
}

}  // namespace

void side_panel(ImVec2 low, ImVec2 size, const PanelScene& scene, ViewLayers& layers, OrbitCamera& camera,
                bool& reset_camera) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("panel", nullptr, kFixed & ~ImGuiWindowFlags_NoScrollbar);
  if (scene.frame != nullptr) {
    const TrackTick tick = scene.track->at(scene.frame->index);
    status_block(scene, tick);
    ImGui::Spacing();
    plots(scene, scene.track->time_s(scene.frame->index));
    ImGui::Spacing();
    numbers(scene, tick);
    ImGui::Spacing();
    times(scene, tick);
    ImGui::Spacing();
    if (scene.is_live && scene.steering != nullptr) settings_block(scene);
  }
  ImGui::Separator();
  switches(layers, camera, reset_camera);
  ImGui::Separator();
  wrapped(theme::kGrey,
          scene.can_steer ? "Drag the tool to feel: it is the device. Wheel while dragging: nearer, farther. "
                            "C, O: close, open fingers. P: picture. Drag elsewhere: turn; right button: shift."
                          : "Drag: turn. Right button: shift. Wheel: zoom. P: picture. Space: play. Arrows: one tick, "
                            "with Ctrl 100. Tab: this panel.");
  ImGui::End();
}

void timeline(ImVec2 low, ImVec2 size, const PanelScene& scene, Player& player) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("timeline", nullptr, kFixed);
  const std::size_t count = scene.track->size();
  const double first_s = scene.track->time_s(0),
               last_s = std::max(first_s + 1e-3, scene.track->time_s(count > 0 ? count - 1 : 0));
  const float line = ImGui::GetFontSize();
  const float middle = low.y + 0.56f * size.y;
  ImGui::SetCursorScreenPos({low.x + line, middle - 0.8f * line});
  if (ImGui::Button(player.playing || player.live ? "Pause" : "Play", {4 * line, 1.6f * line})) {
    if (player.live)
      player.live = player.playing = false;
    else
      player.toggle(first_s, last_s);
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
  const std::string time = fmt::format("{:.3f} s", player.time_s());
  ImGui::SetCursorScreenPos({low.x + 10.6f * line, middle - 0.5f * line});
  ImGui::TextUnformatted(time.c_str());
  const ImVec2 bar_low{low.x + 15.5f * line, middle - 0.35f * line};
  const float right = low.x + size.x - (scene.is_live ? 6.0f : 5.5f) * line;
  const ImVec2 bar_high{right, middle + 0.35f * line};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(bar_low, bar_high, packed(theme::kWell), 3);
  const auto x_of = [&](double time_s) {
    return bar_low.x + static_cast<float>((time_s - first_s) / (last_s - first_s)) * (bar_high.x - bar_low.x);
  };
  list->AddRectFilled(bar_low, {x_of(player.time_s()), bar_high.y}, packed(theme::kLine), 3);
  ImGui::SetCursorScreenPos({bar_low.x, bar_low.y - 0.3f * line});
  ImGui::InvisibleButton("##scrub", {bar_high.x - bar_low.x, bar_high.y - bar_low.y + 0.6f * line});
  if (ImGui::IsItemActive()) {
    const double share = static_cast<double>((ImGui::GetIO().MousePos.x - bar_low.x) / (bar_high.x - bar_low.x));
    player.playing = player.live = false;
    player.seek(first_s + share * (last_s - first_s), first_s, last_s);
  }
  event_marks(bar_low, bar_high, scene, first_s, last_s);
  const float knob = x_of(player.time_s());
  list->AddCircleFilled({knob, middle}, 0.42f * line, packed(theme::kInk));
  ImGui::SetCursorScreenPos({right + 0.8f * line, middle - 0.8f * line});
  if (scene.is_live && ImGui::Button("Live", {4 * line, 1.6f * line})) player.live = true;
  if (!scene.is_live) {
    ImGui::SetCursorScreenPos({right + 0.8f * line, middle - 0.5f * line});
    ImGui::TextColored(vec(theme::kGrey), "%.2f s", last_s);
  }
  ImGui::End();
}

void apply_style(float scale) {
  ImGui::StyleColorsLight();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.FrameRounding = 4;
  style.WindowBorderSize = 0;
  style.FrameBorderSize = 1;
  style.WindowPadding = {14, 12};
  style.ItemSpacing = {8, 6};
  style.ScaleAllSizes(scale);
  const auto set = [&style](ImGuiCol what, Colour c) { style.Colors[what] = vec(c); };
  set(ImGuiCol_Text, theme::kInk);
  set(ImGuiCol_WindowBg, theme::kPaper);
  set(ImGuiCol_PopupBg, theme::kPaper);
  set(ImGuiCol_Border, theme::kLine);
  set(ImGuiCol_Separator, theme::kLine);
  set(ImGuiCol_FrameBg, theme::kWell);
  set(ImGuiCol_FrameBgHovered, theme::kLine);
  set(ImGuiCol_Button, theme::kWell);
  set(ImGuiCol_ButtonHovered, theme::kLine);
  set(ImGuiCol_ButtonActive, theme::kFaint);
  set(ImGuiCol_CheckMark, theme::kForce);
}

}  // namespace palpate
