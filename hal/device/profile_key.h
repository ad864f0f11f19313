// One table of a device profile as data: which keys it has, in which ranges, and where their numbers go.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace palpate {

template <class T>
struct ProfileKey {
  double T::*member;
  const char* name;
  double lowest, highest, scale;  // in the key's unit; value * scale is SI
  bool may_lack;
};

inline std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// Only what TOML and C read alike: no hexadecimal, no "inf". "" or what is wrong.
inline std::string read_number(const std::string& name, const std::string& value, double lowest, double highest,
                               double& number) {
  const bool plain = !value.empty() && value.find_first_not_of("+-.0123456789eE") == std::string::npos;
  char* end = nullptr;
  const double read = plain ? std::strtod(value.c_str(), &end) : 0;
  if (!plain || *end != '\0' || !(read >= lowest && read <= highest))
    return name + ": '" + value + "' is not a number in the range " + short_text(lowest) + " to " + short_text(highest);
  number = read;
  return "";
}

template <class T, std::size_t count>
std::string read_key(const ProfileKey<T> (&keys)[count], const std::string& name, const std::string& value, T& table) {
  const auto key = std::ranges::find_if(keys, [&](const ProfileKey<T>& k) { return name == k.name; });
  if (key == std::end(keys)) return name + ": unknown key; see docs/devices.md";
  double number = 0;
  const std::string wrong = read_number(name, value, key->lowest, key->highest, number);
  if (wrong.empty()) table.*key->member = number * key->scale;
  return wrong;
}

// "text" of 1 to 63 printable letters.
inline std::string read_text(const std::string& name, const std::string& value, std::string& text) {
  constexpr std::size_t kLongest = 63;
  const bool quoted = value.size() > 2 && value.front() == '"' && value.back() == '"';
  const std::string inner = quoted ? value.substr(1, value.size() - 2) : "";
  const bool printable =
      std::ranges::all_of(inner, [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; });
  if (inner.empty() || inner.size() > kLongest || !printable)
    return name + ": allowed is \"text\" of 1 to 63 printable letters of ASCII";
  text = inner;
  return "";
}

// One of `words`, quoted; its index.
inline std::string read_word(const std::string& name, const std::string& value, std::span<const char* const> words,
                             int& index) {
  std::string allowed;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (value == '"' + std::string(words[i]) + '"') return index = static_cast<int>(i), "";
    allowed += (i == 0 ? "\"" : ", \"") + std::string(words[i]) + '"';
  }
  return name + ": " + value + ": allowed are " + allowed;
}

// Names of the keys that must be there and are not in `seen`, added to `text`.
template <class T, std::size_t count>
void add_missing(const ProfileKey<T> (&keys)[count], const std::vector<std::string>& seen, std::string& text) {
  for (const ProfileKey<T>& key : keys)
    if (!key.may_lack && std::ranges::find(seen, key.name) == seen.end())
      text += (text.empty() ? "" : ", ") + std::string(key.name);
}

}  // namespace palpate
