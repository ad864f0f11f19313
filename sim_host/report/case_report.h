// What `palpate report` says of one case: every model's run on it, and how it is written.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim_host/report/model_run.h"
#include "sim_host/view/drawing.h"

namespace palpate {

struct CaseReport {
  std::string name, about, scene;  // about: the scene file's first comment
  PressPlace press;
  std::optional<ReferenceCurve> reference;
  std::vector<ModelRun> runs;
};

// Runs as they are kept between reports, so that one that was interrupted goes on where it was.
std::string run_json(const ModelRun& run);
ModelRun run_of_json(const std::string& text);  // throws std::exception

// Error against instructions of the worst tick, or microseconds where nothing was counted; and error along the path.
Drawing pareto_plot(const std::vector<CaseReport>& cases, const std::string& title);
Drawing error_plot(const CaseReport& report);
Drawing force_plot(const CaseReport& report);

// Which machine the times are from, and when.
struct ReportStamp {
  std::string date, build, machine;
};
std::string report_html(const std::vector<CaseReport>& cases, const ReportStamp& stamp);
std::string report_csv(const std::vector<CaseReport>& cases);
std::string report_json(const std::vector<CaseReport>& cases, const ReportStamp& stamp);
// Tables for docs/accuracy.md.
std::string report_markdown(const std::vector<CaseReport>& cases, const ReportStamp& stamp);

}  // namespace palpate
