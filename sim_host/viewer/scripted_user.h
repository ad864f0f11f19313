// A person who is not there: does the steps of a script to the viewer's mouse, keys and time.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>

#include "sim_host/view/player.h"
#include "sim_host/view/view_script.h"
#include "sim_host/viewer/panels.h"
#include "sim_host/viewer/scene_pane.h"

namespace palpate {

// What a step may see and touch.
struct UserView {
  const ScenePane& pane;
  Projection projection;  // of its scene, which fills the window from its left upper corner to `size`
  ImVec2 size;
  OrbitCamera& camera;
  ViewLayers& layers;
  CameraWish& wish;
  Player& player;
  double first_s, last_s;
  // While the mouse holds the tool: its place in the tool's frame, where the handle is pulled, and the plane.
  std::optional<Vec3> grabbed;
  Pose hand;
  Vec3 plane_w;
};

class ScriptedUser {
 public:
  explicit ScriptedUser(std::vector<ViewStep> steps) : steps_(std::move(steps)) {}
  bool is_done() const { return next_ >= steps_.size(); }
  // What mouse and keys do in the next picture. Throws std::runtime_error when the tool to be dragged is not in sight.
  void act(ImGuiIO& io, const UserView& view, double elapsed_s);
  // A picture to write of what stands still; the script waits until it was taken.
  const std::optional<std::string>& picture() const { return picture_; }
  void picture_taken() { picture_.reset(); }

 private:
  void begin(const UserView& view);
  void drag(ImGuiIO& io, const UserView& view);
  bool is_over(const UserView& view) const;
  bool change_is_over(const UserView& view) const;
  void begin_change(const UserView& view);
  void begin_hand(const UserView& view);
  const ViewStep& step() const { return steps_[next_]; }

  std::vector<ViewStep> steps_;
  std::size_t next_ = 0;
  bool begun_ = false;
  double spent_s_ = 0;
  std::size_t frames_ = 0;
  ImVec2 mouse_{-1e4f, -1e4f};
  bool down_ = false, pulls_ = false;  // pulls: it has the tool, and from_m_ is known
  std::vector<int> held_;              // keys
  Vec3 from_m_;                        // where the handle was when the drag began
  std::optional<std::string> picture_;
};

}  // namespace palpate
