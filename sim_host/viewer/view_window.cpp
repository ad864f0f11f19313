#include "sim_host/viewer/view_window.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "sim_host/viewer/panels.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace palpate {

namespace {

std::string last_error = "no reason given";
void keep_error(int, const char* text) { last_error = text; }

// Sizes are made for a picture 1000 pixels high.
float scale_for(int width, int height) {
  const float scale = std::min(static_cast<float>(width) / 1600, static_cast<float>(height) / 1000);
  return std::clamp(scale, 0.72f, 3.0f);
}

std::string first_font(bool bold) {
  const std::string folder = "/usr/share/fonts/truetype/";
  const std::string names[] = {
      folder + "roboto/unhinted/RobotoTTF/" + (bold ? "Roboto-Medium.ttf" : "Roboto-Regular.ttf"),
      folder + "dejavu/" + (bold ? "DejaVuSans-Bold.ttf" : "DejaVuSans.ttf")};
  for (const std::string& name : names)
    if (std::filesystem::exists(name)) return name;
  return "";
}

}  // namespace

ViewWindow::ViewWindow(int width, int height, const std::string& title, bool visible)
    : width_(width), height_(height), visible_(visible) {
  glfwSetErrorCallback(keep_error);
  if (glfwInit() == GLFW_FALSE)
    throw std::runtime_error("no display: " + last_error +
                             "; on a machine without one: xvfb-run -a palpate view ... --screenshot FILE.png");
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
  window_ = glfwCreateWindow(width, height, ("Palpate: " + title).c_str(), nullptr, nullptr);
  if (window_ == nullptr) {
    glfwTerminate();
    throw std::runtime_error("no OpenGL 3.3: " + last_error + "; install libgl1-mesa-dri (it draws in software too)");
  }
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(visible ? 1 : 0);
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leaves nothing behind
  const float scale = scale_for(width, height);
  load_fonts(scale);
  apply_style(scale);
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

ViewWindow::~ViewWindow() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  picture_.release();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void ViewWindow::load_fonts(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  const auto load = [&](bool bold, float size) -> ImFont* {
    const std::string name = first_font(bold);
    if (!name.empty())
      if (ImFont* font = io.Fonts->AddFontFromFileTTF(name.c_str(), std::round(size * scale))) return font;
    ImFontConfig config;
    config.SizePixels = std::round(size * scale);
    return io.Fonts->AddFontDefault(&config);
  };
  fonts_.text = load(false, 17);
  fonts_.title = load(true, 27);
}

bool ViewWindow::wants_to_close() const { return glfwWindowShouldClose(window_) != 0; }
void ViewWindow::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }

void ViewWindow::poll() {
  glfwPollEvents();
  if (visible_) glfwGetFramebufferSize(window_, &width_, &height_);
  width_ = std::max(width_, 320);
  height_ = std::max(height_, 240);
  picture_.resize(width_, height_, 1, GL_RGBA8);
}

void ViewWindow::begin_ui(const std::function<void(ImGuiIO&)>& input) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  if (input) input(ImGui::GetIO());
  ImGui::NewFrame();
}

void ViewWindow::end_ui() {
  ImGui::Render();
  picture_.bind();
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void ViewWindow::present() {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture_.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glfwSwapBuffers(window_);
}

std::string ViewWindow::driver() const { return reinterpret_cast<const char*>(glGetString(GL_RENDERER)); }

double most_memory_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace palpate
