#include "sim_host/viewer/hand_control.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "rt_core/tool/articulate.h"
#include "sim_host/run/joint_script.h"
#include "sim_host/viewer/keyboard.h"
#include "sim_host/viewer/panels.h"

namespace palpate {

namespace {

constexpr int kFingerKeys[kMaxFingers] = {GLFW_KEY_F1, GLFW_KEY_F2, GLFW_KEY_F3, GLFW_KEY_F4, GLFW_KEY_F5};
constexpr int kJointKeys[] = {GLFW_KEY_A, GLFW_KEY_S, GLFW_KEY_D, GLFW_KEY_F, GLFW_KEY_G};  // the thumb has five
constexpr char kJointLetters[] = "ASDFG";

bool has_fingers(const Model& model) { return model.params.articulation == Articulation::kHand; }

// "index_middle_flexion" under its finger: "middle flexion".
std::string short_name(const Model& model, std::size_t joint) {
  std::string name = joint_names(model)[joint];
  if (has_fingers(model)) name.erase(0, name.find('_') + 1);
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::vector<std::int32_t> held(std::span<const int> keys) {
  std::vector<std::int32_t> which;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (key_down(keys[i])) which.push_back(static_cast<std::int32_t>(i));
  return which;
}

}  // namespace

void HandControl::keys(const Model& model, const State& state, Steering& steering, double elapsed_s) {
  constexpr double kRate_per_s = 0.25;
  if (!is_articulated(model)) return;
  std::vector<std::int32_t> fingers = has_fingers(model) ? held(kFingerKeys) : std::vector<std::int32_t>{};
  if (!fingers.empty()) finger_ = fingers.back();
  const double way = (key_down(GLFW_KEY_C) ? 1 : 0) - (key_down(GLFW_KEY_O) ? 1 : 0);
  if (way == 0) return;
  const double share = way * kRate_per_s * std::min(elapsed_s, kMostAtOnce_s);
  const std::vector<std::int32_t> letters = held(kJointKeys);
  steering.begin_from(state.articulation.closing);
  if (letters.empty()) {
    if (fingers.empty()) fingers = {-1};
    for (const std::int32_t finger : fingers) steering.close_by(finger, share);
    return;
  }
  if (fingers.empty()) fingers = {has_fingers(model) ? finger_ : 0};
  for (const std::int32_t finger : fingers) {
    const std::vector<std::size_t> joints = joints_of_finger(model, finger);
    for (const std::int32_t letter : letters)
      if (static_cast<std::size_t>(letter) < joints.size())
        steering.move_joint(joints[static_cast<std::size_t>(letter)], share);
  }
}

void HandControl::panel(const Model& model, const State& state, Steering& steering) {
  if (!is_articulated(model)) return;
  if (!has_fingers(model)) finger_ = 0;
  wrapped(theme::kInk, has_fingers(model) ? "Hand: C closes, O opens; with these keys a part"
                                          : "Gripper: C closes, O opens; with these keys one jaw");
  for (std::int32_t f = 0; has_fingers(model) && f < kMaxFingers; ++f) {
    if (f > 0) ImGui::SameLine();
    const bool chosen = f == finger_;
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, colour_vector(theme::kFaint));
    const std::string name = fmt::format("F{} {}", f + 1, finger_names()[static_cast<std::size_t>(f)]);
    if (ImGui::SmallButton(name.c_str())) finger_ = f;
    if (chosen) ImGui::PopStyleColor();
  }
  ImGui::PushItemWidth(0.42f * ImGui::GetContentRegionAvail().x);
  const float before = steering.told(true)->closing[finger_];
  float closing = before;
  if (ImGui::SliderFloat("##closing", &closing, 0, 1, "", ImGuiSliderFlags_AlwaysClamp)) {
    steering.begin_from(state.articulation.closing);
    steering.close_by(finger_, double{closing} - double{before});
  }
  ImGui::SameLine();
  ImGui::Text("all of it, closed %.0f %%", 100 * double{closing});
  const std::vector<std::size_t> joints = joints_of_finger(model, finger_);
  for (std::size_t i = 0; i < joints.size() && i < std::size(kJointKeys); ++i)
    joint_slider(model, state, steering, joints[i], kJointLetters[i]);
  ImGui::PopItemWidth();
}

// What is told of a joint that was moved by itself, where it is of one that goes with its finger.
void HandControl::joint_slider(const Model& model, const State& state, Steering& steering, std::size_t joint,
                               char key) {
  const Joint& j = model.joint[joint];
  const bool slides = j.kind == JointKind::kSlide;
  const double unit = slides ? 1e-3 : kPi / 180;
  const JointCommand told = *steering.told(true);
  const bool own = (told.direct >> joint & 1u) != 0;
  const double is = state.articulation.joint[static_cast<std::int32_t>(joint)] / unit;
  const double shown = own ? double{told.target[joint]} / unit : is;
  auto value = static_cast<float>(shown);
  ImGui::PushID(static_cast<int>(joint));
  if (ImGui::SliderFloat("##joint", &value, static_cast<float>(j.lowest / unit), static_cast<float>(j.highest / unit),
                         "", ImGuiSliderFlags_AlwaysClamp)) {
    steering.begin_from(state.articulation.closing);
    steering.put_joint(joint, double{value} * unit);
  }
  ImGui::SameLine();
  // A joint on its way, or stopped by what it presses, is not where it was told to be.
  const char* sign = slides ? " mm" : "\u00b0";
  const bool elsewhere = own && std::abs(is - shown) > 0.5;
  const std::string text = fmt::format("{} {} {:.0f}{}{}", key, short_name(model, joint), shown, sign,
                                       elsewhere ? fmt::format(", is at {:.0f}", is) : "");
  ImGui::TextColored(colour_vector(own ? theme::kForce : theme::kInk), "%s", text.c_str());
  if (own) {
    ImGui::SameLine();
    if (ImGui::SmallButton("free")) steering.free_joint(joint);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("goes with its finger again");
  }
  ImGui::PopID();
}

std::vector<int> keys_of_part(const Model& model, const std::string& part, const std::string& where) {
  if (!is_articulated(model))
    throw std::runtime_error(where + ": the scene's tool has no joints; take one with a [hand] or a [gripper]");
  if (part.empty()) return {};
  const std::vector<std::string>& fingers = finger_names();
  if (const auto found = std::ranges::find(fingers, part); has_fingers(model) && found != fingers.end())
    return {kFingerKeys[found - fingers.begin()]};
  const std::size_t joint = joint_named(
      joint_names(model), part,
      has_fingers(model) ? fmt::format("{}: fingers are {}; else", where, fmt::join(fingers, ", ")) : where);
  const std::int32_t finger = model.joint[joint].finger;
  const std::vector<std::size_t> joints = joints_of_finger(model, finger);
  const auto place = std::ranges::find(joints, joint) - joints.begin();
  if (has_fingers(model)) return {kFingerKeys[finger], kJointKeys[place]};
  return {kJointKeys[place]};
}

}  // namespace palpate
