// Which machine a measurement was made on: what must stand beside every latency figure.
#pragma once

#include <string>
#include <vector>

#include "sim_host/doctor/doctor.h"

namespace palpate {

struct MachineIdentity {
  std::string host, cpu_model, kernel, kernel_version, boot_options, governor, isolated_cpus, microcode;
  int cpus = 0;
  bool realtime_kernel = false;
  std::vector<DoctorItem> checks;  // the doctor's, machine and device
};

// Reads it below sources.root (tests: a made-up machine); `device` as `palpate run --device` takes it.
MachineIdentity identify_machine(const DoctorSources& sources, const std::string& device);

}  // namespace palpate
