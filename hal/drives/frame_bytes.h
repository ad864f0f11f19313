// Little-endian numbers in the payload of a frame; both drive protocols here use nothing else.
#pragma once

#include <cstring>

#include "hal/bus/transport.h"

namespace palpate {

// Classic frames: 8 bytes. `at` + sizeof(T) must be within them.
template <class T>
void put_bytes(Frame& frame, int at, T value) noexcept {
  std::memcpy(frame.data + at, &value, sizeof value);
}
template <class T>
T get_bytes(const Frame& frame, int at) noexcept {
  T value;
  std::memcpy(&value, frame.data + at, sizeof value);
  return value;
}

inline Frame classic_frame(std::uint32_t id, int length) noexcept {
  Frame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(length);
  return frame;
}

// Hands over all, in the groups of four a transport takes at once; how many were taken.
inline int send_frames(Transport& transport, const Frame* frames, int count) noexcept {
  constexpr int kGroup = 4;
  int taken = 0;
  for (int i = 0; i < count; i += kGroup) {
    const int size = count - i < kGroup ? count - i : kGroup;
    taken += transport.send({frames + i, static_cast<std::size_t>(size)});
  }
  return taken;
}

// Hands every frame that has arrived to `take`.
template <class Take>
void take_frames(Transport& transport, const Take& take) noexcept {
  Frame frames[kMaxFramesPerReceive];
  const int count = transport.receive(frames);
  for (int i = 0; i < count; ++i) take(frames[i]);  // bound: kMaxFramesPerReceive
}

}  // namespace palpate
