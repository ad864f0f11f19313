#include "sim_host/press/force_csv.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "sim_host/status_text.h"

namespace palpate {

namespace {

const char* friction_name(std::int32_t mode) {
  switch (static_cast<FrictionMode>(mode)) {
    case FrictionMode::kFree:
      return "free";
    case FrictionMode::kStick:
      return "stick";
    case FrictionMode::kSlip:
      return "slip";
  }
  return "?";
}

// One region: id, centre, force, equivalent depth, friction, tool points in contact.
std::string region_cells(const RegionRecord& r, char separator) {
  return fmt::format("{1}{0}{2:.9g}{0}{3:.9g}{0}{4:.9g}{0}{5:.12g}{0}{6:.12g}{0}{7:.12g}{0}{8:.9g}{0}{9}{0}{10}",
                     separator, r.id, r.centre_w.x * 1e3, r.centre_w.y * 1e3, r.centre_w.z * 1e3, r.force_w.x,
                     r.force_w.y, r.force_w.z, r.depth_equivalent_m * 1e3, friction_name(r.friction), r.point_count);
}

}  // namespace

std::string force_csv_header() {
  std::string text =
      "tick,time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,fx_N,fy_N,fz_N,f_N,tx_Nm,ty_Nm,tz_Nm,penetration_mm,energy_J,residual_m,"
      "contacts,regions,status_hex,status,fault_hex,fault,compute_ns,instructions";
  for (int k = 1; k <= kRegionColumns; ++k) {
    text += fmt::format(
        ",r{0}_id,r{0}_x_mm,r{0}_y_mm,r{0}_z_mm,r{0}_fx_N,r{0}_fy_N,r{0}_fz_N,r{0}_depth_mm,r{0}_friction,r{0}_points",
        k);
  }
  return text + ",more_regions";
}

std::string force_csv_row(const PressRow& row) {
  const TickRecord& record = row.record;
  const Output& o = record.output;
  const Vec3 x = o.tool_w.position_m, f = o.contact_w.force_N, t = o.contact_w.torque_Nm;
  const Quat q = o.tool_w.orientation;
  std::string text = fmt::format("{},{:.9g},{:.9g},{:.9g},{:.9g},{:.12g},{:.12g},{:.12g},{:.12g}", record.tick,
                                 row.time_s, x.x * 1e3, x.y * 1e3, x.z * 1e3, q.w, q.x, q.y, q.z);
  const auto out = std::back_inserter(text);
  fmt::format_to(out, ",{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g}", f.x, f.y, f.z, norm(f), t.x, t.y,
                 t.z);
  fmt::format_to(out, ",{:.9g},{:.12g},{:.3g},{},{}", o.penetration_m * 1e3, o.energy_J, o.residual_m, o.contacts,
                 o.regions);
  fmt::format_to(out, ",0x{:08x},{},0x{:08x},{}", o.status, bit_names(status_bit_texts(), o.status), o.fault,
                 bit_names(fault_bit_texts(), o.fault));
  fmt::format_to(out, ",{},{}", row.compute_ns, row.instructions >= 0 ? std::to_string(row.instructions) : "");
  for (int k = 0; k < kRegionColumns; ++k) {
    text += ',' + (k < record.region_count ? region_cells(record.region[k], ',') : std::string(9, ','));
  }
  text += ',';
  for (int k = kRegionColumns; k < record.region_count; ++k) {
    text += (k > kRegionColumns ? ";" : "") + region_cells(record.region[k], ' ');
  }
  return text;
}

ForceCsv::ForceCsv(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (file_ == nullptr) throw std::runtime_error(fmt::format("{}: cannot write: {}", path, std::strerror(errno)));
  fmt::print(file_, "{}\n", force_csv_header());
}

ForceCsv::~ForceCsv() {
  if (file_ != nullptr) std::fclose(file_);
}

void ForceCsv::add(const PressRow& row) { fmt::print(file_, "{}\n", force_csv_row(row)); }

void ForceCsv::finish() {
  const bool failed = std::ferror(file_) != 0;
  const bool not_closed = std::fclose(file_) != 0;
  file_ = nullptr;
  if (failed || not_closed) throw std::runtime_error(fmt::format("{}: cannot write: {}", path_, std::strerror(errno)));
}

}  // namespace palpate
