/* SPDX-License-Identifier: BSD-3-Clause */
/* The start of a Cortex-M: vectors, memory, floating point unit, stack and heap. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "board.h"
#include "program.h"

/* From board.ld. */
extern uint32_t data_in_rom[], data_begin[], data_end[], bss_begin[], bss_end[], heap_begin[],
    stack_begin[], stack_end[];

int main(void);
void reset(void);

/* ---- the stack, painted to see how much of it was used ---------------------------------------*/

#define PAINT 0x5a5a5a5au

static inline void paint_stack(void) {
  const uint32_t* const used = __builtin_frame_address(0);
  for (uint32_t* word = stack_begin; word < used - 16; ++word) *word = PAINT;
}

uint32_t stack_used(void) {
  const uint32_t* word = stack_begin;
  while (*word == PAINT) ++word;
  return (uint32_t)((const char*)stack_end - (const char*)word);
}

/* ---- the cost of a step, counted by SysTick, which every Cortex-M has -------------------------*/

static struct {
  volatile uint32_t control, reload, value; /* counts down, 24 bits */
}* const systick = (void*)0xe000e010u;

static volatile uint32_t wraps;

static void on_wrap(void) { ++wraps; }

void cost_begin(void) {
  wraps = 0;
  systick->reload = 0xffffff;
  systick->value = 0;   /* any value: it begins at `reload` */
  systick->control = 7; /* runs, with an interrupt at a wrap, on the clock of the processor */
}

uint32_t cost_end(void) {
  systick->control = 4; /* stops, so that `wraps` and `value` belong together */
  return (wraps << 24) + (systick->reload - systick->value);
}

/* ---- the heap of malloc(), from the end of the variables to the stack ------------------------*/

void* _sbrk(ptrdiff_t increment) {
  static char* end = (char*)heap_begin;
  if (increment > (char*)stack_begin - end) return (void*)-1;
  end += increment;
  return end - increment;
}

/* ---- faults ----------------------------------------------------------------------------------*/

/* `frame` is what the processor pushed: r0 to r3, r12, lr, pc, psr. */
__attribute__((used)) static void fault_at(const uint32_t* frame) {
  static char text[] = "fault at 0x00000000; arm-none-eabi-addr2line names the line\n";
  const uint32_t pc = frame[6];
  for (int i = 0; i < 8; ++i) text[18 - i] = "0123456789abcdef"[pc >> (4 * i) & 15];
  board_fail(text);
}

__attribute__((naked)) static void fault(void) {
  __asm__ volatile("mrs r0, msp\n b %0" : : "i"(fault_at));
}

/* ---- reset -----------------------------------------------------------------------------------*/

/* A linker that loses this table makes a program that does not start: KEEP() in board.ld. */
__attribute__((section(".vectors"), used)) static const struct {
  uint32_t* stack;
  void (*reset)(void);
  void (*faults[5])(void); /* NMI, hard fault, memory, bus, usage */
  void (*others[8])(void);
  void (*systick)(void);
} vectors = {stack_end, reset, {fault, fault, fault, fault, fault}, {0}, on_wrap};

__attribute__((noinline)) static void start(void) {
  paint_stack();
  memcpy(data_begin, data_in_rom, (size_t)((char*)data_end - (char*)data_begin));
  memset(bss_begin, 0, (size_t)((char*)bss_end - (char*)bss_begin));
  main();
  board_fail("main() returned\n");
}

void reset(void) {
#ifdef __ARM_FP
  /* Before the first float, or it is a fault: access to the floating point unit (CPACR). */
  *(volatile uint32_t*)0xe000ed88u |= 0xfu << 20;
  __asm__ volatile("dsb\n isb" ::: "memory");
#endif
  start();
}
