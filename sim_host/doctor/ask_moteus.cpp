#include "sim_host/doctor/ask_moteus.h"

#include <set>

#include "hal/drives/frame_bytes.h"
#include "hal/drives/moteus_wire.h"

namespace palpate {

using namespace moteus;

namespace {

// The identifier whose controller this answers for; 0: none.
int node_that_answers(const Frame& frame) {
  const int node = static_cast<int>(frame.id >> 8);
  if (!frame.fd || node < 1 || node > kMostNode || frame.id != reply_id(node)) return 0;
  Reader reader(frame);
  bool told = false;
  for (Part part; reader.next(part);) told = told || (part.kind == kReply && part.first == kRegisterMap);
  return told && !reader.malformed() ? node : 0;
}

}  // namespace

std::vector<int> ask_moteus(Transport& transport, const std::function<void()>& pause) {
  constexpr int kEach_ms = 4, kAfter_ms = 100;
  transport.accept_extended();
  std::set<int> nodes;
  const auto listen = [&] {
    pause();
    take_frames(transport, [&](const Frame& frame) {
      if (const int node = node_that_answers(frame); node > 0) nodes.insert(node);
    });
  };
  for (int node = 1; node <= kMostNode; ++node) {
    Writer writer(request_id(node));
    writer.read(Type::kInt32, kRegisterMap, 1);
    send_frames(transport, &writer.finish(), 1);
    if (node % kEach_ms == 0) listen();
  }
  for (int ms = 0; ms < kAfter_ms; ++ms) listen();
  return {nodes.begin(), nodes.end()};
}

}  // namespace palpate
