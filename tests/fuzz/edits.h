// Fuzzers of binary formats mutate a valid file, checksums put right again: a flipped byte with a wrong checksum only
// tests the checksum. An input is a list of edits, so that the kept corpora outlive every change of layout.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace palpate::fuzz {

struct Edit {
  std::uint32_t where;  // taken modulo the size
  std::uint8_t how;     // 0..: set, add, flip a bit, set 4 bytes, set 8 bytes to a special number
  std::uint8_t value;
};
inline constexpr std::size_t kEditBytes = 6;

// Numbers that break things: edges of integers and floats.
inline std::uint64_t special(std::uint8_t value) {
  constexpr std::uint64_t kSpecial[] = {0,
                                        1,
                                        ~0ull,
                                        0x7fffffffull,
                                        0x80000000ull,
                                        0x7fffffffffffffffull,
                                        0x8000000000000000ull,
                                        0x7ff8000000000000ull,  // NaN
                                        0x7ff0000000000000ull,  // infinity
                                        0xfff0000000000000ull,
                                        0x7fefffffffffffffull,  // largest
                                        0x0000000000000001ull,  // subnormal
                                        0xffff7fffffff8000ull,
                                        0x7fc000007fc00000ull,  // two NaN of single precision
                                        0x3ff0000000000000ull,  // 1
                                        0xbff0000000000000ull};
  return kSpecial[value % 16];
}

inline void apply_edit(const Edit& edit, std::span<std::byte> bytes) {
  const std::size_t at = edit.where % bytes.size();
  std::byte& one = bytes[at];
  const std::uint64_t number = special(edit.value);
  const auto put = [&](std::size_t width) {
    const std::size_t aligned = at / width * width;
    if (aligned + width <= bytes.size()) std::memcpy(bytes.data() + aligned, &number, width);
  };
  switch (edit.how % 5) {
    case 0:
      one = std::byte{edit.value};
      break;
    case 1:
      one = static_cast<std::byte>(std::to_integer<unsigned>(one) + edit.value);
      break;
    case 2:
      one ^= std::byte{1} << (edit.value % 8);
      break;
    case 3:
      put(4);
      break;
    default:
      put(8);
      break;
  }
}

// Applies every whole edit in `data` to `bytes`.
inline void apply_all(const std::uint8_t* data, std::size_t size, std::span<std::byte> bytes) {
  for (; size >= kEditBytes && !bytes.empty(); data += kEditBytes, size -= kEditBytes) {
    Edit edit;
    std::memcpy(&edit.where, data, 4);
    edit.how = data[4];
    edit.value = data[5];
    apply_edit(edit, bytes);
  }
}

}  // namespace palpate::fuzz
