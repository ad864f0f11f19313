#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "sim_host/report/case_report.h"

namespace palpate {

namespace {

using Json = nlohmann::ordered_json;

// Every number of a run by its name, once for writing and for reading. X(name, member)
#define PALPATE_RUN_VALUES(X)           \
  X("name", name)                       \
  X("family", family)                   \
  X("meaning", meaning)                 \
  X("refused", refused)                 \
  X("step_N", step_N)                   \
  X("slide_force_N", slide_force_N)     \
  X("ticks", ticks)                     \
  X("unconverged", unconverged)         \
  X("beyond_range", beyond_range)       \
  X("counted", count.counted)           \
  X("not_counted", count.why_not)       \
  X("worst_instructions", count.worst)  \
  X("mean_instructions", count.mean)    \
  X("counted_ticks", count.ticks)       \
  X("worst_stage", count.worst_stage)   \
  X("p50_us", p50_us)                   \
  X("p999_us", p999_us)                 \
  X("max_us", max_us)                   \
  X("bake_s", bake_s)                   \
  X("image_bytes", image_bytes)         \
  X("state_bytes", state_bytes)         \
  X("scratch_bytes", scratch_bytes)     \
  X("hash", hash)                       \
  X("surface_rms", surface.rms)         \
  X("surface_largest", surface.largest) \
  X("surface_still_rms", surface.still_rms)
#define PALPATE_ERROR_VALUES(X)                 \
  X("force_rms", force_rms)                     \
  X("force_largest", force_largest)             \
  X("at_largest", at_largest)                   \
  X("stiffness_rms", stiffness_rms)             \
  X("stiffness_largest", stiffness_largest)     \
  X("direction_rad", direction_rad)             \
  X("energy", energy)                           \
  X("force_unnoticed", force_unnoticed)         \
  X("stiffness_unnoticed", stiffness_unnoticed) \
  X("from", from)                               \
  X("to", to)                                   \
  X("x", x)                                     \
  X("relative", relative)

Json json_of(const ModelRun& run) {
  Json json;
#define PALPATE_WRITE(key, member) json[key] = run.member;
  PALPATE_RUN_VALUES(PALPATE_WRITE)
#undef PALPATE_WRITE
  Json force = Json::array();
  for (const Vec3& f : run.path.force_N) force.push_back({f.x, f.y, f.z});
  json["depth_m"] = run.path.x;
  json["force_N"] = force;
  if (!run.error) return json;
  Json error;
#define PALPATE_WRITE(key, member) error[key] = run.error->member;
  PALPATE_ERROR_VALUES(PALPATE_WRITE)
#undef PALPATE_WRITE
  json["error"] = error;
  return json;
}

}  // namespace

std::string run_json(const ModelRun& run) { return json_of(run).dump(1); }

ModelRun run_of_json(const std::string& text) {
  const Json json = Json::parse(text);
  ModelRun run;
#define PALPATE_READ(key, member) json.at(key).get_to(run.member);
  PALPATE_RUN_VALUES(PALPATE_READ)
#undef PALPATE_READ
  json.at("depth_m").get_to(run.path.x);
  for (const Json& f : json.at("force_N")) run.path.force_N.push_back({f.at(0), f.at(1), f.at(2)});
  if (!json.contains("error")) return run;
  const Json& from = json.at("error");
  CurveError error;
#define PALPATE_READ(key, member) from.at(key).get_to(error.member);
  PALPATE_ERROR_VALUES(PALPATE_READ)
#undef PALPATE_READ
  run.error = error;
  return run;
}

std::string report_json(const std::vector<CaseReport>& cases, const ReportStamp& stamp) {
  Json all;
  all["date"] = stamp.date;
  all["build"] = stamp.build;
  all["machine"] = stamp.machine;
  for (const CaseReport& report : cases) {
    Json one;
    one["name"] = report.name;
    one["scene"] = report.scene;
    if (report.reference) {
      one["reference"]["solver"] = report.reference->solver;
      one["reference"]["mesh"] = report.reference->mesh;
      one["reference"]["made"] = report.reference->made;
      one["reference"]["uncertainty"] = report.reference->uncertainty();
    }
    for (const ModelRun& run : report.runs) one["models"].push_back(json_of(run));
    all["cases"].push_back(one);
  }
  return all.dump(1) + "\n";
}

std::string report_csv(const std::vector<CaseReport>& cases) {
  std::string text =
      "case,model,family,force_rms,force_largest,at_mm,stiffness_rms,stiffness_largest,direction_deg,energy,"
      "force_unnoticed,stiffness_unnoticed,surface_rms,surface_largest,surface_still_rms,step_N,slide_force_N,worst_"
      "instructions,mean_instructions,p50_us,p999_us,"
      "max_us,image_bytes,state_bytes,scratch_bytes,bake_s,unconverged_ticks,ticks,hash,refused\n";
  for (const CaseReport& report : cases)
    for (const ModelRun& run : report.runs) {
      const CurveError e = run.error.value_or(CurveError{});
      std::string refused = run.refused;
      for (char& c : refused)
        if (c == ',' || c == '\n' || c == '"') c = ';';
      text += fmt::format(
          "{},{},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{:.4g},{:.5g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.5g},{"
          "},{},{:.4g},{:.4g},"
          "{:.4g},{},{},{},{:.3g},{},{},{:016x},{}\n",
          report.name, run.name, run.family, e.force_rms, e.force_largest, 1e3 * e.at_largest, e.stiffness_rms,
          e.stiffness_largest, e.direction_rad * 180 / kPi, e.energy, e.force_unnoticed, e.stiffness_unnoticed,
          run.surface.rms, run.surface.largest, run.surface.still_rms, run.step_N, run.slide_force_N, run.count.worst,
          run.count.mean, run.p50_us, run.p999_us, run.max_us, run.image_bytes, run.state_bytes, run.scratch_bytes,
          run.bake_s, run.unconverged, run.ticks, run.hash, refused);
    }
  return text;
}

}  // namespace palpate
