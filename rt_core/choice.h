// An enumeration and its words, from one table: X(enumerator, word). The words are what a scene file says, what a dump
// shows and what the documents list; the loader's range is the table's length. Nothing of it costs the tick a byte: the
// words are in a binary only where they are used.
#pragma once

#include <cstdint>

namespace palpate {

// Of an enumeration made by PALPATE_CHOICE: kCount, and kWord in the enumerators' order.
template <class Enum>
struct ChoiceOf;

template <class T>
concept Choice = requires {
  ChoiceOf<T>::kCount;
};

template <Choice Enum>
constexpr Enum last_choice() {
  return static_cast<Enum>(ChoiceOf<Enum>::kCount - 1);
}
// Of a value that may have come from a file.
template <Choice Enum>
constexpr bool is_choice(Enum value) {
  return static_cast<std::int32_t>(value) >= 0 && value <= last_choice<Enum>();
}
// `value` is in range: parameters are checked when an image is opened.
template <Choice Enum>
constexpr const char* word_of(Enum value) {
  return ChoiceOf<Enum>::kWord[static_cast<std::int32_t>(value)];
}

}  // namespace palpate

// A table may give more than the two columns: they are ignored here, and read by whoever they are for.
#define PALPATE_CHOICE_ENUMERATOR(name, ...) name,
#define PALPATE_CHOICE_COUNT(name, ...) +1
#define PALPATE_CHOICE_TEXT(word) #word
#define PALPATE_CHOICE_FIRST(word, ...) PALPATE_CHOICE_TEXT(word)
#define PALPATE_CHOICE_WORD(name, ...) PALPATE_CHOICE_FIRST(__VA_ARGS__, -),
// In namespace palpate.
#define PALPATE_CHOICE(Enum, TABLE)                                            \
  enum class Enum : std::int32_t { TABLE(PALPATE_CHOICE_ENUMERATOR) };         \
  template <>                                                                  \
  struct ChoiceOf<Enum> {                                                      \
    static constexpr std::int32_t kCount = 0 TABLE(PALPATE_CHOICE_COUNT);      \
    static constexpr const char* kWord[kCount] = {TABLE(PALPATE_CHOICE_WORD)}; \
  }
