#include "sim_host/record/state_dump.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

#include "sim_host/record/value_text.h"

namespace palpate {

namespace {

struct NamedBytes {
  std::string name, text, bytes;
};

class Lister {
 public:
  static constexpr bool kRealTime = false;  // it allocates
  explicit Lister(std::vector<NamedBytes>& list) : list_(list) {}
  void enter(const char* name, std::int32_t index) {
    path_.push_back(index == kNoIndex ? fmt::format("{}.", name) : fmt::format("{}[{}].", name, index));
  }
  void leave() { path_.pop_back(); }
  void skip(const char* name, std::int32_t index) {
    list_.push_back({fmt::format("{}{}[{}]", fmt::join(path_, ""), name, index), "not in use", ""});
  }
  template <class T>
  void value(const char* name, const T& x) {
    static_assert(std::has_unique_object_representations_v<T> || sizeof(T) % sizeof(double) == 0, "no padding");
    NamedBytes entry;
    entry.name = fmt::format("{}{}", fmt::join(path_, ""), name);
    if constexpr (std::is_enum_v<T>) {
      entry.text = text_of(static_cast<std::int32_t>(x));
    } else {
      entry.text = text_of(x);
    }
    entry.bytes.assign(reinterpret_cast<const char*>(&x), sizeof(T));
    list_.push_back(std::move(entry));
  }

 private:
  std::vector<NamedBytes>& list_;
  std::vector<std::string> path_;
};

std::vector<NamedBytes> list_bytes(const State& state) {
  std::vector<NamedBytes> list;
  Lister lister(list);
  state.visit_all(lister);
  return list;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> list_state(const State& state) {
  std::vector<std::pair<std::string, std::string>> lines;
  for (NamedBytes& entry : list_bytes(state)) lines.emplace_back(std::move(entry.name), std::move(entry.text));
  return lines;
}

std::string first_state_difference(const State& a, const State& b) {
  const std::vector<NamedBytes> of_a = list_bytes(a), of_b = list_bytes(b);
  for (std::size_t i = 0; i < std::min(of_a.size(), of_b.size()); ++i) {
    const std::string &in_a = of_a[i].name, &in_b = of_b[i].name;
    if (in_a != in_b) return in_a.size() > in_b.size() ? in_a : in_b;  // an entry that only one of them uses
    if (of_a[i].bytes != of_b[i].bytes) return in_a;
  }
  return of_a.size() == of_b.size() ? "" : "number of entries in use";
}

}  // namespace palpate
