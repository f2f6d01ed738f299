/* SPDX-License-Identifier: BSD-3-Clause */
/* What a Cortex-M needs at its start: vectors and floating point unit. Counts cycles. */
#include <stdint.h>

#include "board.h"
#include "program.h"

extern uint32_t stack_end[]; /* from board.ld */

void reset(void);

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

/* ---- faults ----------------------------------------------------------------------------------*/

/* `frame` is what the processor pushed: r0 to r3, r12, lr, pc, psr. */
__attribute__((used)) static void fault_at(const uint32_t* frame) { board_fault(frame[6]); }

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

void reset(void) {
#ifdef __ARM_FP
  /* Before the first float, or it is a fault: access to the floating point unit (CPACR). */
  *(volatile uint32_t*)0xe000ed88u |= 0xfu << 20;
  __asm__ volatile("dsb\n isb" ::: "memory");
#endif
  board_start();
}
