// Palpate's tick beside what others need for the same body, the same tool and the same poses, in one program on one
// core: `./run peers`. Every figure is per tick in contact, each tick's least time of several passes.
// Usage: peers GRASP_IMAGE NODAL_IMAGE OUTPUT.csv
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/hand/hand_mesh.h"
#include "tests/peers/bullet_peer.h"
#include "tests/peers/fcl_peer.h"
#include "tests/peers/gauss_seidel_peer.h"
#include "tests/peers/grasp_track.h"
#include "tests/support/image_file.h"

namespace palpate::peers {
namespace {

constexpr int kPasses = 5, kBulletPasses = 2;  // its steps take milliseconds

// Microseconds of the ticks in which our tool touches.
std::vector<double> ours(const Track& track) {
  std::vector<double> us;
  for (const TrackTick& at : track.tick)
    if (at.contacts > 0) us.push_back(at.tick_us);
  return us;
}

// The same of a peer. `start` makes one anew for each pass; what it returns is called and timed for every tick of the
// run; `look`, if any, is called after each tick, without the clock.
using TickCall = std::function<void(const TrackTick&)>;
std::vector<double> theirs(const Track& track, int passes, const std::function<TickCall()>& start,
                           const std::function<void()>& look = {}) {
  std::vector<double> least(track.tick.size(), 1e300);
  for (int pass = 0; pass < passes; ++pass) {
    const TickCall call = start();
    for (std::size_t i = 0; i < track.tick.size(); ++i) {
      const auto begin = std::chrono::steady_clock::now();
      call(track.tick[i]);
      const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
      least[i] = std::min(least[i], took.count());
      if (look && track.tick[i].contacts > 0) look();
    }
  }
  std::vector<double> us;
  for (std::size_t i = 0; i < least.size(); ++i)
    if (track.tick[i].contacts > 0) us.push_back(least[i]);
  return us;
}

struct Spread {
  double p50 = 0, p999 = 0, max = 0;
};
Spread spread(std::vector<double> us) {
  if (us.empty()) return {};
  std::sort(us.begin(), us.end());
  const auto at = [&](double share) {
    return us[static_cast<std::size_t>(share * static_cast<double>(us.size() - 1))];
  };
  return {at(0.5), at(0.999), us.back()};
}

class Table {
 public:
  explicit Table(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {
    if (file_ == nullptr) throw std::runtime_error(path + ": cannot be written");
    fmt::print(file_, "scene,what,ticks,p50_us,p99.9_us,max_us,ratio_p50,ratio_p99.9,ratio_max\n");
    fmt::print("| scene | what | ticks | p50 | p99.9 | max, us | times ours |\n|---|---|---|---|---|---|---|\n");
  }
  ~Table() { std::fclose(file_); }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
  void scene(const char* name, const std::vector<double>& own) {
    scene_ = name;
    own_ = spread(own);
    row("Palpate: the whole tick", own);
  }
  void row(const std::string& what, const std::vector<double>& us) {
    const Spread s = spread(us);
    fmt::print("| {} | {} | {} | {:.1f} | {:.1f} | {:.1f} | {:.1f}, {:.1f}, {:.1f} |\n", scene_, what, us.size(), s.p50,
               s.p999, s.max, s.p50 / own_.p50, s.p999 / own_.p999, s.max / own_.max);
    fmt::print(file_, "{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}\n", scene_, what, us.size(), s.p50, s.p999,
               s.max, s.p50 / own_.p50, s.p999 / own_.p999, s.max / own_.max);
    std::fflush(stdout);
  }

 private:
  std::FILE* file_;
  std::string scene_;
  Spread own_;
};

SurfaceMesh body_mesh(const Model& model) {
  SurfaceMesh mesh;
  mesh.vertex_m.assign(model.vertex_m.begin(), model.vertex_m.end());
  for (const Triangle& t : model.triangle) mesh.triangle.push_back({t.vertex[0], t.vertex[1], t.vertex[2]});
  return mesh;
}

void against_grasp(const Model& model, Table& table) {
  const SurfaceMesh body = body_mesh(model);
  std::vector<SurfaceMesh> pieces;
  for (const ToolPiece& piece : model.piece) pieces.push_back(hand_piece_mesh(piece));
  const Track track = play(model, kPasses);
  table.scene(model.name, ours(track));
  for (const std::size_t most : {std::size_t{1}, static_cast<std::size_t>(kMaxContacts)}) {
    std::size_t found = 0;
    const auto start = [&]() -> TickCall {
      auto fcl = std::make_shared<FclPeer>(body, pieces);
      return [&found, fcl, most](const TrackTick& at) { found += fcl->contacts(at.piece_w, most); };
    };
    const std::vector<double> us = theirs(track, kPasses, start);
    table.row(fmt::format("FCL 0.7: contacts alone, at most {} a piece", most), us);
    if (found == 0) throw std::runtime_error("FCL found no contact: the poses are not those of the run");
  }
  double lowest_m = 1e300;
  for (const Vec3& v : body.vertex_m) lowest_m = std::min(lowest_m, v.y);
  std::unique_ptr<bool[]> held(new bool[body.vertex_m.size()]);
  for (std::size_t i = 0; i < body.vertex_m.size(); ++i) held[i] = body.vertex_m[i].y < lowest_m + 1e-6;
  double moved_m = 0;
  std::shared_ptr<BulletPeer> bullet;
  const auto start = [&]() -> TickCall {
    bullet = std::make_shared<BulletPeer>(body, std::span<const bool>(held.get(), body.vertex_m.size()), pieces,
                                          track.period_s);
    return [&bullet](const TrackTick& at) { bullet->step(at.piece_w); };
  };
  const std::vector<double> us =
      theirs(track, kBulletPasses, start, [&] { moved_m = std::max(moved_m, bullet->largest_displacement_m()); });
  table.row("Bullet 3.24: a step of a soft body", us);
  if (!(moved_m > 0)) throw std::runtime_error("Bullet's body does not move: the pieces do not touch it");
}

void against_nodes(const Model& model, Table& table) {
  const Track track = play(model, kPasses);
  table.scene(model.name, ours(track));
  double most_N = 0;
  int sweeps = 0, candidates = 0;
  const std::vector<double> us = theirs(track, kPasses, [&]() -> TickCall {
    auto peer = std::make_shared<GaussSeidelPeer>(model);
    return [&, peer](const TrackTick& at) {
      most_N = std::max(most_N, norm(peer->force_N(at.piece_w)));
      sweeps = std::max(sweeps, peer->sweeps());
      candidates = std::max(candidates, peer->candidates());
    };
  });
  table.row(
      fmt::format("Eigen 3.4: projected Gauss-Seidel, to {} nodes and {} sweeps, no friction", candidates, sweeps), us);
  if (!(most_N > 0)) throw std::runtime_error("the projected Gauss-Seidel found no contact");
}

}  // namespace
}  // namespace palpate::peers

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: peers GRASP_IMAGE NODAL_IMAGE OUTPUT.csv\n");
    return 2;
  }
  try {
    const palpate::test::ImageFile grasp(argv[1]), nodal(argv[2]);
    palpate::peers::Table table(argv[3]);
    palpate::peers::against_grasp(grasp.model(), table);
    palpate::peers::against_nodes(nodal.model(), table);
  } catch (const std::exception& error) {
    fmt::print(stderr, "peers: {}\n", error.what());
    return 1;
  }
  return 0;
}
