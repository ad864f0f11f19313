// What `palpate replay` writes beside its verdict: ticks and regions as tables, the traffic as CAN frames.
#pragma once

#include <optional>
#include <string>

#include "sim_host/record/candump_log.h"
#include "sim_host/record/record_csv.h"
#include "sim_host/record/record_npz.h"
#include "sim_host/record/text_file.h"

namespace palpate {

struct ExportOptions {
  std::string ticks, regions, candump;  // files; "": not written
  bool classic = false;                 // candump: frames of the classic profile
  int node = 1;
  std::string npz;  // file; "": not written
  std::int64_t period_ns = 0;
};

class RecordingExports {
 public:
  explicit RecordingExports(const ExportOptions& options);
  void add(const TickRecord& record);
  void finish();

 private:
  RecordCsv tables_;
  std::optional<RecordNpz> arrays_;
  std::optional<CandumpLog> candump_;
  std::optional<TextFile> candump_file_;
};

}  // namespace palpate
