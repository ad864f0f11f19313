// Many scenes baked into one folder, on one machine or shared out over many.
#pragma once

#include <string>
#include <vector>

#include "config/bake/compile.h"
#include "config/scene/scene.h"
#include "sim_host/json_output.h"

namespace palpate {

// Part `number` (from 1) of `of`: the scenes number, number + of, ... of the list, the same on every machine.
struct Shard {
  std::size_t number = 1, of = 1;
};
// "K/N", 1 <= K <= N. Throws std::runtime_error.
Shard parse_shard(const std::string& text);

struct BakeSet {
  std::vector<std::string> scene;  // files
  std::string folder;              // SCENE.pal, and SCENE.json: what it became, or why it did not
  SceneOverlays overlays;
  unsigned jobs = 0;  // BakeRun
};

// What a scene became: the keys of `palpate bake --json`.
Json bake_json(const std::string& scene, const std::string& image, const CompileReport& report);

// Bakes what of the shard's scenes has no image of this build, scene text, overlays and the files they name; so that an
// interrupted set goes on where it was. A scene that is refused stops no other, and is tried again the next time. An
// exit code: kExitFailed when one was.
int bake_shard(const BakeSet& set, const Shard& shard, Json& json);

// Whether every scene of the set has such an image; a table of all, also as bake.csv in the folder. kExitFailed when
// one is missing, out of date or was refused.
int merge_shards(const BakeSet& set, Json& json);

}  // namespace palpate
