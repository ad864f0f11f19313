// Gmsh's ASCII mesh formats (Gmsh reference manual, "MSH file format": 2.2 legacy, 4.1).
#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "config/fem/tet_io.h"
#include "config/fem/tet_numbering.h"
#include "config/scene/config_error.h"

namespace palpate {

namespace {

// Words of a file with the line they stand on.
class Words {
 public:
  Words(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {}

  bool next(std::string& word) {
    while (at_ < text_.size() && is_space(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    word = text_.substr(start, at_ - start);
    return !word.empty();
  }
  std::string word(const char* what) {
    std::string w;
    if (!next(w)) fail(std::string("the file ends where ") + what + " should follow; it may be truncated");
    return w;
  }
  // What stands between two quotes.
  std::string quoted(const char* what) {
    std::string text = word(what);
    while (text.size() < 2 || text.back() != '"') text += " " + word(what);
    if (text.front() != '"') fail("'" + text + "' stands where " + what + " should be");
    return text.substr(1, text.size() - 2);
  }
  template <class Number>
  Number number(const char* what) {
    const std::string w = word(what);
    std::istringstream stream(w);
    stream.imbue(std::locale::classic());
    Number value{};
    if (!(stream >> value) || !stream.eof()) fail("'" + w + "' stands where " + what + " should be");
    return value;
  }
  std::int64_t count(const char* what) {
    const auto n = number<std::int64_t>(what);
    // A count larger than the file has bytes cannot be true: refuse before reserving memory for it.
    if (n < 0 || n > static_cast<std::int64_t>(text_.size()))
      fail(std::string(what) + " is " + std::to_string(n) + ", which the file cannot hold");
    return n;
  }
  void end_section(const std::string& name) {
    if (const std::string w = word("the end of a section"); w != "$End" + name)
      fail("'" + w + "' stands where $End" + name + " should be");
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw ConfigError(path_ + ":" + std::to_string(line_) + ": " + what);
  }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
  std::string path_, text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

// Nodes per element of the types we know; 0: a solid we cannot use. Types 15, 1, 2, 3, 8, 9, 10, 16, 26, 20, 21, 27:
// points, lines, triangles and quadrangles.
struct ElementType {
  std::int32_t type, nodes;
  bool skipped;
};
constexpr std::array<ElementType, 14> kElementTypes{{{4, 4, false},
                                                     {11, 10, false},
                                                     {15, 1, true},
                                                     {1, 2, true},
                                                     {8, 3, true},
                                                     {26, 4, true},
                                                     {27, 5, true},
                                                     {2, 3, true},
                                                     {9, 6, true},
                                                     {20, 9, true},
                                                     {21, 10, true},
                                                     {3, 4, true},
                                                     {10, 9, true},
                                                     {16, 8, true}}};

class MshReader {
 public:
  MshReader(const std::string& path, std::string text, double scale) : in_(path, std::move(text)), scale_(scale) {}

  TetFile read() {
    std::string word;
    while (in_.next(word)) {
      if (word == "$MeshFormat")
        format();
      else if (word == "$Nodes")
        version_ == 4 ? nodes_4() : nodes_2();
      else if (word == "$PhysicalNames")
        names();
      else if (word == "$Entities" && version_ == 4)
        entities_4();
      else if (word == "$Elements")
        version_ == 4 ? elements_4() : elements_2();
      else if (word.front() == '$')
        skip(word.substr(1));
      else
        in_.fail("'" + word + "' stands outside a section; is this a Gmsh mesh?");
    }
    if (version_ == 0) in_.fail("there is no $MeshFormat; is this a Gmsh mesh?");
    if (elements_.empty()) in_.fail("the file holds no tetrahedra; mesh in three dimensions (gmsh -3) and save again");
    TetFile file =
        number_tets(numbers_, position_m_, elements_, other_elements_, [this](const std::string& w) { in_.fail(w); });
    for (auto& [number, name] : file.mesh.group_name)
      if (const auto named = volume_name_.find(number); named != volume_name_.end()) name = named->second;
    return file;
  }

 private:
  void format() {
    const std::string version = in_.word("the format's version");
    if (in_.number<int>("the file type") != 0)
      in_.fail("the mesh is binary; save it as ASCII: gmsh FILE -save -format msh22 -o NEW");
    if (version != "2.2" && version != "4.1")
      in_.fail("mesh format " + version +
               " is not supported; allowed 2.2 and 4.1: gmsh FILE -save -format msh41 -o NEW");
    version_ = version == "2.2" ? 2 : 4;
    in_.word("the size of a number");
    in_.end_section("MeshFormat");
  }
  void skip(const std::string& name) {
    std::string word;
    while (in_.next(word))
      if (word == "$End" + name) return;
    in_.fail("section $" + name + " has no end; the file may be truncated");
  }
  void need_format() {
    if (version_ == 0) in_.fail("$MeshFormat must come first");
  }
  Vec3 position() {
    Vec3 p;
    for (double* c : {&p.x, &p.y, &p.z}) *c = scale_ * in_.number<double>("a node's coordinate");
    return p;
  }
  void names() {
    for (auto n = in_.count("the number of physical names"); n > 0; --n) {
      const auto dimension = in_.number<int>("a physical group's dimension");
      const auto number = in_.number<std::int32_t>("a physical group's number");
      const std::string name = in_.quoted("a physical group's name");
      if (dimension == 3) volume_name_[number] = name;
    }
    in_.end_section("PhysicalNames");
  }
  // Of the geometry's volumes, to which physical group each belongs: the first, if several.
  void entities_4() {
    std::int64_t count[4];
    for (std::int64_t& n : count) n = in_.count("the number of entities");
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      for (std::int64_t i = 0; i < count[dimension]; ++i) {
        const auto entity = in_.number<std::int32_t>("an entity's number");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) in_.number<double>("an entity's extent");
        for (auto groups = in_.count("the number of physical groups"), k = groups; k > 0; --k) {
          const auto group = in_.number<std::int32_t>("a physical group's number");
          if (dimension == 3 && k == groups) volume_group_[entity] = group;
        }
        if (dimension == 0) continue;
        for (auto k = in_.count("the number of bounding entities"); k > 0; --k)
          in_.number<std::int64_t>("a bounding entity");
      }
    in_.end_section("Entities");
  }
  void nodes_2() {
    need_format();
    for (auto n = in_.count("the number of nodes"); n > 0; --n) {
      numbers_.push_back(in_.number<std::int64_t>("a node's number"));
      position_m_.push_back(position());
    }
    in_.end_section("Nodes");
  }
  void nodes_4() {
    auto blocks = in_.count("the number of node blocks");
    for (int k = 0; k < 3; ++k) in_.number<std::int64_t>("a count of nodes");
    for (; blocks > 0; --blocks) {
      const auto dimension = in_.number<int>("an entity's dimension");
      in_.number<std::int64_t>("an entity's number");
      const bool parametric = in_.number<int>("the parametric flag") != 0;
      const auto n = in_.count("the number of nodes in the block");
      for (std::int64_t i = 0; i < n; ++i) numbers_.push_back(in_.number<std::int64_t>("a node's number"));
      for (std::int64_t i = 0; i < n; ++i) {
        position_m_.push_back(position());
        for (int k = 0; parametric && k < dimension; ++k) in_.number<double>("a node's parameter");
      }
    }
    in_.end_section("Nodes");
  }
  void element(std::int32_t type, std::int32_t group) {
    const auto known =
        std::find_if(kElementTypes.begin(), kElementTypes.end(), [&](const ElementType& t) { return t.type == type; });
    if (known == kElementTypes.end())
      in_.fail("element type " + std::to_string(type) +
               " is not supported; allowed are tetrahedra of 4 and 10 nodes (types 4 and 11)");
    FileTet tet;
    tet.nodes = known->nodes;
    tet.group = group;
    for (std::int32_t k = 0; k < known->nodes; ++k) {
      const auto n = in_.number<std::int64_t>("an element's node");
      if (!known->skipped) tet.number[static_cast<std::size_t>(k)] = n;
    }
    if (known->skipped) {
      ++other_elements_;
      return;
    }
    if (tet.nodes == 10) std::swap(tet.number[8], tet.number[9]);  // Gmsh: edge 2-3 before edge 1-3
    elements_.push_back(tet);
  }
  void elements_2() {
    need_format();
    for (auto n = in_.count("the number of elements"); n > 0; --n) {
      in_.number<std::int64_t>("an element's number");
      const auto type = in_.number<std::int32_t>("an element's type");
      std::int32_t group = 0;  // the first tag
      for (auto tags = in_.count("the number of tags"), k = tags; k > 0; --k) {
        const auto tag = in_.number<std::int32_t>("a tag");
        if (k == tags) group = tag;
      }
      element(type, group);
    }
    in_.end_section("Elements");
  }
  void elements_4() {
    auto blocks = in_.count("the number of element blocks");
    for (int k = 0; k < 3; ++k) in_.number<std::int64_t>("a count of elements");
    for (; blocks > 0; --blocks) {
      const auto dimension = in_.number<int>("an entity's dimension");
      const auto entity = volume_group_.find(in_.number<std::int32_t>("an entity's number"));
      const std::int32_t group = dimension == 3 && entity != volume_group_.end() ? entity->second : 0;
      const auto type = in_.number<std::int32_t>("an element's type");
      for (auto n = in_.count("the number of elements in the block"); n > 0; --n) {
        in_.number<std::int64_t>("an element's number");
        element(type, group);
      }
    }
    in_.end_section("Elements");
  }

  Words in_;
  double scale_;
  int version_ = 0;
  std::vector<std::int64_t> numbers_;
  std::vector<Vec3> position_m_;
  std::map<std::int32_t, std::string> volume_name_;    // of physical groups
  std::map<std::int32_t, std::int32_t> volume_group_;  // of the geometry's volumes
  std::vector<FileTet> elements_;
  std::int32_t other_elements_ = 0;
};

}  // namespace

TetFile read_msh(const std::string& path, double scale) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw ConfigError(path + ": cannot be opened; check the path");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  return MshReader(path, std::move(text), scale).read();
}

}  // namespace palpate
