// A real-time function that allocates behind the compiler's back: the real-time sanitizer must stop it.
#include <cstdlib>

#include "rt_core/base.h"

namespace {

void* (*volatile hidden_malloc)(std::size_t) = std::malloc;

#pragma clang diagnostic ignored "-Wfunction-effects"
void* blocking() PALPATE_RT { return hidden_malloc(16); }

}  // namespace

int main() {
  std::free(blocking());
  return 0;
}
