#include "sim_host/view/vtu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace palpate {

namespace {

// A VTK inline binary block: its length in bytes as a 32-bit number, then the data, both in one base64 text.
template <typename T>
std::string encoded(const std::vector<T>& values) {
  const auto length = static_cast<std::uint32_t>(values.size() * sizeof(T));
  std::vector<std::uint8_t> bytes(sizeof length + length);
  std::memcpy(bytes.data(), &length, sizeof length);
  if (length > 0) std::memcpy(bytes.data() + sizeof length, values.data(), length);
  return base64(bytes);
}

template <typename T>
std::string array(const char* type, const char* name, int components, const std::vector<T>& values) {
  return fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n",
                     type, name, components, encoded(values));
}

void append(std::vector<float>& list, Vec3 v) {
  list.push_back(static_cast<float>(v.x));
  list.push_back(static_cast<float>(v.y));
  list.push_back(static_cast<float>(v.z));
}

void append(std::vector<double>& list, Vec3 v) { list.insert(list.end(), {v.x, v.y, v.z}); }

struct Cells {
  std::vector<std::int32_t> connectivity, offsets;
  std::vector<std::uint8_t> types;
};

// A cell of its own for each point.
Cells dots(std::size_t points) {
  constexpr std::uint8_t kVertexCell = 1;
  Cells cells;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(points); ++i) {
    cells.connectivity.push_back(i);
    cells.offsets.push_back(i + 1);
    cells.types.push_back(kVertexCell);
  }
  return cells;
}

template <typename Number>
std::string grid(std::size_t points, const std::vector<Number>& position, const Cells& cells,
                 const std::string& point_data) {
  constexpr const char* kNumber = sizeof(Number) == 8 ? "Float64" : "Float32";
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt32\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<PointData>\n{}"
      "</PointData>\n<Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
      points, cells.types.size(), point_data, array(kNumber, "Points", 3, position),
      array("Int32", "connectivity", 1, cells.connectivity), array("Int32", "offsets", 1, cells.offsets),
      array("UInt8", "types", 1, cells.types));
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + ": cannot write");
}

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < left ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= left ? kDigit[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string surface_vtu(const Model& model, const DeformedSurface& surface) {
  constexpr std::uint8_t kTriangleCell = 5;
  std::vector<float> position, displacement, magnitude, normal;
  for (std::size_t i = 0; i < model.vertex_m.size(); ++i) {
    append(position, model.vertex_m[i]);
    append(displacement, surface.displacement_m[i]);
    append(normal, surface.normal[i]);
    magnitude.push_back(static_cast<float>(norm(surface.displacement_m[i]) * 1e3));
  }
  Cells cells;
  for (const Triangle& t : model.triangle) {
    for (const std::int32_t v : t.vertex) cells.connectivity.push_back(v);
    cells.offsets.push_back(static_cast<std::int32_t>(cells.connectivity.size()));
    cells.types.push_back(kTriangleCell);
  }
  return grid(model.vertex_m.size(), position, cells,
              array("Float32", "displacement_m", 3, displacement) +
                  array("Float32", "displacement_magnitude_mm", 1, magnitude) + array("Float32", "normal", 3, normal));
}

std::string anchors_vtu(const Model& model, const AnchorField& field) {
  std::vector<float> position, displacement, stress, axial, shear;
  std::vector<std::uint8_t> fixed;
  for (std::size_t i = 0; i < model.anchor.size(); ++i) {
    append(position, model.anchor[i].position_m);
    append(displacement, field.anchor[i].displacement_w);
    stress.push_back(static_cast<float>(field.anchor[i].stress_Pa));
    axial.push_back(static_cast<float>(field.anchor[i].axial_stress_Pa));
    shear.push_back(static_cast<float>(field.anchor[i].shear_stress_Pa));
    fixed.push_back(model.anchor[i].fixed != 0 ? 1 : 0);
  }
  return grid(model.anchor.size(), position, dots(model.anchor.size()),
              array("Float32", "displacement_m", 3, displacement) + array("Float32", "stress_Pa", 1, stress) +
                  array("Float32", "axial_stress_Pa", 1, axial) + array("Float32", "shear_stress_Pa", 1, shear) +
                  array("UInt8", "fixed", 1, fixed));
}

std::string regions_vtu(std::span<const RegionRecord> regions) {
  std::vector<double> position, force, normal, depth;
  std::vector<std::uint32_t> id;
  std::vector<std::int32_t> friction;
  for (const RegionRecord& region : regions) {
    append(position, region.centre_w);
    append(force, region.force_w);
    append(normal, region.normal_w);
    depth.push_back(region.depth_equivalent_m);
    id.push_back(region.id);
    friction.push_back(region.friction);
  }
  return grid(regions.size(), position, dots(regions.size()),
              array("Float64", "force_N", 3, force) + array("Float64", "normal", 3, normal) +
                  array("Float64", "depth_equivalent_m", 1, depth) + array("UInt32", "id", 1, id) +
                  array("Int32", "friction", 1, friction));
}

VtuSeries::VtuSeries(const std::string& folder) : folder_(folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot create folder: {}", folder, error.message()));
}

void VtuSeries::add(const Model& model, const State& state, const TickRecord& record, double time_s) {
  const std::size_t n = times_s_.size();
  write_file(fmt::format("{}/surface_{:06}.vtu", folder_, n), surface_vtu(model, deformed_surface(model, state)));
  write_file(fmt::format("{}/anchors_{:06}.vtu", folder_, n), anchors_vtu(model, anchors_of(model, state)));
  const auto regions = static_cast<std::size_t>(std::clamp(record.region_count, 0, kMaxRegions));
  write_file(fmt::format("{}/regions_{:06}.vtu", folder_, n), regions_vtu(std::span(record.region).first(regions)));
  times_s_.push_back(time_s);
}

void VtuSeries::finish() const {
  for (const char* name : {"surface", "anchors", "regions"}) {
    std::string text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
        "byte_order=\"LittleEndian\">\n<Collection>\n";
    for (std::size_t n = 0; n < times_s_.size(); ++n) {
      text += fmt::format("<DataSet timestep=\"{:.9g}\" part=\"0\" file=\"{}_{:06}.vtu\"/>\n", times_s_[n], name, n);
    }
    write_file(fmt::format("{}/{}.pvd", folder_, name), text + "</Collection>\n</VTKFile>\n");
  }
}

}  // namespace palpate
