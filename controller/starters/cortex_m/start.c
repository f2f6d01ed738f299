/* SPDX-License-Identifier: BSD-3-Clause */
/* The start of a program on a board: memory, stack and heap. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "board.h"
#include "program.h"

/* From board.ld. */
extern uint32_t data_in_rom[], data_begin[], data_end[], bss_begin[], bss_end[], heap_begin[],
    stack_begin[], stack_end[];

int main(void);

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

/* ---- the heap of malloc(), from the end of the variables to the stack ------------------------*/

void* _sbrk(ptrdiff_t increment) {
  static char* end = (char*)heap_begin;
  if (increment > (char*)stack_begin - end) return (void*)-1;
  end += increment;
  return end - increment;
}

/* The name in picolibc. */
__attribute__((alias("_sbrk"))) void* sbrk(ptrdiff_t increment);

/* ---- start and end ---------------------------------------------------------------------------*/

void board_start(void) {
  paint_stack();
  memcpy(data_begin, data_in_rom, (size_t)((char*)data_end - (char*)data_begin));
  memset(bss_begin, 0, (size_t)((char*)bss_end - (char*)bss_begin));
  main();
  board_fail("main() returned\n");
}

void board_fault(uint32_t pc) {
  static char text[] = "fault at 0x00000000; addr2line of the compiler names the line\n";
  for (int i = 0; i < 8; ++i) text[18 - i] = "0123456789abcdef"[pc >> (4 * i) & 15];
  board_fail(text);
}
