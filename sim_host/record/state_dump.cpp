#include "sim_host/record/state_dump.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim_host/record/value_text.h"

namespace palpate {

namespace {

using NamedText = std::pair<std::string, std::string>;

class Lister {
 public:
  static constexpr bool kRealTime = false;  // it allocates
  explicit Lister(std::vector<NamedText>& list) : list_(list) {}
  void enter(const char* name, std::int32_t index) {
    path_.push_back(index == kNoIndex ? fmt::format("{}.", name) : fmt::format("{}[{}].", name, index));
  }
  void leave() { path_.pop_back(); }
  void skip(const char* name, std::int32_t index) {
    list_.push_back({fmt::format("{}{}[{}]", fmt::join(path_, ""), name, index), "not in use"});
  }
  template <class T>
  void value(const char* name, const T& x) {
    std::string path = fmt::format("{}{}", fmt::join(path_, ""), name);
    if constexpr (std::is_enum_v<T>) {
      list_.emplace_back(std::move(path), text_of(static_cast<std::int32_t>(x)));
    } else {
      list_.emplace_back(std::move(path), text_of(x));
    }
  }

 private:
  std::vector<NamedText>& list_;
  std::vector<std::string> path_;
};

}  // namespace

std::vector<NamedText> list_state(const State& state) {
  std::vector<NamedText> list;
  Lister lister(list);
  state.visit_all(lister);
  return list;
}

}  // namespace palpate
