#include "sim_host/bake/bake_set.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "config/bake/image_writer.h"
#include "rt_core/hash.h"
#include "sim_host/bake/certificate_text.h"
#include "sim_host/bake/image_file.h"
#include "sim_host/build_id.h"
#include "sim_host/exit_codes.h"
#include "sim_host/file_text.h"

namespace palpate {

namespace {

namespace fs = std::filesystem;

// What was baked, or was to be.
struct Entry {
  std::string scene, name;  // name: of the files in the folder
  std::string key;          // of everything the image comes from
  fs::path image, result;
};

// Text, and after it the contents of every file that it names: meshes and tables are paths from the scene's folder.
std::string with_named_files(const std::string& text, const fs::path& folder) {
  std::string all = text;
  std::size_t from = text.find('"'), to = 0;
  for (; from != std::string::npos && (to = text.find('"', from + 1)) != std::string::npos; from = to) {
    const std::string word = text.substr(from + 1, to - from - 1);
    std::error_code none;
    if (word.find('\n') == std::string::npos && fs::is_regular_file(folder / word, none))
      all += file_text(folder / word);
  }
  return all;
}

std::string key_of(const std::string& scene, const SceneOverlays& overlays) {
  const fs::path folder = fs::path(scene).parent_path();
  std::string text = kBuildId + with_named_files(file_text(scene), folder);
  for (const std::string& file : overlays.file) text += '\0' + with_named_files(file_text(file), folder);
  for (const std::string& setting : overlays.setting) text += '\0' + setting;
  Hasher hash;
  for (const char c : text) hash.add(static_cast<std::uint32_t>(static_cast<unsigned char>(c)));
  return fmt::format("{:016x}", hash.value);
}

std::vector<Entry> entries_of(const BakeSet& set) {
  std::vector<Entry> entries;
  std::map<std::string, std::string> seen;
  for (const std::string& scene : set.scene) {
    const std::string name = fs::path(scene).stem().string();
    const auto [other, is_new] = seen.emplace(name, scene);
    if (!is_new)
      throw std::runtime_error(
          fmt::format("{} and {}: both would be {}.pal; bake them into two folders", other->second, scene, name));
    const fs::path folder = set.folder;
    entries.push_back({scene, name, key_of(scene, set.overlays), folder / (name + ".pal"), folder / (name + ".json")});
  }
  return entries;
}

bool is_whole(const fs::path& image) {
  try {
    const ImageFile opened(image.string());
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

// What an earlier run left of this very scene; null: nothing.
Json earlier(const Entry& entry) {
  Json json = Json::parse(file_text(entry.result), nullptr, false);
  if (!json.is_object() || json.value("key", "") != entry.key) return nullptr;
  if (!json.contains("error") && !is_whole(entry.image)) return nullptr;
  return json;
}

void write_text(const fs::path& path, const std::string& text) {
  std::string error;
  const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
  if (!save_image(path.string(), {bytes, bytes + text.size()}, error)) throw std::runtime_error(error);
}

Json bake_entry(const Entry& entry, const BakeSet& set) {
  const auto start = std::chrono::steady_clock::now();
  Json json{{"key", entry.key}, {"scene", entry.scene}};
  try {
    const BakeRun run{isatty(STDERR_FILENO) != 0 ? progress_bar(stderr) : Progress{}, set.jobs};
    const CompileResult result = compile_scene(load_scene(entry.scene, set.overlays), run);
    json.update(bake_json(entry.scene, entry.image.string(), result.report));
    json["certificate"] = certificate_json(result.bytes);
    std::string error;
    if (!save_image(entry.image.string(), result.bytes, error)) throw std::runtime_error(error);
  } catch (const std::exception& refused) {
    json["error"] = refused.what();
  }
  json["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_text(entry.result, json.dump(1) + "\n");
  return json;
}

// The largest error of the force that the bake's own presses found, %; below 0: nothing was pressed.
double worst_error_percent(const Json& result) {
  double worst = -1;
  const Json certificate = result.value("certificate", Json());
  if (!certificate.is_object() || !certificate["force"].is_array()) return worst;
  for (const Json& place : certificate["force"])
    if (place["worst_error"].is_number()) worst = std::max(worst, 100 * std::abs(place["worst_error"].get<double>()));
  return worst;
}

std::string told(const Entry& entry, const Json& result, const char* how) {
  if (result.contains("error")) return fmt::format("refused {}: {}", entry.scene, result["error"].get<std::string>());
  return fmt::format("{:<7} {} -> {} ({} triangles, {} bytes, {:.0f} s)", how, entry.scene, entry.image.string(),
                     result["triangles"].get<std::int64_t>(), result["image_bytes"].get<std::int64_t>(),
                     result["seconds"].get<double>());
}

std::string csv_line(const Entry& entry, const Json& result) {
  if (!result.is_object()) return fmt::format("{},missing,,,,,\n", entry.name);
  if (result.contains("error")) return fmt::format("{},refused,,,,,\n", entry.name);
  const double error = worst_error_percent(result);
  return fmt::format("{},baked,{},{},{},{},{:.1f}\n", entry.name, result["triangles"].get<std::int64_t>(),
                     result["fem_nodes"].get<std::int64_t>(), result["image_bytes"].get<std::int64_t>(),
                     error < 0 ? "" : fmt::format("{:.2f}", error), result["seconds"].get<double>());
}

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char *const end = text.data() + text.size(), *const slash = std::find(text.data(), end, '/');
  const auto [first, first_error] = std::from_chars(text.data(), slash, shard.number);
  const bool one = first_error == std::errc() && first == slash && slash != end;
  const auto [last, last_error] = one ? std::from_chars(slash + 1, end, shard.of) : std::from_chars_result{end, {}};
  if (!one || last_error != std::errc() || last != end || shard.number < 1 || shard.number > shard.of)
    throw std::runtime_error("--shard " + text + ": give K/N with 1 <= K <= N, as 2/8");
  return shard;
}

Json bake_json(const std::string& scene, const std::string& image, const CompileReport& report) {
  return {{"scene", scene},
          {"image", image},
          {"name", report.name},
          {"image_bytes", report.image_bytes},
          {"triangles", report.triangles},
          {"vertices", report.vertices},
          {"volume_m3", report.volume_m3},
          {"surface_m2", report.surface_m2},
          {"mass_kg", report.mass_kg},
          {"fem_nodes", report.fem_nodes},
          {"tool_points", report.tool_points},
          {"coupling_N_per_m", report.coupling_N_per_m},
          {"coupling_Nm_per_rad", report.coupling_Nm_per_rad},
          {"model", report.model},
          {"warnings", report.warnings}};
}

int bake_shard(const BakeSet& set, const Shard& shard, Json& json) {
  const std::vector<Entry> entries = entries_of(set);
  fs::create_directories(set.folder);
  std::size_t baked = 0, kept = 0, refused = 0;
  json["scenes"] = Json::array();
  for (std::size_t i = shard.number - 1; i < entries.size(); i += shard.of) {
    Json result = earlier(entries[i]);
    const bool made = !result.is_object() || result.contains("error");
    if (made) result = bake_entry(entries[i], set);
    fmt::print("{}\n", told(entries[i], result, made ? "baked" : "kept"));
    std::fflush(stdout);
    ++(result.contains("error") ? refused : made ? baked : kept);
    json["scenes"].push_back(result);
  }
  fmt::print("part {} of {}: {} baked, {} kept, {} refused\n", shard.number, shard.of, baked, kept, refused);
  return refused == 0 ? kExitOk : kExitFailed;
}

int merge_shards(const BakeSet& set, Json& json) {
  std::string csv = "scene,state,triangles,fem_nodes,image_bytes,worst_error_percent,seconds\n";
  std::size_t whole = 0;
  const std::vector<Entry> entries = entries_of(set);
  json["scenes"] = Json::array();
  for (const Entry& entry : entries) {
    const Json result = earlier(entry);
    csv += csv_line(entry, result);
    if (result.is_object() && !result.contains("error")) ++whole;
    fmt::print("{}\n", result.is_object()
                           ? told(entry, result, "baked")
                           : "missing " + entry.scene + ": not baked, or since changed; run its part again");
    json["scenes"].push_back(result.is_object() ? result : Json{{"scene", entry.scene}, {"error", "missing"}});
  }
  const fs::path table = fs::path(set.folder) / "bake.csv";
  write_text(table, csv);
  json["table"] = table.string();
  fmt::print("{} of {} scenes are baked; wrote {}\n", whole, entries.size(), table.string());
  return whole == entries.size() ? kExitOk : kExitFailed;
}

}  // namespace palpate
