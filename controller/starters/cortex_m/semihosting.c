/* SPDX-License-Identifier: BSD-3-Clause */
/* Semihosting: a breakpoint asks the debugger or emulator, which reads its stdin or writes its
 * stdout for the program. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "board.h"
#include "program.h"

enum { OPEN = 1, WRITE = 5, READ = 6, EXIT = 0x20 };
enum { FOR_STDIN = 0, FOR_STDOUT = 4, FOR_STDERR = 8 };

/* The registers of the arguments and of the result are those of a call in C. */
__attribute__((naked, noinline, aligned(16))) static int call(int operation,
                                                              const void* arguments) {
#ifdef __riscv
  /* The two instructions that do nothing mark the breakpoint, in instructions of 32 bits. */
  __asm__ volatile(
      ".option push\n .option norvc\n slli x0, x0, 0x1f\n ebreak\n srai x0, x0, 7\n ret\n"
      ".option pop");
#else
  __asm__ volatile("bkpt 0xab\n bx lr");
#endif
}

static int open_stream(uintptr_t mode) {
  const uintptr_t arguments[] = {(uintptr_t) ":tt", mode, 3};
  return call(OPEN, arguments);
}

static int in, out;

/* Returns 0 at the end of the stream. */
static int transfer(int operation, int stream, const char* at, size_t size) {
  while (size > 0) {
    const uintptr_t arguments[] = {(uintptr_t)stream, (uintptr_t)at, size};
    const size_t left = (size_t)call(operation, arguments); /* bytes that were not transferred */
    if (left >= size) return 0;
    at += size - left;
    size = left;
  }
  return 1;
}

int connection_read(void* to, size_t size) { return transfer(READ, in, to, size); }

void connection_write(const void* from, size_t size) { transfer(WRITE, out, from, size); }

_Noreturn void _exit(int status) {
  const uintptr_t arguments[] = {0x20026 /* application exit */, (uintptr_t)status};
  for (;;) call(EXIT, arguments);
}

_Noreturn void board_fail(const char* reason) {
  transfer(WRITE, open_stream(FOR_STDERR), reason, strlen(reason));
  _exit(1);
}

int main(void) {
  in = open_stream(FOR_STDIN);
  out = open_stream(FOR_STDOUT);
  if (program_greet("binary")) program_serve();
  _exit(0);
}
