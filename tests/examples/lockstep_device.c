// docs/examples/device.c, or with LOCKSTEP_OF another's name that one, in the controller's virtual time
// (hal/loop/lockstep.h), started as palpate-device is.
#ifndef LOCKSTEP_OF
#define LOCKSTEP_OF "../../docs/examples/device.c"
#endif
#define main example_main
#include LOCKSTEP_OF
#undef main

#include <stdlib.h>

static int descriptor(int argc, char** argv, const char* option) {
  for (int i = 1; i + 1 < argc; ++i)
    if (strcmp(argv[i], option) == 0) return atoi(argv[i + 1]);
  exit(2);
}

int main(int argc, char** argv) {
  const int turns = descriptor(argc, argv, "--turn-fd");
  struct device device = new_device(descriptor(argc, argv, "--device-fd"));
  const int64_t period_ns = 1000000;
  int64_t now_ns, due_ns = period_ns;
  while (recv(turns, &now_ns, sizeof now_ns, 0) == sizeof now_ns) {
    for (; due_ns <= now_ns; due_ns += period_ns)
      if (!step(&device)) return 0;
    if (send(turns, &due_ns, sizeof due_ns, MSG_NOSIGNAL) != sizeof due_ns) return 0;
  }
}
