#include "sim_host/record/recording_exports.h"

namespace palpate {

RecordingExports::RecordingExports(const ExportOptions& options) : tables_(options.ticks, options.regions) {
  if (!options.npz.empty()) arrays_.emplace(options.npz, options.period_ns);
  if (options.candump.empty()) return;
  CandumpOptions wire;
  wire.profile = options.classic ? WireProfile::kClassic : WireProfile::kFd;
  wire.node = options.node;
  candump_.emplace(wire);
  candump_file_.emplace(options.candump);
}

void RecordingExports::add(const TickRecord& record) {
  tables_.add(record);
  if (arrays_) arrays_->add(record);
  if (!candump_) return;
  std::string text;
  candump_->add(record, text);
  candump_file_->write(text);
}

void RecordingExports::finish() {
  tables_.finish();
  if (arrays_) arrays_->finish();
  if (candump_) candump_file_->finish();
}

}  // namespace palpate
