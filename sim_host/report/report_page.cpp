#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sim_host/report/case_report.h"

namespace palpate {

namespace {

std::string html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string inline_svg(const Drawing& drawing) {
  const std::string svg = drawing.svg();
  return svg.substr(svg.find("<svg"));
}

constexpr const char* kStyle = R"(body{font:15px/1.5 Helvetica,Arial,"DejaVu Sans",sans-serif;color:#1f2933;
max-width:1180px;margin:2em auto;padding:0 1em}h1{font-size:26px}h2{margin-top:2.2em;border-top:1px solid #dde2e8;
padding-top:1em;font-size:20px}table{border-collapse:collapse;font-size:13px;margin:1em 0}
td,th{padding:4px 9px;text-align:right;border-bottom:1px solid #e8ecf0;vertical-align:top}
th{color:#66717d;font-weight:600}td:first-child,th:first-child{text-align:left;white-space:nowrap}
td.wide{text-align:left;color:#66717d;max-width:640px}.good{color:#1f7a50;font-weight:600}.bad{color:#b3261e}
p.note{color:#66717d;max-width:900px}svg{max-width:100%;height:auto}.pair{display:flex;flex-wrap:wrap;gap:8px}
.pair>div{flex:1 1 540px}code{background:#f2f4f7;padding:1px 4px})";

std::string surface_text(const ModelRun& run) {
  return run.surface.still_rms > 0 ? fmt::format("{:.1f} / {:.1f}", 100 * run.surface.rms, 100 * run.surface.largest)
                                   : "-";
}
std::string per_cent(double share, int digits = 1) { return fmt::format("{:.{}f}", 100 * share, digits); }
std::string thousands(std::int64_t value) {
  std::string text = std::to_string(value);
  for (std::ptrdiff_t at = std::ssize(text) - 3; at > 0; at -= 3) text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

const ModelRun* cheapest_unfelt(const CaseReport& report) {
  const ModelRun* best = nullptr;
  const auto cost = [](const ModelRun& run) {
    return run.count.counted ? static_cast<double>(run.count.worst) : run.p50_us;
  };
  for (const ModelRun& run : report.runs) {
    if (!run.refused.empty() || !run.error || std::abs(run.error->force_largest) > kForceNoticed) continue;
    if (best == nullptr || cost(run) < cost(*best)) best = &run;
  }
  return best;
}
const ModelRun* most_exact(const CaseReport& report) {
  const ModelRun* best = nullptr;
  for (const ModelRun& run : report.runs)
    if (run.refused.empty() && run.error && (best == nullptr || run.error->force_rms < best->error->force_rms))
      best = &run;
  return best;
}

std::string run_row(const ModelRun& run) {
  std::string row = "<tr><td title=\"" + html(run.meaning) + "\">" + run.name + "</td>";
  if (!run.refused.empty())
    return row + "<td class=wide colspan=14>not for this case: " + html(run.refused) + "</td></tr>\n";
  if (run.error) {
    const CurveError& e = *run.error;
    const char* grade = std::abs(e.force_largest) <= kForceNoticed ? " class=good"
                        : e.force_rms > 0.2                        ? " class=bad"
                                                                   : "";
    row += fmt::format("<td{}>{}</td><td{}>{}</td><td>{}</td><td>{}</td><td>{:.1f}</td><td>{}</td><td>{}</td>", grade,
                       per_cent(e.force_rms), grade, per_cent(e.force_largest), per_cent(e.stiffness_rms),
                       per_cent(e.stiffness_largest), e.direction_rad * 180 / kPi, per_cent(e.energy),
                       per_cent(e.force_unnoticed, 0));
  } else {
    row += "<td colspan=7></td>";
  }
  row += "<td>" + surface_text(run) + "</td>";
  row += fmt::format("<td>{:.2f}</td><td>{}</td><td>{:.1f}</td><td>{:.1f}</td><td>{:.2f}</td><td>{:.2f}</td></tr>\n",
                     1e3 * run.step_N, run.count.counted ? thousands(run.count.worst) : "-", run.p50_us, run.p999_us,
                     static_cast<double>(run.image_bytes) / 1e6, run.bake_s);
  return row;
}

std::string model_table(const CaseReport& report) {
  std::string text =
      "<table><tr><th>model</th><th>force RMS %</th><th>largest %</th><th>stiffness RMS %</th><th>largest %</th>"
      "<th>direction &deg;</th><th>energy %</th><th>path not felt %</th><th>surface RMS / largest %</th><th>step "
      "mN</th><th>worst tick, instr.</th>"
      "<th>p50 &micro;s</th><th>p99.9</th><th>image MB</th><th>bake s</th></tr>\n";
  for (const ModelRun& run : report.runs) text += run_row(run);
  return text + "</table>\n";
}

std::string stage_table(const CaseReport& report) {
  std::string text =
      "<details><summary>Stages of the worst tick, memory, determinism</summary><table><tr><th>model</th>";
#define PALPATE_NAME(name, function, shown, what) text += "<th title=\"" what "\">" shown "</th>";
  PALPATE_STAGES(PALPATE_NAME)
#undef PALPATE_NAME
  text += "<th>State kB</th><th>Scratch kB</th><th>not converged</th><th>beyond range</th><th>hash</th></tr>\n";
  for (const ModelRun& run : report.runs) {
    if (!run.refused.empty()) continue;
    text += "<tr><td>" + run.name + "</td>";
    for (const std::int64_t stage : run.count.worst_stage) text += "<td>" + thousands(stage) + "</td>";
    text += fmt::format("<td>{}</td><td>{}</td><td>{} of {}</td><td>{}</td><td><code>{:016x}</code></td></tr>\n",
                        run.state_bytes / 1000, run.scratch_bytes / 1000, run.unconverged, run.ticks, run.beyond_range,
                        run.hash);
  }
  return text + "</table></details>\n";
}

std::string case_section(const CaseReport& report) {
  std::string text = fmt::format(
      "<h2 id=\"{0}\">{0}</h2>\n<p>{1}</p><p class=note>Ball of radius {2:.3g} mm at ({3:.4g}, {4:.4g}, {5:.4g}) mm, "
      "{6:.3g} "
      "mm "
      "deep.",
      report.name, html(report.about), 1e3 * report.press.radius_m, 1e3 * report.press.place_m.x,
      1e3 * report.press.place_m.y, 1e3 * report.press.place_m.z, 1e3 * report.press.depth_m);
  if (report.reference)
    text += fmt::format(" Reference: {}; {}; the meshes differ by {} % at most; made {}.",
                        html(report.reference->solver), html(report.reference->mesh),
                        per_cent(report.reference->uncertainty()), html(report.reference->made));
  else
    text += " No reference: costs and forces only. <code>--solve</code> makes one.";
  text += "</p>\n";
  if (report.reference)
    text += "<div class=pair><div>" + inline_svg(pareto_plot({report}, report.name + ": error against cost")) +
            "</div><div>" + inline_svg(error_plot(report)) + "</div></div>\n";
  text += "<div>" + inline_svg(force_plot(report)) + "</div>\n";
  return text + model_table(report) + stage_table(report);
}

// In which models the case has an answer, and which is the cheapest that a hand cannot tell from it.
std::string summary_table(const std::vector<CaseReport>& cases) {
  std::string text =
      "<table><tr><th>case</th><th>reference good to %</th><th>most exact</th><th>RMS %</th><th>largest %</th>"
      "<th>instr.</th><th>cheapest below 7 % everywhere</th><th>largest %</th><th>instr.</th></tr>\n";
  for (const CaseReport& report : cases) {
    if (!report.reference) continue;
    const ModelRun *best = most_exact(report), *cheap = cheapest_unfelt(report);
    text += fmt::format("<tr><td><a href=\"#{0}\">{0}</a></td><td>{1}</td>", report.name,
                        per_cent(report.reference->uncertainty()));
    if (best == nullptr) text += "<td colspan=7>no model takes it</td>";
    if (best != nullptr)
      text += fmt::format("<td>{}</td><td>{}</td><td>{}</td><td>{}</td>", best->name, per_cent(best->error->force_rms),
                          per_cent(best->error->force_largest), thousands(best->count.worst));
    if (best != nullptr && cheap != nullptr)
      text += fmt::format("<td>{}</td><td>{}</td><td>{}</td>", cheap->name, per_cent(cheap->error->force_largest),
                          thousands(cheap->count.worst));
    if (best != nullptr && cheap == nullptr) text += "<td class=bad colspan=3>none</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

}  // namespace

std::string report_html(const std::vector<CaseReport>& cases, const ReportStamp& stamp) {
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=en><head><meta charset=utf-8><title>Palpate: speed against error</title>"
      "<style>{}</style></head><body>\n<h1>Speed against error</h1>\n<p class=note>{} &middot; {} &middot; {}</p>\n",
      kStyle, html(stamp.date), html(stamp.build), html(stamp.machine));
  text +=
      "<p>Each case is one body, held as its scene says, pressed by one frictionless ball, and solved by every model "
      "that "
      "takes it. Errors are those of the force on the ball against large-strain finite elements, relative to the force "
      "there but to no less than 5 % of the largest. A hand notices 6 to 7 % of a force and about 15 % of a stiffness; "
      "<i>path not felt</i> is the share of the path below 7 %. <i>Step</i> is the largest change from one tick to the "
      "next beyond the trend, sliding 0.02 mm a tick at half the depth. Instructions are counted by callgrind over "
      "the whole path but its first tick; times are the least of repeats of each tick "
      "on the machine above, "
      "beside whatever else it did.</p>\n";
  const bool several = std::ranges::count_if(cases, [](const CaseReport& c) { return c.reference.has_value(); }) > 1;
  if (several) text += summary_table(cases) + inline_svg(pareto_plot(cases, "All cases: error against cost"));
  for (const CaseReport& report : cases) text += case_section(report);
  text += "<h2>Models</h2>\n<table>\n";
  for (const ModelVariant& variant : model_variants())
    text += fmt::format("<tr><td>{}</td><td class=wide>{}</td></tr>\n", variant.name, html(variant.meaning));
  return text + "</table></body></html>\n";
}

std::string report_markdown(const std::vector<CaseReport>& cases, const ReportStamp& stamp) {
  std::string text = fmt::format("Made on {} by `palpate report`, {}.\n", stamp.date, stamp.build);
  for (const CaseReport& report : cases) {
    if (!report.reference) continue;
    text += fmt::format(
        "\n### {}\n{} Ball of radius {:.3g} mm, {:.3g} mm deep; the reference's meshes differ by {} %.\n\n"
        "| model | force RMS / largest, % | stiffness RMS, % | direction, degrees | path not felt, % | surface RMS / "
        "largest, % | "
        "step, mN | "
        "worst "
        "tick, instructions | image, MB | bake, s |\n|---|---|---|---|---|---|---|---|---|---|\n",
        report.name, report.about, 1e3 * report.press.radius_m, 1e3 * report.press.depth_m,
        per_cent(report.reference->uncertainty()));
    for (const ModelRun& run : report.runs) {
      if (!run.refused.empty() || !run.error) continue;
      const CurveError& e = *run.error;
      text += fmt::format("| {} | {} / {} | {} | {:.1f} | {} | {} | {:.2f} | {} | {:.2f} | {:.1f} |\n", run.name,
                          per_cent(e.force_rms), per_cent(e.force_largest), per_cent(e.stiffness_rms),
                          e.direction_rad * 180 / kPi, per_cent(e.force_unnoticed, 0), surface_text(run),
                          1e3 * run.step_N, run.count.counted ? thousands(run.count.worst) : "-",
                          static_cast<double>(run.image_bytes) / 1e6, run.bake_s);
    }
  }
  return text;
}

}  // namespace palpate
