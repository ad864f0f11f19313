// Is a text well-formed XML, as far as our writers use it? Tags balance, attributes are quoted, entities are known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::test {

// Empty when it is; otherwise what is wrong.
inline std::string xml_error(std::string_view text) {
  std::vector<std::string> open;
  bool had_root = false;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '&') {
      const std::string_view rest = text.substr(i, 5);
      if (!(rest.starts_with("&amp;") || rest.starts_with("&lt;") || rest.starts_with("&gt;"))) return "bare ampersand";
    }
    if (text[i] != '<') {
      if (open.empty() && text[i] != '\n') return "text outside the root";
      ++i;
      continue;
    }
    const std::size_t end = text.find('>', i);
    if (end == std::string_view::npos) return "unclosed tag";
    const std::string_view tag = text.substr(i + 1, end - i - 1);
    i = end + 1;
    if (tag.starts_with('?')) continue;
    std::size_t quotes = 0;
    for (const char c : tag) quotes += c == '"' ? 1 : 0;
    if (tag.empty() || quotes % 2 != 0 || tag.find('<') != std::string_view::npos) return "bad tag " + std::string(tag);
    const std::string name(tag.substr(0, tag.find_first_of(" /", 1)));
    if (tag[0] == '/') {
      if (open.empty() || "/" + open.back() != name) return "unexpected </" + name + ">";
      open.pop_back();
    } else {
      if (open.empty() && had_root) return "second root";
      had_root = true;
      if (tag.back() != '/') open.push_back(name);
    }
  }
  if (!open.empty()) return "not closed: " + open.back();
  return had_root ? "" : "no root";
}

}  // namespace palpate::test
