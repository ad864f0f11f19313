// Many scenes into one folder: parts, what is kept, what is made again, and what is told of the whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "sim_host/bake/bake_set.h"
#include "sim_host/exit_codes.h"
#include "sim_host/file_text.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Three small bodies of springs and one from a file, in a folder of their own.
class BakeSetTest : public testing::Test {
 protected:
  BakeSetTest() {
    fs::create_directories(home_);
    for (const char* name : {"a", "b", "c"}) write(name, "shape = \"box\"\nsize_mm = [30, 30, 30]\ntriangles = 200\n");
    write_file("tetra.obj", "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    write("d", "shape = \"mesh\"\nmesh = \"tetra.obj\"\n");
    set_.folder = home_ + "/images";
    for (const char* name : {"a", "b", "c", "d"}) set_.scene.push_back(home_ + "/" + name + ".toml");
  }
  ~BakeSetTest() override { fs::remove_all(home_); }

  void write_file(const std::string& name, const std::string& text) const { std::ofstream(home_ + "/" + name) << text; }
  void write(const std::string& name, const std::string& body) const {
    write_file(name + ".toml", "name = \"" + name + "\"\n[body]\n" + body +
                                   "[contact]\nlaw = \"cubic\"\n[contact.cubic]\nk1_N_per_m = 300\nk3_N_per_m3 = "
                                   "1e6\n[friction]\nlaw = \"none\"\n[[tool.piece]]\nshape = \"sphere\"\nradius_mm "
                                   "= 5\n");
  }
  int bake(std::size_t number = 1, std::size_t of = 1) {
    return bake_shard(set_, {number, of}, json_ = Json::object());
  }
  int merge() { return merge_shards(set_, json_ = Json::object()); }
  // Names of the images, and when each was written.
  std::map<std::string, fs::file_time_type> images() const {
    std::map<std::string, fs::file_time_type> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(set_.folder))
      if (entry.path().extension() == ".pal") found[entry.path().stem().string()] = entry.last_write_time();
    return found;
  }
  // Which of two bakes' images were made again.
  static std::set<std::string> changed(const std::map<std::string, fs::file_time_type>& before,
                                       const std::map<std::string, fs::file_time_type>& after) {
    std::set<std::string> names;
    for (const auto& [name, time] : after)
      if (before.find(name) == before.end() || before.at(name) != time) names.insert(name);
    return names;
  }

  std::string home_ = fs::temp_directory_path() / "bake_set";
  BakeSet set_;
  Json json_;
};

TEST_F(BakeSetTest, PartsAreEachSceneOnceAndAllOfThem) {
  EXPECT_EQ(bake(1, 3), kExitOk);
  EXPECT_EQ(changed({}, images()), (std::set<std::string>{"a", "d"}));
  const auto first = images();
  EXPECT_EQ(merge(), kExitFailed);
  EXPECT_EQ(bake(2, 3), kExitOk);
  EXPECT_EQ(bake(3, 3), kExitOk);
  EXPECT_EQ(changed(first, images()), (std::set<std::string>{"b", "c"}));
  EXPECT_EQ(merge(), kExitOk);
  EXPECT_EQ(json_["scenes"].size(), 4u);
  const std::string table = file_text(set_.folder + "/bake.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
  EXPECT_THAT(table, HasSubstr("d,baked,4,"));
}

TEST_F(BakeSetTest, WhatIsThereIsKept) {
  bake();
  const auto before = images();
  EXPECT_EQ(bake(), kExitOk);
  EXPECT_EQ(changed(before, images()), std::set<std::string>{});
}

TEST_F(BakeSetTest, WhatChangedIsBakedAgainAndMissedUntilThen) {
  bake();
  const auto before = images();
  write("b", "shape = \"box\"\nsize_mm = [30, 30, 31]\ntriangles = 200\n");
  write_file("tetra.obj", "v 0 0 0\nv 41 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  EXPECT_EQ(merge(), kExitFailed);
  EXPECT_THAT(file_text(set_.folder + "/bake.csv"), HasSubstr("b,missing"));
  EXPECT_THAT(file_text(set_.folder + "/bake.csv"), HasSubstr("d,missing"));
  bake();
  EXPECT_EQ(changed(before, images()), (std::set<std::string>{"b", "d"}));
  EXPECT_EQ(merge(), kExitOk);
  set_.overlays.setting = {"body.material.density_kg_per_m3=900"};
  EXPECT_EQ(merge(), kExitFailed);  // other images than those
}

TEST_F(BakeSetTest, ATornImageOrResultIsBakedAgain) {
  bake();
  const auto before = images();
  fs::resize_file(set_.folder + "/a.pal", fs::file_size(set_.folder + "/a.pal") - 1);
  fs::resize_file(set_.folder + "/c.json", fs::file_size(set_.folder + "/c.json") / 2);
  EXPECT_EQ(merge(), kExitFailed);
  EXPECT_EQ(bake(), kExitOk);
  EXPECT_EQ(changed(before, images()), (std::set<std::string>{"a", "c"}));
  EXPECT_EQ(merge(), kExitOk);
}

TEST_F(BakeSetTest, OneThatIsRefusedStopsNoOther) {
  write("b", "shape = \"box\"\nsize_mm = [30, 30, -1]\n");
  EXPECT_EQ(bake(), kExitFailed);
  EXPECT_EQ(changed({}, images()), (std::set<std::string>{"a", "c", "d"}));
  EXPECT_THAT(json_["scenes"][1]["error"].get<std::string>(), HasSubstr("b.toml:4: body.size_mm"));
  EXPECT_EQ(merge(), kExitFailed);
  EXPECT_THAT(file_text(set_.folder + "/bake.csv"), HasSubstr("b,refused"));
}

TEST_F(BakeSetTest, TwoScenesOfOneNameAreRefusedBeforeAnythingIsBaked) {
  fs::create_directories(home_ + "/other");
  fs::copy_file(home_ + "/a.toml", home_ + "/other/a.toml");
  set_.scene.push_back(home_ + "/other/a.toml");
  EXPECT_THROW(bake(), std::runtime_error);
  EXPECT_FALSE(fs::exists(set_.folder));
}

TEST(BakeShard, IsKOfN) {
  EXPECT_EQ(parse_shard("2/8").number, 2u);
  EXPECT_EQ(parse_shard("2/8").of, 8u);
  for (const char* wrong : {"", "2", "/", "0/3", "4/3", "1/0", "-1/2", "1/2x", "a/2", "1/", "/2", "1 /2"})
    EXPECT_THROW(parse_shard(wrong), std::runtime_error) << wrong;
}

}  // namespace
}  // namespace palpate
