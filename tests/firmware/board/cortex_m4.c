/* The exercise on a Cortex-M4 with its FPU: vectors, reset, and output by semihosting, which a debugger or an emulator
 * answers. STEPS is given when it is compiled. Prints the hash and the bytes of stack that were touched. */
#include "tests/firmware/board/exercise.h"

extern uint32_t data_begin[], data_end[], data_load[], bss_begin[], bss_end[], stack_begin[], stack_end[];
void reset(void);
int main(void);

__attribute__((noreturn)) static void hang(void) {
  for (;;) {
  }
}

__attribute__((section(".vectors"), used)) static void* const vectors[16] = {
    stack_end, reset, hang, hang, hang, hang, hang, 0, 0, 0, 0, hang, hang, 0, hang, hang};

/* The compiler may call these for copies and clears. */
void* memcpy(void* to, const void* from, unsigned count) {
  for (unsigned i = 0; i < count; ++i) ((volatile uint8_t*)to)[i] = ((const uint8_t*)from)[i];
  return to;
}
void* memset(void* to, int value, unsigned count) {
  for (unsigned i = 0; i < count; ++i) ((volatile uint8_t*)to)[i] = (uint8_t)value;
  return to;
}

static void semihost(unsigned operation, const void* argument) {
  register unsigned r0 __asm__("r0") = operation;
  register const void* r1 __asm__("r1") = argument;
  __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void print(uint32_t value) {
  char text[10] = {0};
  for (int i = 0; i < 8; ++i) text[i] = "0123456789abcdef"[value >> (28 - 4 * i) & 15];
  text[8] = '\n';
  semihost(0x04, text); /* SYS_WRITE0 */
}

int main(void) {
  const uint32_t paint = 0xA5A5A5A5u;
  uint32_t* top = (uint32_t*)__builtin_frame_address(0) - 32;
  for (uint32_t* word = stack_begin; word < top; ++word) *(volatile uint32_t*)word = paint;
  print(exercise(STEPS));
  uint32_t* word = stack_begin;
  while (*(volatile uint32_t*)word == paint) ++word;
  print((uint32_t)((char*)stack_end - (char*)word));
  semihost(0x18, (void*)0x20026); /* SYS_EXIT, in order */
  hang();
}

/* Nothing is in place yet: without a frame of its own, and the FPU on before anything uses it. */
__attribute__((noreturn)) void reset(void) {
  *(volatile uint32_t*)0xE000ED88u |= 0xFu << 20; /* CPACR: coprocessors 10 and 11 */
  __asm__ volatile("dsb\n\tisb");
  for (uint32_t *to = data_begin, *from = data_load; to < data_end; ++to, ++from) *to = *from;
  for (uint32_t* to = bss_begin; to < bss_end; ++to) *to = 0;
  main();
  hang();
}
