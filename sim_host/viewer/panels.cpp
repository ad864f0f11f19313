#include "sim_host/viewer/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "rt_core/tool/articulate.h"
#include "sim_host/status_text.h"
#include "sim_host/viewer/plots.h"
#include "sim_host/viewer/scene_list.h"

namespace palpate {

void wrapped(Colour c, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(c));
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

namespace {

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
  ImGui::TextColored(colour_vector(head.colour), "%s", head.text);
  ImGui::SetCursorScreenPos({at.x, at.y + 2.0f * line});
  bits_in_words(fault_bit_texts(), tick.fault, theme::kFault);
  bits_in_words(status_bit_texts(), telling_status(tick.status), theme::kWarning);
  if (scene.track->lost() > 0)
    wrapped(theme::kWarning,
            fmt::format("{} ticks did not arrive: from there on the picture is near the run, not the same",
                        scene.track->lost()));
}

// Live: the last ten seconds, or those around what is looked at again; otherwise the whole run.
void time_span(const PanelScene& scene, double now_s, double& from_s, double& until_s) {
  constexpr double kLiveSpan_s = 10;
  const std::size_t size = scene.track->size();
  until_s = scene.track->time_s(size > 0 ? size - 1 : 0);
  from_s = scene.track->time_s(0);
  if (scene.is_live) {
    const double around_s = std::max(now_s + 0.5 * kLiveSpan_s, from_s + kLiveSpan_s);
    if (now_s < until_s - kLiveSpan_s) until_s = std::min(until_s, around_s);
    from_s = std::max(from_s, until_s - kLiveSpan_s);
  }
  if (!(until_s > from_s + 0.1)) until_s = from_s + 0.1;
}

std::string slider_name(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

// How high plots are: all as high as asked where the panel has room for everything, lower where it has not; below half
// of that, what mouse and keys do is not written out.
class PlotHeight {
 public:
  float of(float lines) {
    const float height = share_ * lines * ImGui::GetTextLineHeight();
    used_ += height;
    return height;
  }
  bool hint_fits() const { return hint_fits_; }
  // At the end of a panel `high` pixels high: for its next picture.
  void settle(float high) {
    const float left = high - ImGui::GetCursorPosY() - ImGui::GetStyle().WindowPadding.y;
    if (used_ > 0) {
      if (left < 0 && share_ <= kLeast) hint_fits_ = false;
      if (left > 0.5f * high) hint_fits_ = true;
      share_ = std::clamp(share_ * (used_ + left) / used_, kLeast, 1.0f);
    }
    used_ = 0;
  }

 private:
  static constexpr float kLeast = 0.5f;
  float share_ = 0.8f, used_ = 0;
  bool hint_fits_ = true;
};
PlotHeight plot_height;

void plots(const PanelScene& scene, double now_s) {
  double from_s = 0, until_s = 1;
  time_span(scene, now_s, from_s, until_s);
  const auto columns = static_cast<std::size_t>(std::max(50.0f, ImGui::GetContentRegionAvail().x));
  const TrackColumns data = scene.track->columns(from_s, until_s, columns);
  // They cover one another when all is well: what is felt lies below, broad.
  const PlotLine force[] = {{"felt", theme::kFelt, data.felt_N, 4.0f, 0.55f},
                            {"on the tool", theme::kForce, data.contact_N}};
  history_plot("Force", "N", force, from_s, until_s, now_s, plot_height.of(10));
  const PlotLine depth[] = {{"deepest", theme::kDepth, data.depth_mm}};
  history_plot("Depth", "mm", depth, from_s, until_s, now_s, plot_height.of(8));
  const PlotLine energy[] = {{"given by the hand", theme::kFelt, data.given_mJ},
                             {"stored", theme::kForce, data.stored_mJ},
                             {"surplus", theme::kFriction, data.surplus_mJ}};
  history_plot("Energy", "mJ", energy, from_s, until_s, now_s, plot_height.of(8));
}

// The whole tick and its dearest stages; nothing in virtual time.
void stage_plot(const PanelScene& scene, const TrackTiming& timing, double now_s) {
  constexpr std::size_t kShown = 3;
  static constexpr Colour kColours[kShown] = {theme::kDepth, theme::kFriction, theme::kFelt};
  double from_s = 0, until_s = 1;
  time_span(scene, now_s, from_s, until_s);
  const auto columns = static_cast<std::size_t>(std::max(50.0f, ImGui::GetContentRegionAvail().x));
  const TrackColumns data = scene.track->columns(from_s, until_s, columns);
  std::array<std::size_t, kStageCount> stage;
  std::iota(stage.begin(), stage.end(), 0u);
  std::ranges::sort(stage, std::greater{}, [&](std::size_t i) { return percentile_ns(timing.stage[i], 0.5); });
  std::vector<PlotLine> lines;
  // The whole lies below its parts; they are seen in front of it, the dearest in front.
  lines.push_back({"tick", theme::kInk, data.compute_us, 1.4f, 0.35f});
  for (std::size_t k = kShown; k-- > 0;)
    lines.push_back({stage_name(static_cast<Stage>(stage[k])), kColours[k], data.stage_us[stage[k]], 1.4f});
  history_plot("Stages", "us", lines, from_s, until_s, now_s, plot_height.of(8));
}

// What the tick says in numbers.
void numbers(const PanelScene& scene, const TrackTick& tick) {
  if (!ImGui::BeginTable("numbers", 2, ImGuiTableFlags_SizingStretchSame)) return;
  const auto row = [](const char* name, const std::string& value) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(colour_vector(theme::kGrey), "%s", name);
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
  row("stored, given", fmt::format("{:.2f}  {:.2f} mJ", 1e3 * tick.energy_J, 1e3 * tick.given_J));
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
    ImGui::TextColored(colour_vector(c), "%s", text.c_str());
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
  constexpr std::int64_t kWorthARow_ns = 1000;  // ever
  for (std::int32_t i = 0; i < kStageCount; ++i)
    if (timing.stage[i].max_ns >= kWorthARow_ns)
      row(stage_name(static_cast<Stage>(i)), tick.stage_ns[i], timing.stage[i]);
  row("whole tick", tick.compute_ns, timing.compute);
  ImGui::EndTable();
}

void times(const PanelScene& scene, const TrackTick& tick, double now_s) {
  const TrackTiming timing = scene.track->timing();
  if (timing.compute.max_ns == 0) {
    wrapped(theme::kGrey, "Virtual time: no tick is timed");
    return;
  }
  duration_plot("Time of a tick (us; 99.9 %, maximum, period)", timing.compute, scene.track->period_s(),
                plot_height.of(7.5f));
  stage_plot(scene, timing, now_s);
  stage_table(timing, tick);
}

void switches(ViewLayers& layers, CameraWish& wish) {
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
  ImGui::TextUnformatted("colour");
  for (const auto& [name, colour] : surface_colours()) {
    ImGui::SameLine();
    if (ImGui::RadioButton(name.c_str(), layers.colour == colour)) layers.colour = colour;
  }
  const std::pair<const char*, StandardView> views[] = {{"front", StandardView::kFront},
                                                        {"right", StandardView::kRight},
                                                        {"top", StandardView::kTop},
                                                        {"left", StandardView::kLeft},
                                                        {"oblique", StandardView::kOblique}};
  for (const auto& [name, view] : views) {
    if (ImGui::SmallButton(name)) wish = {true, view};
    ImGui::SameLine();
  }
  if (ImGui::SmallButton("all")) wish = {true, {}};
}

// Live settings, as the run has them now; a slider that is moved says what is wanted.
void settings_block(const PanelScene& scene) {
  const SettingsState& now = scene.frame->state->live;
  ImGui::PushItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
#define PALPATE_FIELD(name, lowest, highest, key, meaning)                                               \
  float name = static_cast<float>(now.name);                                                             \
  if (ImGui::SliderFloat("##" #name, &name, static_cast<float>(lowest), static_cast<float>(highest), "", \
                         ImGuiSliderFlags_AlwaysClamp))                                                  \
    scene.steering->set(&LiveSettings::name, name);                                                      \
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", meaning);                                          \
  ImGui::SameLine();                                                                                     \
  ImGui::Text("%s x %.2f", slider_name(#name).c_str(), static_cast<double>(name));
  PALPATE_LIVE_SETTINGS(PALPATE_FIELD)
#undef PALPATE_FIELD
  ImGui::PopItemWidth();
}

}  // namespace

void side_panel(ImVec2 low, ImVec2 size, const PanelScene& scene, ViewLayers& layers, CameraWish& wish) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("panel", nullptr, kPanelFlags & ~ImGuiWindowFlags_NoScrollbar);
  if (scene.frame != nullptr) {
    const TrackTick tick = scene.track->at(scene.frame->index);
    status_block(scene, tick);
    if (scene.is_live && scene.change != nullptr) change_news(scene.change->news());
    ImGui::Spacing();
    plots(scene, scene.track->time_s(scene.frame->index));
    ImGui::Spacing();
    numbers(scene, tick);
    ImGui::Spacing();
    times(scene, tick, scene.track->time_s(scene.frame->index));
    ImGui::Spacing();
    if (scene.is_live && scene.steering != nullptr) {
      settings_block(scene);
      ImGui::Spacing();
      scene.hand->panel(*scene.model, *scene.frame->state, *scene.steering);
    }
  }
  ImGui::Separator();
  switches(layers, wish);
  ImGui::Separator();
  const char* hint = scene.can_steer
                         ? "Drag the tool to feel: it is the device. Wheel while dragging: nearer, farther. "
                           "C, O: close, open fingers. L: other scenes. K: colours. P: picture. Tab: this panel. "
                           "Drag elsewhere: turn; right button: shift."
                         : "Drag: turn. Right button: shift. Wheel: zoom. K: colours. P: picture. Space: play. Arrows: "
                           "one tick, with Ctrl 100. Tab: this panel.";
  wrapped(theme::kGrey, plot_height.hint_fits() ? hint : "Mouse and keys: rest the mouse here.");
  if (!plot_height.hint_fits() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", hint);
  plot_height.settle(size.y);
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
  const auto set = [&style](ImGuiCol what, Colour c) { style.Colors[what] = colour_vector(c); };
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
