#include "sim_host/viewer/scene_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "sim_host/viewer/panels.h"

namespace palpate {

namespace {

std::string stem(const std::string& file) { return std::filesystem::path(file).stem().string(); }

void heading(const std::string& text) { ImGui::TextColored(colour_vector(theme::kGrey), "%s", text.c_str()); }

}  // namespace

SceneList::SceneList(SceneChoice first, const std::vector<std::string>& also)
    : first_(std::move(first)), offer_(offer_beside(first_.scene, also)) {
  choose(first_.scene);
  followed_ = first_.key();
}

// What the run has gone over to is what a person goes on from.
void SceneList::follow(const SceneChoice& now) {
  if (now.key() == followed_) return;
  followed_ = now.key();
  choose(now.scene);
  chosen_ = now;
}

// With what was laid over the first scene, where it is that one.
void SceneList::choose(const std::string& scene) {
  chosen_ = scene == first_.scene ? first_ : SceneChoice{scene, {}};
  misfit_.clear();
  for (const OverlayGroup& group : offer_.group) {
    std::vector<std::string>& misfit = misfit_.emplace_back();
    for (const std::string& file : group.file) {
      SceneChoice with{scene, {}};
      with.overlays.file = {file};
      misfit.push_back(is_image(scene) ? "an image takes no overlays: choose a scene" : why_not(with));
    }
  }
}

bool SceneList::is_laid(const std::string& file) const {
  return std::ranges::any_of(chosen_.overlays.file, [&](const std::string& laid) {
    std::error_code none;
    return std::filesystem::equivalent(laid, file, none);
  });
}

void SceneList::lay(const OverlayGroup& group, const std::string& file) {
  const bool was_laid = is_laid(file);
  const auto replaced = [&](const std::string& laid) {
    std::error_code none;
    return std::ranges::any_of(
        group.file, [&](const std::string& other) { return std::filesystem::equivalent(laid, other, none); });
  };
  std::erase_if(chosen_.overlays.file, replaced);
  if (!was_laid) chosen_.overlays.file.push_back(file);
}

void SceneList::scenes(float height) {
  ImGui::BeginChild("scenes", {0, height});
  heading("Scene");
  for (const std::string& file : offer_.scene) {
    const std::string name = stem(file) + (is_image(file) ? " (image)" : "");
    ImGui::PushID(file.c_str());
    if (ImGui::Selectable(name.c_str(), chosen_.scene == file) && chosen_.scene != file) choose(file);
    if (chosen_.scene == file && ImGui::IsWindowAppearing()) ImGui::SetScrollHereY();
    ImGui::PopID();
  }
  ImGui::EndChild();
}

void SceneList::overlays(float height) {
  ImGui::BeginChild("overlays", {0, height});
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {2, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, 2});
  for (std::size_t g = 0; g < offer_.group.size(); ++g) {
    const OverlayGroup& group = offer_.group[g];
    heading(group.name);
    for (std::size_t i = 0; i < group.file.size(); ++i) {
      const std::string& misfit = misfit_[g][i];
      ImGui::PushID(group.file[i].c_str());
      bool laid = is_laid(group.file[i]);
      ImGui::PushStyleColor(ImGuiCol_Text, colour_vector(misfit.empty() ? theme::kInk : theme::kFaint));
      if (ImGui::Checkbox(stem(group.file[i]).c_str(), &laid) && (misfit.empty() || !laid)) lay(group, group.file[i]);
      ImGui::PopStyleColor();
      if (!misfit.empty() && ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(30 * ImGui::GetFontSize());
        ImGui::TextUnformatted(misfit.c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
      }
      ImGui::PopID();
    }
  }
  ImGui::PopStyleVar(2);
  ImGui::EndChild();
}

void SceneList::draw(ImVec2 low, ImVec2 size, SceneChange& change) {
  if (!shown_) return;
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const SceneChange::News news = change.news();
  follow(change.now());
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
  ImGui::Begin("list", nullptr, kPanelFlags);
  const float height = ImGui::GetContentRegionAvail().y - 5.5f * line;
  if (ImGui::BeginTable("choice", 2, ImGuiTableFlags_SizingStretchSame)) {
    ImGui::TableNextColumn();
    scenes(height);
    ImGui::TableNextColumn();
    overlays(height);
    ImGui::EndTable();
  }
  ImGui::Separator();
  ImGui::BeginDisabled(news.going_on());
  if (ImGui::Button("Go over to it")) change.ask(chosen_);
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::TextUnformatted(title_of(chosen_).c_str());
  change_news(news);
  if (news.stage == SceneChange::Stage::kNone)
    wrapped(theme::kGrey, "Grey ones do not go on the scene: rest the mouse on them. L: this list.");
  ImGui::End();
  ImGui::PopStyleVar();
}

void change_news(const SceneChange::News& news) {
  constexpr double kTold_s = 8;
  using At = SceneChange::Stage;
  if (news.stage == At::kRefused)
    wrapped(theme::kFault, fmt::format("{} is refused: {}. The run goes on as it was.", news.title, news.words));
  else if (news.going_on())
    wrapped(theme::kWarning, fmt::format("{} {} ({:.0f} s)", news.title, news.words, news.since_s));
  else if (news.stage == At::kThere && news.since_s < kTold_s)
    wrapped(theme::kFelt, fmt::format("{} {}", news.title, news.words));
}

}  // namespace palpate
