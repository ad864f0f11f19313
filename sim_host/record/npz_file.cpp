#include "sim_host/record/npz_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace palpate {

namespace {

constexpr std::uint32_t kElsewhere = 0xFFFFFFFF;  // the number is in the 64-bit field

// Numbers in a row, little-endian.
class Packed {
 public:
  template <class T>
  Packed& operator()(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      text_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFF);
    return *this;
  }
  Packed& text(const std::string& other) {
    text_ += other;
    return *this;
  }
  const std::string& str() const { return text_; }

 private:
  std::string text_;
};

using U16 = std::uint16_t;
using U32 = std::uint32_t;
using U64 = std::uint64_t;

constexpr U16 kVersion = 45;       // of the format that has 64-bit sizes
constexpr U16 kDate = 1 << 5 | 1;  // 1 January 1980: the same recording, the same bytes

// NumPy's header (NEP 1, version 1.0). The number of rows has a fixed width, so that it can be put in at the end.
std::string npy_header(const std::string& descr, U64 rows) {
  std::string text = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': ({:>20},), }}", descr, rows);
  constexpr std::size_t kBefore = 10, kAlignment = 64;  // magic, version and length stand before it
  text.resize((kBefore + text.size() + 1 + kAlignment - 1) / kAlignment * kAlignment - kBefore - 1, ' ');
  text += '\n';
  if (text.size() > 0xFFFF) throw std::logic_error("a row of so many fields has no header of version 1.0");
  return Packed().text("\x93NUMPY\x01").text(std::string(1, '\0'))(static_cast<U16>(text.size())).text(text).str();
}

// PKWARE's APPNOTE, 4.3.7 and 4.5.3.
std::string local_header(const std::string& name, U32 crc, U64 bytes) {
  return Packed()(U32{0x04034b50})(kVersion)(U16{0})(U16{0})(U16{0})(
             kDate)(crc)(kElsewhere)(kElsewhere)(static_cast<U16>(name.size()))(U16{20})
      .text(name)(U16{1})(U16{16})(bytes)(bytes)
      .str();
}

// 4.3.12.
std::string directory_entry(const std::string& name, U32 crc, U64 bytes, U64 at) {
  constexpr U16 kUnix = 3 << 8;
  constexpr U32 kRights = 0100644u << 16;
  return Packed()(U32{0x02014b50})(static_cast<U16>(kUnix | kVersion))(kVersion)(U16{0})(U16{0})(U16{0})(
             kDate)(crc)(kElsewhere)(kElsewhere)(static_cast<U16>(name.size()))(U16{28})(U16{0})(U16{0})(U16{0})(
             kRights)(kElsewhere)
      .text(name)(U16{1})(U16{24})(bytes)(bytes)(at)
      .str();
}

// 4.3.14 to 4.3.16.
std::string end_of_directory(U64 members, U64 bytes, U64 at) {
  return Packed()(U32{0x06064b50})(U64{44})(kVersion)(kVersion)(U32{0})(U32{0})(
             members)(members)(bytes)(at)(U32{0x07064b50})(U32{0})(at + bytes)(U32{1})(U32{0x06054b50})(U16{0})(U16{0})(
             U16{0xFFFF})(U16{0xFFFF})(kElsewhere)(kElsewhere)(U16{0})
      .str();
}

}  // namespace

NpzFile::NpzFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb"), std::fclose) {
  if (!file_) throw std::runtime_error(fmt::format("{}: cannot create: {}", path, std::strerror(errno)));
}

void NpzFile::put(const std::string& bytes) { std::fwrite(bytes.data(), 1, bytes.size(), file_.get()); }

void NpzFile::begin(const std::string& name, const std::string& descr, std::size_t row_bytes) {
  member_.push_back({name + ".npy", descr, row_bytes, static_cast<U64>(ftello(file_.get())), 0, 0});
  put(local_header(member_.back().name, 0, 0));
  put(npy_header(descr, 0));
}

void NpzFile::write(std::span<const std::byte> rows) {
  Member& now = member_.back();
  now.crc = static_cast<U32>(crc32_z(now.crc, reinterpret_cast<const Bytef*>(rows.data()), rows.size()));
  now.bytes += rows.size();
  std::fwrite(rows.data(), 1, rows.size(), file_.get());
}

void NpzFile::end() {
  Member& now = member_.back();
  const std::string header = npy_header(now.descr, now.bytes / now.row_bytes);
  const uLong of_header = crc32_z(0, reinterpret_cast<const Bytef*>(header.data()), header.size());
  now.crc = static_cast<U32>(crc32_combine(of_header, now.crc, static_cast<z_off_t>(now.bytes)));
  now.bytes += header.size();
  const bool back = fseeko(file_.get(), static_cast<off_t>(now.at), SEEK_SET) == 0;
  put(local_header(now.name, now.crc, now.bytes));
  put(header);
  if (!back || fseeko(file_.get(), 0, SEEK_END) != 0)
    throw std::runtime_error(path_ + ": cannot go back in it; write to an ordinary file");
}

void NpzFile::finish() {
  const auto at = static_cast<U64>(ftello(file_.get()));
  std::string directory;
  for (const Member& member : member_) directory += directory_entry(member.name, member.crc, member.bytes, member.at);
  put(directory);
  put(end_of_directory(member_.size(), directory.size(), at));
  if (std::fflush(file_.get()) != 0 || std::ferror(file_.get()) != 0)
    throw std::runtime_error(path_ + ": cannot write");
}

}  // namespace palpate
