#include "sim_host/record/record_csv.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "sim_host/status_text.h"

namespace palpate {

RecordCsv::RecordCsv(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {
  if (file_ == nullptr) throw std::runtime_error(fmt::format("{}: cannot create: {}", path, std::strerror(errno)));
  fmt::print(
      file_,
      "tick,deadline_ns,wake_latency_ns,receive_ns,compute_ns,transmit_ns,publish_ns,stale_ticks,overrun_ticks,"
      "commands,x_m,y_m,z_m,qw,qx,qy,qz,tool_x_m,tool_y_m,tool_z_m,device_fx_N,device_fy_N,device_fz_N,"
      "device_tx_Nm,device_ty_Nm,device_tz_Nm,contact_fx_N,contact_fy_N,contact_fz_N,penetration_m,energy_J,ramp,"
      "mode,regions,contacts,status,fault,state_hash\n");
}

RecordCsv::~RecordCsv() { std::fclose(file_); }

void RecordCsv::add(const TickRecord& record) {
  const TickTiming& t = record.timing;
  const Input& in = record.input;
  const Output& out = record.output;
  const auto vec = [](Vec3 v) { return fmt::format("{:.9g},{:.9g},{:.9g}", v.x, v.y, v.z); };
  const Quat& q = in.pose_w.orientation;
  fmt::print(file_, "{},{},{},{},{},{},{},{},{},{:#x},{},{:.9g},{:.9g},{:.9g},{:.9g},{},{},{},{},", record.tick,
             t.deadline_ns, t.wake_latency_ns, t.receive_ns, t.compute_ns, t.transmit_ns, t.publish_ns, in.stale_ticks,
             in.overrun_ticks, in.commands, vec(in.pose_w.position_m), q.w, q.x, q.y, q.z, vec(out.tool_w.position_m),
             vec(out.device_w.force_N), vec(out.device_w.torque_Nm), vec(out.contact_w.force_N));
  fmt::print(file_, "{:.9g},{:.9g},{:.9g},{},{},{},{:#x},{:#x},{:016x}\n", out.penetration_m, out.energy_J, out.ramp,
             mode_name(out.mode), out.regions, out.contacts, out.status, out.fault, record.state_hash);
}

}  // namespace palpate
