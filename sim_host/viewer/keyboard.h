// Keys, named by GLFW's numbers, for every Dear ImGui: up to 1.86 (Debian 12) it knows them by these, from 1.87 on by
// numbers of its own.
#pragma once

#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace palpate {

#if IMGUI_VERSION_NUM >= 18700
inline ImGuiKey imgui_key(int key) {
  const auto among = [key](int first, int last, ImGuiKey name) {
    return key >= first && key <= last ? static_cast<ImGuiKey>(name + (key - first)) : ImGuiKey_None;
  };
  for (const ImGuiKey found :
       {among(GLFW_KEY_A, GLFW_KEY_Z, ImGuiKey_A), among(GLFW_KEY_0, GLFW_KEY_9, ImGuiKey_0),
        among(GLFW_KEY_F1, GLFW_KEY_F12, ImGuiKey_F1), among(GLFW_KEY_TAB, GLFW_KEY_TAB, ImGuiKey_Tab),
        among(GLFW_KEY_SPACE, GLFW_KEY_SPACE, ImGuiKey_Space), among(GLFW_KEY_ESCAPE, GLFW_KEY_ESCAPE, ImGuiKey_Escape),
        among(GLFW_KEY_LEFT, GLFW_KEY_LEFT, ImGuiKey_LeftArrow),
        among(GLFW_KEY_RIGHT, GLFW_KEY_RIGHT, ImGuiKey_RightArrow)})
    if (found != ImGuiKey_None) return found;
  return ImGuiKey_None;
}
inline void hold_key(ImGuiIO& io, int key, bool down) { io.AddKeyEvent(imgui_key(key), down); }
#else
inline ImGuiKey imgui_key(int key) { return key; }
inline void hold_key(ImGuiIO& io, int key, bool down) { io.KeysDown[key] = down; }
#endif
inline bool key_down(int key) { return ImGui::IsKeyDown(imgui_key(key)); }
inline bool key_pressed(int key, bool repeat = true) { return ImGui::IsKeyPressed(imgui_key(key), repeat); }

}  // namespace palpate
