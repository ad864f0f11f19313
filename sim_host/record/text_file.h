// A text file that is written from front to back.
#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

namespace palpate {

class TextFile {
 public:
  // Throws std::runtime_error when the file cannot be created.
  explicit TextFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "w"), std::fclose) {
    if (!file_) throw std::runtime_error(fmt::format("{}: cannot create: {}", path, std::strerror(errno)));
  }
  void write(std::string_view text) { std::fwrite(text.data(), 1, text.size(), file_.get()); }
  // Throws std::runtime_error when something of all that was written could not be.
  void finish() {
    if (std::fflush(file_.get()) != 0 || std::ferror(file_.get()) != 0)
      throw std::runtime_error(path_ + ": cannot write");
  }

 private:
  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace palpate
