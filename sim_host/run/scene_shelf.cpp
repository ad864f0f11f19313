#include "sim_host/run/scene_shelf.h"

#include <cstdio>

#include "rt_core/image.h"

namespace palpate {

std::string scene_misfit(const ModelParams& now, const ModelParams& next) {
  std::string text;
  const auto tell = [&text](const char* name, const char* must, double here, double there) {
    char line[160];
    std::snprintf(line, sizeof line, "%s%s is %.6g, and must %s the run's %.6g", text.empty() ? "" : "; ", name, there,
                  must, here);
    text += line;
  };
  const auto same = [&](const char* name, double here, double there) {
    if (!(here == there)) tell(name, "be", here, there);
  };
  const auto at_most = [&](const char* name, double here, double there) {
    if (!(there <= here)) tell(name, "not exceed", here, there);
  };
  same("period_s", now.period_s, next.period_s);
  same("held_part", static_cast<double>(now.held_part), static_cast<double>(next.held_part));
  same("delay_s", now.delay_s, next.delay_s);
  same("local_period_s", now.local_period_s, next.local_period_s);
  same("encoder_step_m", now.encoder_step_m, next.encoder_step_m);
  same("encoder_step_rad", now.encoder_step_rad, next.encoder_step_rad);
  same("silence_fault_ticks", now.silence_fault_ticks, next.silence_fault_ticks);
  same("late_ticks_max", now.late_ticks_max, next.late_ticks_max);
  same("stall_max_s", now.stall_max_s, next.stall_max_s);
  at_most("ramp_out_s", now.ramp_out_s, next.ramp_out_s);
  at_most("force_max_N", now.force_max_N, next.force_max_N);
  at_most("torque_max_Nm", now.torque_max_Nm, next.torque_max_Nm);
  return text;
}

std::string SceneShelf::add(const std::string& path, const Before& before) {
  const std::uint64_t number = count();
  if (number == scene_.size())
    return "a run goes over to at most " + std::to_string(scene_.size()) + " other scenes: begin a new one";
  std::string error;
  auto scene = std::make_unique<ShelvedScene>();
  scene->image = PrivateFile::read(path, error);
  if (!scene->image) return error;
  const ImageResult result = open_image(scene->image.bytes(), scene->model);
  if (result.error != ImageError::kNone)
    return path + ": " + result.field + ": " + describe(result.error) + "; bake the scene again";
  if (const std::string misfit = scene_misfit(first_.params, scene->model.params); !misfit.empty())
    return path + ": made for another device or run: " + misfit;
  if (const std::string other = refuse_(scene->model); !other.empty()) return path + ": " + other;
  scene->state = make_state(scene->model);
  scene->scratch = make_scratch(scene->model);
  if (before) before(number + 1, scene->model);
  scene_[number] = std::move(scene);
  count_.store(number + 1, std::memory_order_release);
  return "";
}

}  // namespace palpate
