/* SPDX-License-Identifier: BSD-3-Clause */
/* What a RISC-V needs at its start: stack, variables of threads, floating point unit. Counts
 * cycles. */
#include <stdint.h>

#include "board.h"
#include "program.h"

/* ---- the cost of a step, counted by the processor --------------------------------------------*/

static uint32_t count(void) {
  uint32_t cycles;
  __asm__ volatile("csrr %0, mcycle" : "=r"(cycles));
  return cycles;
}

static uint32_t begin;

void cost_begin(void) { begin = count(); }

uint32_t cost_end(void) { return count() - begin; }

/* ---- faults ----------------------------------------------------------------------------------*/

__attribute__((used, interrupt, aligned(4))) static void fault(void) {
  uint32_t pc;
  __asm__ volatile("csrr %0, mepc" : "=r"(pc));
  board_fault(pc);
}

/* ---- reset -----------------------------------------------------------------------------------*/

/* At the beginning of the ROM: KEEP() in board.ld. errno of picolibc is a variable of a thread, so
 * `tp` has its address. */
__attribute__((section(".vectors"), used, naked)) void reset(void) {
  __asm__ volatile(
      "la sp, stack_end\n"
      "la tp, thread_begin\n"
      "la t0, %0\n"
      "csrw mtvec, t0\n"
      "li t0, 0x2000\n" /* FS of mstatus, before the first float, or it is a fault */
      "csrs mstatus, t0\n"
      "j board_start"
      :
      : "i"(fault));
}
