// VTK's XML unstructured grid (VTK User's Guide, "VTK file formats"), ASCII arrays.
#include <pugixml.hpp>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>

#include "config/fem/tet_io.h"
#include "config/fem/tet_numbering.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

constexpr int kTetrahedron = 10, kQuadraticTetrahedron = 24;
// VTK's solid cells (tetrahedra excepted): voxel, hexahedron, wedge, pyramid and the quadratic ones, Lagrange, Bezier.
bool is_other_solid(int type) { return (type >= 11 && type <= 14) || (type >= 25 && type <= 33) || type >= 41; }

class VtuReader {
 public:
  VtuReader(const std::string& path, double scale) : path_(path), scale_(scale) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw ConfigError(path + ": cannot be opened; check the path");
    text_.assign(std::istreambuf_iterator<char>(file), {});
  }

  TetFile read() {
    const pugi::xml_parse_result parsed = document_.load_buffer(text_.data(), text_.size());
    if (!parsed) fail(parsed.offset, std::string("not well-formed XML: ") + parsed.description());
    const pugi::xml_node root = document_.child("VTKFile");
    if (std::string(root.attribute("type").value()) != "UnstructuredGrid")
      fail(root.offset_debug(), "VTKFile of type \"UnstructuredGrid\" expected, found \"" +
                                    std::string(root.attribute("type").value()) + "\"");
    for (const pugi::xml_node piece : root.child("UnstructuredGrid").children("Piece")) add_piece(piece);
    if (tets_.empty()) fail(0, "the file holds no tetrahedra");
    return number_tets(numbers_, position_m_, tets_, other_elements_, [this](const std::string& w) { fail(0, w); });
  }

 private:
  [[noreturn]] void fail(std::ptrdiff_t offset, const std::string& what) const {
    const std::ptrdiff_t end = std::clamp(offset, std::ptrdiff_t{0}, static_cast<std::ptrdiff_t>(text_.size()));
    throw ConfigError(path_ + ":" + std::to_string(1 + std::count(text_.begin(), text_.begin() + end, '\n')) + ": " +
                      what);
  }
  template <class Number>
  std::vector<Number> numbers(const pugi::xml_node& array, const std::string& name) const {
    if (!array) fail(0, "there is no array \"" + name + "\"");
    if (const std::string format = array.attribute("format").value(); format != "ascii")
      fail(array.offset_debug(),
           "array \"" + name + "\" has the format \"" + format + "\"; save the file with data mode Ascii");
    std::istringstream stream(array.text().get());
    stream.imbue(std::locale::classic());
    std::vector<Number> out;
    Number value;
    while (stream >> value) out.push_back(value);
    if (!stream.eof()) fail(array.offset_debug(), "array \"" + name + "\" holds something that is not a number");
    return out;
  }
  pugi::xml_node cells(const pugi::xml_node& piece, const char* name) const {
    return piece.child("Cells").find_child_by_attribute("DataArray", "Name", name);
  }
  void add_piece(const pugi::xml_node& piece) {
    const auto first = static_cast<std::int64_t>(position_m_.size());
    const auto coordinates = numbers<double>(piece.child("Points").child("DataArray"), "Points");
    if (coordinates.size() % 3 != 0 || coordinates.size() / 3 != piece.attribute("NumberOfPoints").as_ullong())
      fail(piece.offset_debug(), std::to_string(coordinates.size()) + " coordinates for NumberOfPoints=\"" +
                                     piece.attribute("NumberOfPoints").value() + "\"; the file may be truncated");
    for (std::size_t i = 0; i < coordinates.size(); i += 3) {
      numbers_.push_back(static_cast<std::int64_t>(position_m_.size()));
      position_m_.push_back({scale_ * coordinates[i], scale_ * coordinates[i + 1], scale_ * coordinates[i + 2]});
    }
    const auto connectivity = numbers<std::int64_t>(cells(piece, "connectivity"), "connectivity");
    const auto offsets = numbers<std::int64_t>(cells(piece, "offsets"), "offsets");
    const auto types = numbers<int>(cells(piece, "types"), "types");
    if (offsets.size() != types.size() || types.size() != piece.attribute("NumberOfCells").as_ullong())
      fail(piece.offset_debug(), std::to_string(offsets.size()) + " offsets and " + std::to_string(types.size()) +
                                     " types for NumberOfCells=\"" + piece.attribute("NumberOfCells").value() + "\"");
    std::int64_t start = 0;
    for (std::size_t c = 0; c < types.size(); ++c) {
      if (offsets[c] < start || offsets[c] > static_cast<std::int64_t>(connectivity.size()))
        fail(piece.offset_debug(), "offset " + std::to_string(offsets[c]) + " of cell " + std::to_string(c) +
                                       " lies outside the connectivity");
      add_cell(piece, c, types[c], first, connectivity.data() + start, offsets[c] - start);
      start = offsets[c];
    }
  }
  void add_cell(const pugi::xml_node& piece, std::size_t cell, int type, std::int64_t first, const std::int64_t* node,
                std::int64_t count) {
    if (is_other_solid(type))
      fail(piece.offset_debug(), "cell " + std::to_string(cell) + " has type " + std::to_string(type) +
                                     "; allowed are tetrahedra of 4 and 10 nodes (types 10 and 24)");
    if (type != kTetrahedron && type != kQuadraticTetrahedron) {
      ++other_elements_;
      return;
    }
    FileTet tet;
    tet.nodes = type == kTetrahedron ? 4 : 10;
    if (count != tet.nodes)
      fail(piece.offset_debug(), "cell " + std::to_string(cell) + " has " + std::to_string(count) +
                                     " nodes; its type " + std::to_string(type) + " needs " +
                                     std::to_string(tet.nodes));
    for (std::int64_t k = 0; k < count; ++k) tet.number[static_cast<std::size_t>(k)] = first + node[k];
    tets_.push_back(tet);
  }

  std::string path_, text_;
  double scale_;
  pugi::xml_document document_;
  std::vector<std::int64_t> numbers_;
  std::vector<Vec3> position_m_;
  std::vector<FileTet> tets_;
  std::int32_t other_elements_ = 0;
};

}  // namespace

TetFile read_vtu(const std::string& path, double scale) { return VtuReader(path, scale).read(); }

TetFile read_tet_mesh(const std::string& path, double scale) {
  std::string extension = path.substr(std::min(path.rfind('.'), path.size()));
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".msh") return read_msh(path, scale);
  if (extension == ".vtu") return read_vtu(path, scale);
  throw ConfigError(path + ": the extension '" + extension +
                    "' is not one of a tetrahedral mesh; allowed .msh (Gmsh) and .vtu (VTK)");
}

}  // namespace palpate
