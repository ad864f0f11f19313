// One run from start to summary: bake if needed, start the controller (and the simulated device), arm, watch, record,
// stop in order.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/scene.h"
#include "sim_host/latency/live_table.h"
#include "sim_host/record/black_box.h"
#include "sim_host/record/recording.h"
#include "sim_host/run/joint_script.h"
#include "sim_host/run/run_summary.h"

namespace palpate {

// Whose time a run takes. Automatic: virtual with the simulated device nobody asked for, real with any that is named.
enum class RunTime { kAutomatic, kReal, kVirtual };

// Somebody who watches a run and takes part in it while it goes on: a viewer. Every member may be empty.
struct RunCompanion {
  std::chrono::milliseconds look{50};                   // so often the host looks at the run: 1 to 50 ms
  std::function<void(const RecordingHeader&)> begins;   // the controller is there
  std::function<void(const TickRecord&)> tick;          // of every record, on the recorder's thread or the run's
  std::function<bool()> goes_on;                        // asked at every look; false ends the run in order
  std::function<std::optional<JointCommand>()> joints;  // asked at every look; something replaces the script
  std::function<void(LiveSettings&)> live;              // asked at every look: may change what is wanted
  // Asked at every look: path of an image to go over to, or "". `changed` is told the answer: "", or why not.
  std::function<std::string()> scene;
  std::function<void(const std::string& wrong)> changed;
  std::function<void(const std::string& image)> goes_over;  // the run will go over to it, whoever asked
  int hand_fd = -1;                                         // memory that pulls the simulated hand; -1: none
};

struct RunOptions {
  std::string scene;            // .toml or .pal
  SceneOverlays overlays;       // laid over a .toml
  std::string device = "auto";  // auto, loopback, can:IFACE
  std::string profile;          // of the device (hal/device/device_profile.h); needed on can: and usb:
  RunTime time = RunTime::kAutomatic;
  bool pace = false;  // virtual time no faster than real time
  double duration_s = 10;
  std::string telemetry;           // socket on which the controller meets readers (telemetry_door.h); empty: none
  std::string record = "run.plr";  // empty: do not record
  bool overwrite = false;          // an existing recording of that name is replaced once the new one is complete
  std::string path;                // CSV of the simulated hand's motion; empty: the scene's own
  std::string second_device;       // of the hand that holds the body, where the scene has one; empty: simulated, too
  std::string second_path;         // CSV of its motion when it is simulated; empty: it holds the body still
  JointOptions joints;             // told to an articulated tool through the mailbox
  std::string image;               // where to write the image of a .toml scene; empty: beside the recording
  int cpu = -1;                    // of the real-time thread; -1: any
  int priority = 80;               // SCHED_FIFO; 0: ordinary scheduling
  bool allow_no_rt = false;        // drive a real device although real-time rights were refused
  bool quiet = false;              // no live status line
  bool arm = true;                 // false: never armed, hence zero force throughout; every stage computes all the same
  bool repeat_path = false;        // the simulated hand repeats the scene's own motion for the whole duration
  std::string black_box;           // prefix of the files written with every fault; empty: none
  std::function<void()> before_start;              // scene and options are accepted, nothing has started; may be empty
  std::function<void(const LiveState&)> progress;  // called about every second while the run goes on; may be empty
  RunCompanion companion;
  std::string program_folder;  // of palpate-rt and palpate-device; empty: beside this program
};

struct RunResult {
  RunSummary summary;
  std::string grasp;  // of a hand: whether it held the body, a line; "" for other tools
  bool virtual_time = false;
  std::uint64_t lost = 0;
  int controller_exit = 0;
  std::string recorder_error;
  bool interrupted = false;                   // Ctrl-C
  bool device_died = false;                   // the simulated one, before the end
  std::vector<std::string> later_recordings;  // of the scenes that the run went over to
  std::vector<BlackBoxDump> dumps;
  std::string black_box_error;
  double elapsed_s = 0;  // until the stop
  bool faulted() const { return summary.fault != 0; }
};

// Whether a run with these options takes place in virtual time: controller, simulated device and host in lock step, as
// fast as the machine can, with the same bits every time. Throws std::runtime_error when that was asked for with a
// device that has its own time.
bool runs_in_virtual_time(const RunOptions& options);

// Throws std::runtime_error when the run cannot start, with the table when the traffic does not fit the CAN bus. SIGINT
// and SIGTERM end it early and in order.
RunResult run_session(const RunOptions& options);

}  // namespace palpate
