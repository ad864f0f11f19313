// The window with its OpenGL context, fonts and user interface. Everything is drawn into a picture of our own first, so
// that a screenshot needs no window on any screen.
#pragma once

#include <functional>
#include <string>

#include "sim_host/viewer/gl_objects.h"
#include "sim_host/viewer/overlay.h"

struct GLFWwindow;

namespace palpate {

class ViewWindow {
 public:
  // Throws std::runtime_error, saying what to do, when there is no display or no OpenGL 3.3.
  ViewWindow(int width, int height, const std::string& title, bool visible);
  ~ViewWindow();
  ViewWindow(const ViewWindow&) = delete;
  ViewWindow& operator=(const ViewWindow&) = delete;

  bool wants_to_close() const;
  void close();
  void poll();
  // `input` may change what mouse and keys are taken to do.
  void begin_ui(const std::function<void(ImGuiIO&)>& input);
  void end_ui();  // the picture is complete then
  void present();
  int width() const { return width_; }
  int height() const { return height_; }
  const Fonts& fonts() const { return fonts_; }
  const GlFramebuffer& picture() const { return picture_; }
  std::string driver() const;

 private:
  void load_fonts(float scale);

  GLFWwindow* window_ = nullptr;
  int width_, height_;
  bool visible_;
  Fonts fonts_;
  GlFramebuffer picture_;
};

// Of this process so far.
double most_memory_MB();

}  // namespace palpate
