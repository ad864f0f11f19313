// Reading of the small text files under /proc and /sys that the doctor's items are made from.
#pragma once

#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

namespace palpate::doctor {

// First line of a file, without its newline; nothing when it cannot be read.
inline std::optional<std::string> first_line(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line)) return std::nullopt;
  return line;
}

// Whole content, empty when it cannot be read.
inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::optional<long> number(const std::optional<std::string>& text) {
  long value = 0;
  if (!text) return std::nullopt;
  const auto result = std::from_chars(text->data(), text->data() + text->size(), value);
  if (result.ec != std::errc{}) return std::nullopt;
  return value;
}

// Whether `cpu` is in a list such as "1,3-5".
inline bool cpu_in_list(const std::string& list, int cpu) {
  std::stringstream parts(list);
  std::string part;
  while (std::getline(parts, part, ',')) {
    const auto first = number(part);
    const std::size_t dash = part.find('-');
    const auto last = dash == std::string::npos ? first : number(part.substr(dash + 1));
    if (first && last && cpu >= *first && cpu <= *last) return true;
  }
  return false;
}

}  // namespace palpate::doctor
