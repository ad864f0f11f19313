// A plugin for qemu-user that counts the instructions a program executes between one getppid() and the next, by which
// tick_count.cpp marks a tick: Valgrind does not run programs for another processor. Prints the worst tick and the mean
// of all. QEMU's interface for plugins (docs/devel/tcg-plugins of QEMU 7.2) is declared here: Debian packs no header.
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>

typedef uint64_t Id;
struct Block;  // of translated instructions, executed as a whole
extern void qemu_plugin_register_vcpu_tb_trans_cb(Id id, void (*call)(Id, struct Block*));
extern size_t qemu_plugin_tb_n_insns(const struct Block* block);
extern void qemu_plugin_register_vcpu_tb_exec_inline(struct Block* block, int operation, void* at, uint64_t add);
extern void qemu_plugin_register_vcpu_syscall_cb(Id id, void (*call)(Id, unsigned, int64_t, uint64_t, uint64_t, uint64_t,
                                                                     uint64_t, uint64_t, uint64_t, uint64_t, uint64_t));
extern void qemu_plugin_register_atexit_cb(Id id, void (*call)(Id, void*), void* data);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

enum { kAddToWord = 0, kGetppid = 173 };  // AArch64's number

static uint64_t executed, begun, ticks, sum, worst, worst_tick;
static int inside;

static void on_block(Id id, struct Block* block) {
  (void)id;
  qemu_plugin_register_vcpu_tb_exec_inline(block, kAddToWord, &executed, qemu_plugin_tb_n_insns(block));
}

// The call ends its block, so that what was executed is complete.
static void on_call(Id id, unsigned cpu, int64_t number, uint64_t a, uint64_t b, uint64_t c, uint64_t d, uint64_t e, uint64_t f,
                    uint64_t g, uint64_t h) {
  (void)id, (void)cpu, (void)a, (void)b, (void)c, (void)d, (void)e, (void)f, (void)g, (void)h;
  if (number != kGetppid) return;
  inside = !inside;
  if (inside) {
    begun = executed;
    return;
  }
  const uint64_t took = executed - begun;
  if (took > worst) worst = took, worst_tick = ticks;
  sum += took;
  ++ticks;
}

static void on_end(Id id, void* data) {
  (void)id, (void)data;
  fprintf(stderr, "worst tick %" PRIu64 " instructions (tick %" PRIu64 "), mean %" PRIu64 " of %" PRIu64 " ticks\n", worst, worst_tick,
          ticks == 0 ? 0 : sum / ticks, ticks);
}

__attribute__((visibility("default"))) int qemu_plugin_install(Id id, const void* info, int count, char** arguments) {
  (void)info, (void)count, (void)arguments;
  qemu_plugin_register_vcpu_tb_trans_cb(id, on_block);
  qemu_plugin_register_vcpu_syscall_cb(id, on_call);
  qemu_plugin_register_atexit_cb(id, on_end, 0);
  return 0;
}
