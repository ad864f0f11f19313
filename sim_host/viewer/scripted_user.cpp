#include "sim_host/viewer/scripted_user.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "rt_core/tool/articulate.h"
#include "sim_host/run/joint_script.h"
#include "sim_host/viewer/hand_control.h"
#include "sim_host/viewer/keyboard.h"

namespace palpate {

namespace {

using Kind = ViewStep::Kind;

// A pixel at which the mouse catches the tool: where the middle of one of its pieces is in sight.
ImVec2 pixel_of_tool(const UserView& view) {
  const State& state = *view.pane.shown()->state;
  const Model& model = view.pane.model();
  for (std::size_t i = 0; i < model.piece.size(); ++i) {
    const Pose piece = carrier_w(model, state, static_cast<std::int32_t>(i)) * model.piece[i].pose_tool;
    const Vec3 at = view.projection(piece.position_m);
    const ImVec2 pixel{static_cast<float>(at.x), static_cast<float>(at.y)};
    const bool in_sight = at.z > 0 && pixel.x > 0 && pixel.y > 0 && pixel.x < view.size.x && pixel.y < view.size.y;
    if (in_sight && view.pane.tool_near(pixel, view.projection, 0)) return pixel;
  }
  throw std::runtime_error("script: the tool to be dragged is not in sight");
}

}  // namespace

bool ScriptedUser::is_over(const UserView& view) const {
  if (step().kind == Kind::kSwitch || step().kind == Kind::kRefused) return change_is_over(view);
  if (step().kind == Kind::kDrag) return pulls_ && spent_s_ >= step().seconds;
  return frames_ > 0 && spent_s_ >= step().seconds;
}

// A refused scene ends the script, but where that was expected; one that comes ends it there.
bool ScriptedUser::change_is_over(const UserView& view) const {
  const SceneChange::News news = view.pane.run().change->news();
  if (news.going_on()) {
    if (!view.pane.run().live()) throw std::runtime_error(step().where + ": " + news.title + ": the run has ended");
    return false;
  }
  const bool refused = news.stage == SceneChange::Stage::kRefused;
  const std::string what =
      fmt::format("{}: {} {}{}", step().where, news.title, refused ? "is refused: " : "", news.words);
  if (refused != (step().kind == Kind::kRefused)) throw std::runtime_error(what);
  fmt::print("{}\n", what);
  return true;
}

void ScriptedUser::begin_change(const UserView& view) {
  SceneChange* change = view.pane.run().change;
  if (change == nullptr || !view.pane.run().live())
    throw std::runtime_error(step().where + ": only a run that was started here, and goes on, can go over to a scene");
  try {
    if (change->ask(choice_of(step().words, change->now()))) return;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(step().where + ": " + error.what());
  }
  throw std::runtime_error(step().where + ": another change is under way");
}

// The part that is to move, by the keys that choose it.
void ScriptedUser::begin_hand(const UserView& view) {
  const ViewStep& now = step();
  Steering* steering = view.pane.run().steering;
  if (steering == nullptr || !view.pane.run().live())
    throw std::runtime_error(now.where + ": fingers are moved in a run that was started here with a simulated device");
  const Model& model = view.pane.model();
  if (now.kind == Kind::kClose || now.kind == Kind::kOpen) {
    held_ = keys_of_part(model, now.part, now.where);
    held_.push_back(now.kind == Kind::kClose ? GLFW_KEY_C : GLFW_KEY_O);
    return;
  }
  steering->begin_from(view.pane.shown()->state->articulation.closing);
  if (now.kind == Kind::kFree) {
    steering->free_joint(joint_named(joint_names(model), now.part, now.where));
    return;
  }
  JointCommand wanted;
  apply_joint_word(now.part, model, now.where, wanted);
  for (std::size_t j = 0; j < model.joint.size(); ++j)
    if ((wanted.direct >> j & 1u) != 0) steering->put_joint(j, double{wanted.target[j]});
}

void ScriptedUser::begin(const UserView& view) {
  const ViewStep& now = step();
  if (now.kind == Kind::kScrub) {
    view.player.live = view.player.playing = false;
    view.player.seek(now.value, view.first_s, view.last_s);
  }
  if (now.kind == Kind::kFollow) view.player.live = true;
  if (now.kind == Kind::kLook) view.wish = {true, now.view};
  if (now.kind == Kind::kColour) view.layers.colour = now.colour;
  if (now.kind == Kind::kFit) view.wish = {true, {}};
  if (now.kind == Kind::kZoom) view.camera.zoom(now.value);
  // Half a turn is the height of the scene.
  const int height = static_cast<int>(view.size.y);
  if (now.kind == Kind::kTurn) view.camera.orbit(now.value / 180 * height, now.up / 180 * height, height);
  if (now.kind == Kind::kRelease) down_ = false;
  if (now.kind == Kind::kSet && view.pane.run().can_steer())
    view.pane.run().steering->set(now.setting, static_cast<float>(now.value));
  if (now.kind == Kind::kPicture) picture_ = now.file;
  if (now.kind == Kind::kList) held_ = {GLFW_KEY_L};
  if (now.kind == Kind::kSwitch || now.kind == Kind::kRefused) begin_change(view);
  if (now.kind == Kind::kClose || now.kind == Kind::kOpen || now.kind == Kind::kJoint || now.kind == Kind::kFree)
    begin_hand(view);
}

// Down on the tool in one picture, then on the way to where the held place is to be; the wheel moves the plane.
void ScriptedUser::drag(ImGuiIO& io, const UserView& view) {
  if (!view.pane.run().can_steer()) throw std::runtime_error("script: drag: the run's device is not the mouse");
  if (!view.grabbed) {
    pulls_ = false;
    if (frames_ == 0 && down_) return void(down_ = false);  // it was let go since
    if (down_ && frames_ > 4) throw std::runtime_error("script: the mouse did not catch the tool");
    if (!down_) mouse_ = pixel_of_tool(view);
    down_ = true;
    return;
  }
  if (!pulls_) {
    from_m_ = view.hand.position_m;
    spent_s_ = 0;
  }
  pulls_ = true;
  const double share = step().seconds > 0 ? std::min(1.0, spent_s_ / step().seconds) : 1;
  const Pose wanted{from_m_ + share * (step().at_m - from_m_), view.hand.orientation};
  const Vec3 at = view.projection(transform(wanted, *view.grabbed));
  io.MouseWheel =
      static_cast<float>((at.z - view.projection(view.plane_w).z) / kPlaneStep / view.pane.renderer().size_m());
  mouse_ = {static_cast<float>(at.x), static_cast<float>(at.y)};
}

void ScriptedUser::act(ImGuiIO& io, const UserView& view, double elapsed_s) {
  if (is_done() || !view.pane.shown()) return;
  if (!begun_) {
    begin(view);
    begun_ = true;
    pulls_ = false;
    spent_s_ = 0;
    frames_ = 0;
  }
  if (step().kind == Kind::kDrag) drag(io, view);
  io.MousePos = mouse_;
  io.MouseDown[0] = down_;
  for (const int key : held_) hold_key(io, key, true);
  if (is_over(view) && !picture_) {
    for (const int key : held_) hold_key(io, key, false);
    held_.clear();
    ++next_;
    begun_ = false;
    return;
  }
  // What a slow picture leaves out is done in the next ones.
  spent_s_ += std::min(elapsed_s, kMostAtOnce_s);
  ++frames_;
}

}  // namespace palpate
