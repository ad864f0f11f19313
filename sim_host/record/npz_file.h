// A file of NumPy arrays (.npz) as numpy.load takes it: a zip of .npy members, stored, in the 64-bit form of the
// format, so that a member may be larger than 4 GB. Rows are written as they come; their number is put in when a member
// ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace palpate {

class NpzFile {
 public:
  // Throws std::runtime_error when the file cannot be created.
  explicit NpzFile(const std::string& path);
  // A one-dimensional array `name`; `descr`: the type of a row as Python writes it ("'<f8'", "[('tick', '<u8'), ...]").
  void begin(const std::string& name, const std::string& descr, std::size_t row_bytes);
  void write(std::span<const std::byte> rows);  // whole rows
  void end();
  // Writes the directory. Throws std::runtime_error when something of all that was written could not be.
  void finish();

 private:
  struct Member {
    std::string name, descr;
    std::size_t row_bytes = 0;
    std::uint64_t at = 0, bytes = 0;  // of the rows, until it ends; then of all its data
    std::uint32_t crc = 0;
  };
  void put(const std::string& bytes);

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::vector<Member> member_;
};

}  // namespace palpate
