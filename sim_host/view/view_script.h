// What a viewer is told to do without a person, line by line: for tests and for pictures that can be made again.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rt_core/live.h"
#include "rt_core/vec.h"
#include "sim_host/view/orbit_camera.h"
#include "sim_host/view/view_scales.h"

namespace palpate {

struct ViewStep {
  enum class Kind {
    kWait,     // seconds
    kDrag,     // the mouse catches the tool and pulls the handle to at_m within seconds; it stays pulled
    kRelease,  // the mouse lets go
    kClose,    // fingers, or the `part`, close while the keys are held for seconds
    kOpen,
    kJoint,    // a joint's slider is moved: `part` is "JOINT=VALUE", degrees or millimetres
    kFree,     // joint `part` goes with its finger again
    kSwitch,   // the run goes over to the scene of `words`; waits until it is there
    kRefused,  // the same of a scene that is refused
    kList,     // the list of scenes, shown or gone
    kSet,      // live setting to value
    kScrub,    // to value, seconds of the timeline
    kFollow,   // back to the live end
    kLook,     // standard view
    kColour,   // what the body's colours show
    kFit,      // all is to be seen
    kTurn,     // drag beside the tool: degrees to the right, degrees up
    kZoom,     // steps of the wheel
    kPicture,  // write file
  };
  Kind kind = Kind::kWait;
  double seconds = 0, value = 0, up = 0;
  Vec3 at_m;
  std::string file;
  std::string part;   // a finger or a joint; "": all fingers
  std::string words;  // which scene (choice_of)
  std::string where;  // "FILE:LINE", for messages
  float LiveSettings::*setting = nullptr;
  StandardView view = StandardView::kOblique;
  SurfaceColour colour = SurfaceColour::kDisplacement;
};

// One step a line; "#" begins a remark. Throws std::runtime_error naming `name`, the line and what is expected there.
std::vector<ViewStep> parse_view_script(std::string_view text, const std::string& name);
std::vector<ViewStep> read_view_script(const std::string& path);
// Every step with what belongs to it, for help and messages.
std::string view_script_words();

}  // namespace palpate
