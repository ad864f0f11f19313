// TOML text to SceneDesc, driven by the schema: every key is looked up in it, so a key it does not hold is an error.
#define TOML_ENABLE_FORMATTERS 0
// toml++ asserts in its parser what a broken file breaks (a control character as a key), and then refuses it in words:
// an assertion would end a build without NDEBUG instead (found by tests/fuzz, 2026-11-22).
#define TOML_ASSERT(expression) static_cast<void>(0)
#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "config/scene/config_error.h"
#include "config/scene/scene.h"
#include "config/scene/schema.h"

namespace palpate {

namespace {

// Edit distance (Levenshtein 1966), for "did you mean".
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

// The known name nearest to `name`, if it is near enough to be meant; also a name given without its unit.
std::string nearest(const std::string& name, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = candidate.starts_with(name + "_") ? 1 : edit_distance(name, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

class Reader {
 public:
  explicit Reader(SceneDesc& scene) : scene_(scene) {}

  void read(const toml::table& root) { read_table(root, "", ""); }

 private:
  [[noreturn]] void fail(const toml::node& node, const std::string& key, const std::string& what) const {
    const std::string file = node.source().path ? *node.source().path : scene_.source.file;
    throw ConfigError(file + ":" + std::to_string(node.source().begin.line) + ": " + key + ": " + what);
  }

  void remember(const std::string& path, const toml::node& node) {
    scene_.source.line.emplace(path, static_cast<int>(node.source().begin.line));
    if (node.source().path && *node.source().path != scene_.source.file)
      scene_.source.overlay.emplace(path, *node.source().path);
  }

  static std::string joined(const std::string& table, const std::string& key) {
    return table.empty() ? key : table + "." + key;
  }

  static const TableSpec* find_table(const std::string& name) {
    for (const TableSpec& table : scene_schema())
      if (table.name == name) return &table;
    return nullptr;
  }

  // Keys and sub-tables of a table, for "did you mean".
  static std::vector<std::string> known_names(const std::string& table) {
    std::vector<std::string> names;
    const std::string prefix = table.empty() ? "" : table + ".";
    for (const TableSpec& spec : scene_schema()) {
      const std::string name = spec.name;
      if (name == table)
        for (const KeySpec& key : spec.keys) names.emplace_back(key.key);
      else if (name.starts_with(prefix))
        names.push_back(name.substr(prefix.size(), name.find('.', prefix.size()) - prefix.size()));
    }
    return names;
  }

  // True when `name` is a table or the parent of one ("tool" exists only as the parent of "tool.piece").
  static bool is_table(const std::string& name) {
    return std::ranges::any_of(scene_schema(), [&](const TableSpec& t) {
      return t.name == name || std::string(t.name).starts_with(name + ".");
    });
  }

  // `name` as in the schema; `label` as shown and remembered: with the index of an element ("tool.piece[1]", from 0).
  void read_table(const toml::table& node, const std::string& name, const std::string& label) {
    const TableSpec* spec = find_table(name);
    void* fields = spec != nullptr ? spec->open(scene_) : nullptr;
    for (const auto& [raw_key, value] : node) {
      const std::string key(raw_key.str());
      const std::string path = joined(label, key);
      const KeySpec* known = nullptr;
      if (spec != nullptr)
        for (const KeySpec& k : spec->keys)
          if (key == k.key) known = &k;
      remember(path, value);
      if (known != nullptr)
        read_value(value, path, *known, fields);
      else if (is_table(joined(name, key)))
        read_child(value, joined(name, key));
      else
        fail_unknown(value, name, key, path);
    }
    if (spec != nullptr) check_required(node, *spec, label);
  }

  [[noreturn]] void fail_unknown(const toml::node& value, const std::string& table, const std::string& key,
                                 const std::string& path) const {
    const std::string guess = nearest(key, known_names(table));
    fail(value, path,
         "unknown key; " + (guess.empty() ? std::string("see docs/scene_format.md or `palpate bake --schema`")
                                          : "did you mean '" + guess + "'?"));
  }

  void read_child(const toml::node& value, const std::string& path) {
    const TableSpec* spec = find_table(path);
    if (spec != nullptr && spec->is_array) {
      const toml::array* list = value.as_array();
      if (list == nullptr) fail(value, path, "must be a list of tables; write [[" + path + "]]");
      std::int32_t index = 0;
      for (const toml::node& element : *list) {
        const std::string label = path + "[" + std::to_string(index++) + "]";
        if (!element.is_table()) fail(element, label, "must be a table");
        remember(label, element);
        read_table(*element.as_table(), path, label);
      }
    } else if (const toml::table* table = value.as_table()) {
      read_table(*table, path, path);
    } else {
      fail(value, path, "must be a table; write [" + path + "]");
    }
  }

  void check_required(const toml::table& node, const TableSpec& spec, const std::string& label) const {
    for (const KeySpec& key : spec.keys)
      if (key.required && !node.contains(key.key))
        fail(node, joined(label, key.key), "missing; add it: " + allowed_text(key));
  }

  [[noreturn]] void fail_type(const toml::node& value, const std::string& path, const KeySpec& key) const {
    fail(value, path, "wrong type; allowed " + allowed_text(key));
  }

  // A number in the key's unit, checked against its range. NaN and infinity are TOML numbers: refused here.
  double read_number(const toml::node& value, const std::string& path, const KeySpec& key) const {
    const auto number = value.is_integer() || value.is_floating_point() ? value.value<double>() : std::nullopt;
    if (!number) fail_type(value, path, key);
    if (!(*number >= key.lowest && *number <= key.highest))
      fail(value, path, number_text(*number) + " is out of range; allowed " + allowed_text(key));
    return *number * key.scale;
  }

  void read_value(const toml::node& value, const std::string& path, const KeySpec& key, void* fields) {
    switch (key.kind) {
      case KeyKind::kNumber:
        *static_cast<double*>(key.field(fields)) = read_number(value, path, key);
        return;
      case KeyKind::kNumberOrAuto:
        *static_cast<double*>(key.field(fields)) =
            value.value<std::string>() == "auto" ? kAuto : read_number(value, path, key);
        return;
      case KeyKind::kInteger:
        if (!value.is_integer()) fail_type(value, path, key);
        *static_cast<std::int32_t*>(key.field(fields)) = static_cast<std::int32_t>(read_number(value, path, key));
        return;
      case KeyKind::kBool:
        if (!value.is_boolean()) fail_type(value, path, key);
        *static_cast<bool*>(key.field(fields)) = **value.as_boolean();
        return;
      case KeyKind::kText:
        *static_cast<std::string*>(key.field(fields)) = read_text(value, path, key);
        return;
      case KeyKind::kChoice:
        key.set_choice(fields, read_choice(value, path, key));
        return;
      case KeyKind::kVec3:
        *static_cast<Vec3*>(key.field(fields)) = read_vector(value, path, key);
        return;
      case KeyKind::kPairs:
        read_pairs(value, path, key, *static_cast<std::vector<ProfilePoint>*>(key.field(fields)));
        return;
      case KeyKind::kFingers:
        read_fingers(value, path, key, *static_cast<std::vector<double>*>(key.field(fields)));
        return;
      case KeyKind::kPoints:
        read_points(value, path, key, *static_cast<std::vector<Vec3>*>(key.field(fields)));
        return;
    }
  }

  std::string read_text(const toml::node& value, const std::string& path, const KeySpec& key) const {
    if (!value.is_string()) fail_type(value, path, key);
    const std::string& text = **value.as_string();
    if (text.empty() || static_cast<double>(text.size()) > key.highest || text.find('\0') != std::string::npos)
      fail(value, path, "text of " + std::to_string(text.size()) + " bytes; allowed " + allowed_text(key));
    return text;
  }

  std::int32_t read_choice(const toml::node& value, const std::string& path, const KeySpec& key) const {
    if (!value.is_string()) fail_type(value, path, key);
    const std::string& text = **value.as_string();
    const std::vector<std::string> names(key.choices.begin(), key.choices.end());
    const auto found = std::ranges::find(names, text);
    if (found != names.end()) return static_cast<std::int32_t>(found - names.begin());
    const std::string guess = nearest(text, names);
    fail(value, path,
         "'" + text + "' is unknown; allowed " + allowed_text(key) +
             (guess.empty() ? "" : ". Did you mean '" + guess + "'?"));
  }

  // `count` numbers of a list.
  std::vector<double> read_numbers(const toml::node& value, const std::string& path, const KeySpec& key,
                                   std::size_t count) const {
    const toml::array* list = value.as_array();
    if (list == nullptr || list->size() != count) fail_type(value, path, key);
    std::vector<double> numbers;
    for (const toml::node& element : *list) numbers.push_back(read_number(element, path, key));
    return numbers;
  }
  Vec3 read_vector(const toml::node& value, const std::string& path, const KeySpec& key) const {
    const std::vector<double> v = read_numbers(value, path, key, 3);
    return {v[0], v[1], v[2]};
  }
  void read_pairs(const toml::node& value, const std::string& path, const KeySpec& key,
                  std::vector<ProfilePoint>& pairs) const {
    if (!value.is_array()) fail_type(value, path, key);
    for (const toml::node& element : *value.as_array()) {
      const std::vector<double> v = read_numbers(element, path, key, 2);
      pairs.push_back({v[0], v[1]});
    }
  }
  // One number for all fingers, or one for each.
  void read_fingers(const toml::node& value, const std::string& path, const KeySpec& key,
                    std::vector<double>& fingers) const {
    const toml::array* list = value.as_array();
    if (list == nullptr || (list->size() != 1 && list->size() != kMaxFingers)) fail_type(value, path, key);
    for (const toml::node& element : *list) fingers.push_back(read_number(element, path, key));
  }
  void read_points(const toml::node& value, const std::string& path, const KeySpec& key,
                   std::vector<Vec3>& points) const {
    if (!value.is_array()) fail_type(value, path, key);
    for (const toml::node& element : *value.as_array()) points.push_back(read_vector(element, path, key));
  }

  SceneDesc& scene_;
};

}  // namespace

std::string SceneSource::where(const std::string& key) const {
  const auto found = line.find(key);
  const auto other = overlay.find(key);
  return (other == overlay.end() ? file : other->second) +
         (found == line.end() ? "" : ":" + std::to_string(found->second)) + ": " + key;
}

namespace {

toml::table parse_text(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const auto where = error.source().begin;
    throw ConfigError(file + ":" + std::to_string(where.line) + ": not valid TOML, column " +
                      std::to_string(where.column) + ": " + std::string(error.description()));
  }
}

std::string read_text_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw ConfigError(path + ": no such scene file; give the path of a .toml file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw ConfigError(path + ": cannot read the scene file; check its permissions");
  return {std::istreambuf_iterator<char>(stream), {}};
}

// Tables are merged key by key; values and lists replace what was there. Nodes are moved: only so do they keep their
// place in the file.
void lay_over(toml::table& base, toml::table&& over) {
  for (auto&& [key, value] : over) {
    toml::node* old = base.get(key.str());
    if (old != nullptr && old->is_table() && value.is_table())
      lay_over(*old->as_table(), std::move(*value.as_table()));
    else
      value.visit([&](auto& node) { base.insert_or_assign(key, std::move(node)); });
  }
}

// "key=value" with a dotted key; a value that is not TOML is taken as text, so that words need no quotes.
toml::table parse_setting(const std::string& setting) {
  const auto equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError("--set " + setting + ": write KEY=VALUE, as in --set body.material.youngs_modulus_Pa=1e6");
  try {
    return toml::parse(std::string_view(setting), std::string_view("--set"));
  } catch (const toml::parse_error&) {
    return parse_text(setting.substr(0, equals) + " = \"" + setting.substr(equals + 1) + "\"", "--set");
  }
}

SceneDesc scene_from(toml::table&& root, const std::string& file, const SceneOverlays& overlays) {
  SceneDesc scene;
  scene.source.file = file;
  const std::filesystem::path parent = std::filesystem::path(file).parent_path();
  scene.source.directory = parent.empty() ? "" : parent.string() + "/";
  for (const std::string& path : overlays.file) lay_over(root, parse_text(read_text_file(path), path));
  for (const std::string& setting : overlays.setting) lay_over(root, parse_setting(setting));
  Reader(scene).read(root);
  if (!scene.source.has("body.shape"))
    throw ConfigError(file + ": body.shape: missing; add a [body] table with a shape");
  // An elastic body has no other tips than those of the pieces' shapes.
  if (scene.contact.backend == Backend::kElastic && !scene.source.has("contact.law"))
    scene.contact.law = ContactLaw::kTool;
  check_scene(scene);
  return scene;
}

}  // namespace

SceneDesc parse_scene(const std::string& text, const std::string& file) {
  return scene_from(parse_text(text, file), file, {});
}

SceneDesc load_scene(const std::string& path, const SceneOverlays& overlays) {
  return scene_from(parse_text(read_text_file(path), path), path, overlays);
}

}  // namespace palpate
