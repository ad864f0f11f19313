// lab_idle: uses up whatever processor time the guest has left, so that its processor never halts. QEMU (7.2) advances
// virtual time past an idle processor from its main loop's thread, which may do so before the instructions just
// executed are accounted for: then two runs differ by nanoseconds, and in everything after. A processor that is never
// idle has a time that is its instruction count alone (2026-11-21: three runs of three alike to the last byte on a busy
// computer). SCHED_IDLE: everything else goes first. A block of nothing costs the real computer nearly nothing.
#include <sched.h>

int main() {
  const sched_param none{};
  sched_setscheduler(0, SCHED_IDLE, &none);
  for (;;) asm volatile(".rept 480\n\tnop\n\t.endr");
}
