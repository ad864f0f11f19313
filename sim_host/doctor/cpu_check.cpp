// Runs before everything else in each program: a processor without the x86-64-v3 instructions would stop with "Illegal
// instruction" somewhere in the middle; this says which instructions are missing instead. Compiled for plain x86-64 and
// free of every library but the kernel's write, so that the check itself runs anywhere.
#include <cpuid.h>
#include <unistd.h>

namespace {

// The instruction sets that x86-64-v3 adds (psABI 1.0, table 3.1), as the gcc builtin names them.
const char* missing_instructions() {
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2")) return "avx2";
  if (!__builtin_cpu_supports("fma")) return "fma";
  if (!__builtin_cpu_supports("bmi")) return "bmi1";
  if (!__builtin_cpu_supports("bmi2")) return "bmi2";
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & bit_MOVBE) == 0) return "movbe";
  if ((c & bit_F16C) == 0) return "f16c";
  if (__get_cpuid(0x80000001, &a, &b, &c, &d) == 0 || (c & bit_LZCNT) == 0) return "abm (lzcnt)";
  return nullptr;
}

void say(const char* text) {
  int length = 0;
  while (text[length] != '\0') ++length;
  [[maybe_unused]] const auto written = write(STDERR_FILENO, text, static_cast<unsigned long>(length));
}

// 101 is the first priority a program may use: before any other static object of ours or of a library in it.
__attribute__((constructor(101))) void require_x86_64_v3() {
  const char* missing = missing_instructions();
  if (missing == nullptr) return;
  say("palpate: this processor lacks the instruction set '");
  say(missing);
  say("'; Palpate needs x86-64-v3 (Intel Haswell 2013, AMD Zen 2017, or newer).\n");
  _exit(3);
}

}  // namespace
