#include "sim_host/feel/feel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "rt_core/tick.h"
#include "rt_core/tool/virtual_coupling.h"
#include "sim_host/feel/finger_work.h"
#include "sim_host/press/pose_csv.h"
#include "sim_host/run/device_process.h"
#include "sim_host/run/plant_options.h"
#include "sim_host/status_text.h"
#include "sim_host/tick_memory.h"

namespace palpate {

namespace {

void set_device(const std::string& text, FeelSetup& setup) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals), value = equals == std::string::npos ? "" : text.substr(equals + 1);
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  if (value.empty() || *end != '\0' || !(number >= 0 && number <= 1e6))
    throw std::runtime_error(fmt::format("--device {}: expected NAME=VALUE with a number from 0 to 1e6", text));
  std::string known = " delay_s encoder_rad echoes lost_of_16 slope_share_per_ms";
  if (name == "delay_s") return static_cast<void>(setup.delay_s = number);
  if (name == "echoes") return static_cast<void>(setup.echoes = number > 0);
  if (name == "lost_of_16") return static_cast<void>(setup.lost_of_16 = static_cast<int>(number));
  if (name == "slope_share_per_ms") return static_cast<void>(setup.plant.local_slope_share_per_ms = number);
  if (name == "encoder_rad") return static_cast<void>(setup.encoder_rad = number);
#define PALPATE_SET(member)                                                   \
  if (name == #member) return static_cast<void>(setup.plant.member = number); \
  known += " " #member;
  PALPATE_PLANT_OPTIONS(PALPATE_SET)
#undef PALPATE_SET
  throw std::runtime_error(fmt::format("--device: no property '{}'; there are:{}", name, known));
}

}  // namespace

FeelSetup feel_setup(const SceneDesc& scene, const Model& model, const FeelOptions& options) {
  FeelSetup setup;
  setup.plant = plant_of(scene);
  setup.period_s = model.params.period_s;
  setup.delay_s = scene.device.delay_s;
  setup.encoder_rad = scene.device.encoder_step_rad;
  const HandModel* chosen = nullptr;
  for (const HandModel& hand : hand_models())
    if (options.hand == hand.title) chosen = &hand;
  if (!options.hand.empty() && chosen == nullptr)
    throw std::runtime_error("--hand " + options.hand + ": there are light, medium, firm and strong");
  if (chosen != nullptr) {
    setup.plant.hand_stiffness_N_per_m = chosen->stiffness_N_per_m;
    setup.plant.hand_damping_N_s_per_m = chosen->damping_N_s_per_m;
    setup.plant.hand_mass_kg = chosen->mass_kg;
  }
  for (const std::string& property : options.device) set_device(property, setup);
  return setup;
}

FeelRun run_feel(const Model& model, const SceneDesc& scene, const TouchPlace& place, Manoeuvre manoeuvre,
                 const FeelOptions& options, const FeelListener& listen) {
  FeelSetup setup = feel_setup(scene, model, options);
  set_manoeuvre(manoeuvre, place, setup);
  const std::vector<TimedPose> scripted = scripted_poses(scene.path, model.params.period_s);
  if (scene.articulation != Articulation::kRigid)
    setup.joints = [&](double time_s) {  // as the scene closes them, but on its own path until they hold the body
      const double until_s = manoeuvre == Manoeuvre::kPath ? time_s : std::min(time_s, place.approach_s);
      const double row = until_s / model.params.period_s;
      return scripted[std::min(scripted.size() - 1, static_cast<std::size_t>(row + 0.5))].joints;
    };
  const StatePtr state = make_state(model);
  const ScratchPtr scratch = make_scratch(model);
  FeelMeters meters(model.params, setup);
  FingerWork fingers(model, *state, *scratch);
  run_feel_loop(
      setup,
      [&](const Input& input, Output& output) {
        tick(model, *state, *scratch, input, output);
        fingers.add();
      },
      [&](FeelTick now) {
        now.fingers_J = fingers.work_J();
        const Twist stretch = twist_between(state->safety.tool_corrected_w, scratch->grip_w);
        now.stretch_m = norm(stretch.translation_m);
        now.stretch_rad = norm(stretch.rotation_rad);
        meters.add(now);
        if (listen) listen(now);
      });
  const char* title = "";
  for (const ManoeuvreText& text : manoeuvre_texts())
    if (text.manoeuvre == manoeuvre) title = text.title;
  return {scene.name, title, meters.figures()};
}

std::string feel_csv_header() {
  return "time_s,handle_x_mm,handle_y_mm,handle_z_mm,tool_x_mm,tool_y_mm,tool_z_mm,force_x_N,force_y_N,force_z_N,"
         "torque_x_Nm,torque_y_Nm,torque_z_Nm,model_N,depth_mm,stored_J,surplus_J,motor_J,hand_J,fingers_J,mode,stale_"
         "ticks,"
         "status\n";
}

std::string feel_csv_row(const FeelTick& tick) {
  const Vec3 h = 1e3 * tick.handle_w.position_m, t = 1e3 * tick.output.tool_w.position_m;
  const Vec3 f = tick.output.device_w.force_N, m = tick.output.device_w.torque_Nm;
  return fmt::format(
      "{:.4f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.5f},{:.6g},"
      "{:.6g},{:.6g},{:.6g},{:.6g},{},{},{}\n",
      tick.time_s, h.x, h.y, h.z, t.x, t.y, t.z, f.x, f.y, f.z, m.x, m.y, m.z, norm(tick.output.contact_w.force_N),
      1e3 * tick.output.penetration_m, tick.output.energy_J, tick.output.surplus_J, tick.energy.motor_J,
      tick.energy.to_hand_J(), tick.fingers_J, mode_name(tick.output.mode), tick.input.stale_ticks,
      bit_names(status_bit_texts(), tick.output.status));
}

}  // namespace palpate
