// `palpate compare`: how far one force curve is from another.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "sim_host/cli.h"
#include "sim_host/cli_checks.h"
#include "sim_host/json_output.h"
#include "sim_host/report/read_path.h"

namespace palpate {

namespace {

struct CompareCommand {
  std::string reference, other, over = "auto";
  double tolerance_percent = 100 * kForceNoticed;
  bool json = false;
};

Abscissa abscissa_of(const std::string& word) {
  if (word == "depth") return Abscissa::kDepth;
  if (word == "time") return Abscissa::kTime;
  return word == "row" ? Abscissa::kRow : Abscissa::kAny;
}

struct Unit {
  const char* name;
  double scale;
};
Unit unit_of(Abscissa over) {
  if (over == Abscissa::kDepth) return {"mm depth", 1e3};
  return over == Abscissa::kTime ? Unit{"s", 1} : Unit{"rows", 1};
}

void fill(Json& json, const CurveError& e, const Unit& unit, bool within) {
  json["over"] = unit.name;
  json["from"] = unit.scale * e.from;
  json["to"] = unit.scale * e.to;
  json["points"] = e.x.size();
  json["force_rms"] = e.force_rms;
  json["force_largest"] = e.force_largest;
  json["at"] = unit.scale * e.at_largest;
  json["stiffness_rms"] = e.stiffness_rms;
  json["stiffness_largest"] = e.stiffness_largest;
  json["direction_deg"] = e.direction_rad * 180 / kPi;
  json["energy"] = e.energy;
  json["force_unnoticed"] = e.force_unnoticed;
  json["stiffness_unnoticed"] = e.stiffness_unnoticed;
  json["within_tolerance"] = within;
}

std::string table_text(const CurveError& e, const Unit& unit, const CompareCommand& command, bool within) {
  std::string text = fmt::format("compared  {} points from {:.4g} to {:.4g} {}\n", e.x.size(), unit.scale * e.from,
                                 unit.scale * e.to, unit.name);
  text += fmt::format("force     RMS {:.2f} %, largest {:+.2f} % at {:.4g}; {:.0f} % of the path below {:.0f} %\n",
                      100 * e.force_rms, 100 * e.force_largest, unit.scale * e.at_largest, 100 * e.force_unnoticed,
                      100 * kForceNoticed);
  text += fmt::format("slope     RMS {:.2f} %, largest {:+.2f} %; {:.0f} % of the path below {:.0f} %\n",
                      100 * e.stiffness_rms, 100 * e.stiffness_largest, 100 * e.stiffness_unnoticed,
                      100 * kStiffnessNoticed);
  text += fmt::format("direction {:.2f} degrees at most\narea      {:+.2f} %\n", e.direction_rad * 180 / kPi,
                      100 * e.energy);
  return text + fmt::format("verdict   {}: largest error of the force {} {:g} %\n", within ? "ok" : "DIFFERENT",
                            within ? "within" : "above", command.tolerance_percent);
}

int run_compare(const CompareCommand& command, Json& json) {
  const CsvTable reference = read_csv_table(command.reference), other = read_csv_table(command.other);
  const Abscissa over = common_abscissa(reference, other, abscissa_of(command.over));
  const bool vectors = reference.has("fx_N") && other.has("fx_N");
  const CurveError error = curve_error(path_of(reference, over, vectors), path_of(other, over, vectors));
  const bool within = std::abs(error.force_largest) <= command.tolerance_percent / 100;
  const Unit unit = unit_of(over);
  fill(json, error, unit, within);
  fmt::print("{}", table_text(error, unit, command, within));
  return within ? kExitOk : kExitFailed;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareCommand>();
  CLI::App* command = app.add_subcommand("compare", "How far one force curve is from another, in what a hand can tell");
  command->add_option("REFERENCE", options->reference, "table (CSV) to compare with")->required();
  command->add_option("OTHER", options->other, "table (CSV) that is judged")->required();
  command
      ->add_option("--over", options->over,
                   "what both curves run over; auto: depth_mm or penetration_mm, else time_s, else the rows")
      ->capture_default_str()
      ->check(CLI::IsMember({"auto", "depth", "time", "row"}));
  command
      ->add_option("--tolerance", options->tolerance_percent,
                   "largest error of the force, %; above it the exit code is 1")
      ->capture_default_str()
      ->check(number_in(0, 1e6));
  add_json_flag(*command, options->json);
  command->footer(
      "Forces are fx_N, fy_N, fz_N, or one number in force_N or f_N: tables of `palpate press`, of recordings, of "
      "measurements.\nErrors are relative to the reference there, but to no less than 5 % of its largest force. Over a "
      "depth the curve is\nthe first press: rows in which the depth does not grow are left out.\n"
      "Examples:\n"
      "  palpate compare measured.csv forces.csv --tolerance 3\n"
      "  palpate compare before.csv after.csv --over time --json");
  command->callback([options, &exit_code] {
    exit_code = run_with_json(options->json, "compare", [&](Json& json) { return run_compare(*options, json); });
  });
}

}  // namespace palpate
